"""A copy of the project that faults are put into, with a build of its own."""

import hashlib
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from tools.harness.places import ROOT

# Beside sources and tests: the files that tests read.
_PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")
_COPIED = ("addon", "blender_tests", "core", "scenes", ".ci", "Makefile", "pyproject.toml", *_PAGES)
_LEFT = {"__pycache__"}
_LIBRARY = ("addon", "lib")


class Broken(Exception):
    """Faulty code that does not compile, or tests that did not run; the text is the last lines of the log."""


@dataclass(frozen=True)
class Tree:
    folder: Path
    jobs: int

    @property
    def root(self):
        return self.folder / "tree"

    @property
    def build_folder(self):
        return self.folder / "core"

    def fill(self):
        """Brings the copy up to date and returns a digest of it. Files without changes keep their time and are not compiled."""
        digest, wanted = hashlib.sha256(), set()
        for path in _files():
            name, data = path.relative_to(ROOT), path.read_bytes()
            wanted.add(name)
            digest.update(f"{name}\0{len(data)}\0".encode() + data)
            copy = self.root / name
            if not copy.exists() or copy.read_bytes() != data:
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(data)
                shutil.copymode(path, copy)
        for top in _COPIED:
            for copy in [path for path in (self.root / top).rglob("*") if path.is_file()]:
                name = copy.relative_to(self.root)
                if name not in wanted and name.parts[:2] != _LIBRARY:
                    copy.unlink()
        return digest.hexdigest()[:16]

    def take_library(self):
        """The library of the project itself, for faults of the add-on."""
        shutil.copytree(ROOT.joinpath(*_LIBRARY), self.root.joinpath(*_LIBRARY), dirs_exist_ok=True)

    def build(self, targets):
        """Compiles the changes; the library lands in the copy's addon/lib."""
        if not (self.build_folder / "build.ninja").exists():
            launcher = (
                ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache", "-DCMAKE_C_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
            )
            self._run("cmake", "-S", self.root / "core", "-B", self.build_folder, "-G", "Ninja", "-DLANCER_TESTS=ON", *launcher)
        self._run("cmake", "--build", self.build_folder, "-j", self.jobs, "--target", *targets)

    def _run(self, *command):
        # A compiler cache sees one file in each place of the project.
        cache = {"CCACHE_BASEDIR": str(ROOT), "CCACHE_NOHASHDIR": "1", **os.environ}
        done = subprocess.run([str(word) for word in command], cwd=self.root, capture_output=True, text=True, env=cache)
        if done.returncode:
            raise Broken("\n".join((done.stdout + done.stderr).strip().splitlines()[-20:]))

    def put(self, fault):
        path = self.root / fault.file
        path.write_text(fault.applied(path.read_text(encoding="utf-8")), encoding="utf-8")

    def take_back(self, fault):
        # With a new time: the object that holds the fault is older than its source again.
        (self.root / fault.file).write_bytes((ROOT / fault.file).read_bytes())


def _files():
    for top in _COPIED:
        path = ROOT / top
        for folder, folders, names in os.walk(path) if path.is_dir() else [(ROOT, [], [top])]:
            # The library is made anew, or taken as it is.
            left = {*_LEFT, "lib"} if Path(folder) == ROOT / "addon" else _LEFT
            folders[:] = sorted(set(folders) - left)
            yield from (Path(folder, name) for name in sorted(names))
