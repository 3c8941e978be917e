"""Zips in Blender, without a network: installed, used in a render, updated while in use, disabled, removed. The zips are those
of `make addon`, or those in the folder LANCER_TEST_ZIPS."""

import ast
import glob
import hashlib
import json
import os
import re
import subprocess
import sys
import zipfile

import blenders
import pytest
from blenders import MODULE, PROGRAM
from conftest import HERE, ROOT

SCRIPT = os.path.join(HERE, "blender", "in_blender", "install.py")
OLDER = (0, 0, 9)


def release():
    with open(os.path.join(ROOT, "addon", "__init__.py"), encoding="utf-8") as file:
        tree = ast.parse(file.read())
    return next(ast.literal_eval(node.value) for node in tree.body if isinstance(node, ast.Assign))["version"]


def older(path, folder):
    """Return a copy of the zip with an older version in add-on and library."""
    new, old = release(), OLDER
    dotted = [".".join(map(str, version)) for version in (new, old)]
    made = os.path.join(folder, os.path.basename(path).replace(*dotted))
    with zipfile.ZipFile(path) as archive, zipfile.ZipFile(made, "w") as copy:
        for name in archive.namelist():
            data = archive.read(name)
            if name.endswith("blender_manifest.toml"):
                data = data.replace(*(text.encode() for text in dotted))
            elif name.endswith("__init__.py"):
                # Change the size: Python reuses the compiled file if size and time are equal.
                data = data.replace(str(new).encode(), str(old).encode()) + b"\n"
            elif "/liblancer" in "/" + name:
                data = data.replace(*(text.encode() + b"\0" for text in dotted))
                name = f"{name.split('-')[0]}-{hashlib.sha256(data).hexdigest()[:12]}.so"
            copy.writestr(name, data)
    return made


def has_extensions(which):
    """Whether this Blender is version 4.2 or newer."""
    if which == MODULE:
        return True
    said = subprocess.run([blenders.program(), "--version"], capture_output=True, text=True, check=True).stdout
    return tuple(map(int, re.search(r"Blender (\d+)\.(\d+)", said).groups())) >= (4, 2)


def newest_zip(which):
    """Return the newest zip for this machine and this Blender; build it if there is none."""
    folder = os.environ.get("LANCER_TEST_ZIPS")
    if not folder:
        folder = os.path.join(ROOT, "build")
        blenders.zip_for_blender_3()
    found = glob.glob(os.path.join(folder, "lancer-*-linux-x64*.zip"))
    classic = {path for path in found if path.endswith("-blender3.zip")}
    return max(set(found) - classic if has_extensions(which) else classic, key=os.path.getmtime)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_install_update_remove(which, tmp_path):
    newer = newest_zip(which)
    result = tmp_path / "result.json"
    start = [sys.executable, SCRIPT]
    if which == PROGRAM:
        start = [blenders.program(), "-b", "--factory-startup", "--python-exit-code", "3", "-P", SCRIPT]
    places = {"BLENDER_USER_EXTENSIONS": str(tmp_path / "extensions"), "BLENDER_USER_RESOURCES": str(tmp_path / "resources")}
    done = subprocess.run(
        [*start, "--", result, older(newer, str(tmp_path)), newer],
        env=blenders.environment(tmp_path, **places),
        capture_output=True,
        text=True,
        errors="replace",
        timeout=300,
    )
    assert done.returncode == 0 and result.exists(), (done.stdout + done.stderr)[-3000:]
    got = json.loads(result.read_text())
    absent, present = (dict.fromkeys(("engine", "settings", "enabled"), value) for value in (False, True))
    assert got["before"] == got["disabled"] == absent and not got["left"]
    for name, version in (("older", OLDER), ("newer", release())):
        assert got[name].pop("brightest") > 0.0
        # If the old library were still loaded, it would report its own version.
        text = ".".join(map(str, version))
        assert got[name] == {**present, "release": text, "library": text}
    assert str(tmp_path) in got["folder"]
