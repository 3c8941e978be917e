"""A copy of the project that faults are put into."""

import hashlib
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from tools.harness.places import ROOT

# Beside sources and tests: the files that tests read.
_PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "LICENSE")
_COPIED = ("addon", "blender_tests", "core", "scenes", ".ci", "Makefile", "pyproject.toml", *_PAGES)
_LEFT = {"__pycache__"}
_LIBRARY = ("addon", "lib")


class Broken(Exception):
    """Faulty code that does not compile, or tests that did not run; the text is the last lines of the log."""


@dataclass(frozen=True)
class Tree:
    root: Path

    def fill(self, texts=None):
        """Brings the copy up to date; texts: those of files that differ from the project's.

        Files without changes keep their time, and are not compiled.
        """
        wanted = {path.relative_to(ROOT): path.read_bytes() for path in _files()}
        wanted |= {Path(name): text.encode() for name, text in (texts or {}).items()}
        for name, data in wanted.items():
            copy = self.root / name
            if not copy.exists() or copy.read_bytes() != data:
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(data)
                if (ROOT / name).exists():
                    shutil.copymode(ROOT / name, copy)
        for copy in [path for top in _COPIED for path in (self.root / top).rglob("*") if path.is_file()]:
            name = copy.relative_to(self.root)
            if name not in wanted and name.parts[:2] != _LIBRARY:
                copy.unlink()

    def take_library(self):
        """The library of the project itself, for faults of the add-on."""
        shutil.copytree(ROOT.joinpath(*_LIBRARY), self.root.joinpath(*_LIBRARY), dirs_exist_ok=True)

    @property
    def program(self):
        return self.root / "build" / "core" / "lancer_tests"

    def build(self, targets, jobs):
        """Compiles the changes; the library lands in the copy's addon/lib."""
        folder = self.root / "build" / "core"
        if not (folder / "build.ninja").exists():
            launcher = [f"-DCMAKE_{language}_COMPILER_LAUNCHER=ccache" for language in ("C", "CXX") if shutil.which("ccache")]
            self._run("cmake", "-S", self.root / "core", "-B", folder, "-G", "Ninja", "-DLANCER_TESTS=ON", *launcher)
        self._run("cmake", "--build", folder, "-j", jobs, "--target", *targets)

    def _run(self, *command):
        # A compiler cache sees one file in each place of the project.
        cache = {"CCACHE_BASEDIR": str(ROOT), "CCACHE_NOHASHDIR": "1", **os.environ}
        done = subprocess.run([str(word) for word in command], cwd=self.root, capture_output=True, text=True, env=cache)
        if done.returncode:
            raise Broken("\n".join((done.stdout + done.stderr).strip().splitlines()[-20:]))

    def put(self, fault):
        """Puts the fault into its file, and returns the file's text without it."""
        path = self.root / fault.file
        text = path.read_text(encoding="utf-8")
        path.write_text(fault.applied(text), encoding="utf-8")
        return text

    def take_back(self, fault, text):
        (self.root / fault.file).write_text(text, encoding="utf-8")


def digest():
    """Of all that is copied."""
    result = hashlib.sha256()
    for path in _files():
        data = path.read_bytes()
        result.update(f"{path.relative_to(ROOT)}\0{len(data)}\0".encode() + data)
    return result.hexdigest()[:16]


def _files():
    for top in _COPIED:
        path = ROOT / top
        for folder, folders, names in os.walk(path) if path.is_dir() else [(ROOT, [], [top])]:
            # The library is made anew, or taken as it is.
            left = {*_LEFT, "lib"} if Path(folder) == ROOT / "addon" else _LEFT
            folders[:] = sorted(set(folders) - left)
            yield from (Path(folder, name) for name in sorted(names))
