"""Zips in Blender, without a network: installed, used in a render, updated while in use, disabled, removed. The zips are those
of `make addon`, or those in the folder LANCER_TEST_ZIPS."""

import json
import os
import subprocess

import blenders
import pytest
from blenders import MODULE, PROGRAM
from conftest import HERE
from zips import OLDER, dotted, has_extensions, newest_zip, older, release

SCRIPT = os.path.join(HERE, "blender", "in_blender", "install.py")


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_install_update_remove(which, tmp_path):
    newer = newest_zip(which)
    result = tmp_path / "result.json"
    start = [blenders.module_python(), SCRIPT]
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
        # If the old library were still loaded, it would report its own version.
        text = dotted(version)
        place = "site-packages/lancer/lib" if has_extensions(which) else "lancer/lib"
        file = got[name].pop("file")
        assert file.startswith(str(tmp_path)) and place in file
        assert got[name] == {**present, "release": text, "library": text, "lit": True}
    assert str(tmp_path) in got["folder"]
