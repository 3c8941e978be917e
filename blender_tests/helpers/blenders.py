"""Where the Blenders are, and how a case runs inside one: always in a process of its own, so that a crash is a failure."""

import glob
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

# Tools ask for Blenders, too, where there is no pytest.
HERE, ROOT = (str(folder) for folder in Path(__file__).resolve().parents[1:3])
RUN = os.path.join(HERE, "blender", "in_blender", "run.py")
MODULE, PROGRAM = "bpy module", "Blender program"


def environment(folder, **extra):
    """No user's settings, no display."""
    keep = {k: v for k, v in os.environ.items() if not k.startswith("BLENDER_") and k != "DISPLAY"}
    places = {f"BLENDER_USER_{name}": os.path.join(str(folder), name.lower()) for name in ("CONFIG", "SCRIPTS", "DATAFILES")}
    return {**keep, **places, "HOME": str(folder), **extra}


def program():
    """Debian's Blender, or what LANCER_TEST_BLENDER names."""
    path = os.environ.get("LANCER_TEST_BLENDER") or shutil.which("blender")
    assert path, "Blender is missing: apt-get install blender python3-numpy"
    return path


def command(which, result, where, name, *arguments):
    tail = ["--", str(result), where, name, *map(str, arguments)]
    if which == MODULE:
        return [sys.executable, RUN, *tail]
    return [program(), "-b", "--factory-startup", "--python-exit-code", "3", "-P", RUN, *tail]


def attempt(which, folder, where, name, *arguments, **extra):
    """(exit code, all that was said, the case's result or None). A hang of minutes is a failure."""
    result = os.path.join(str(folder), "result.json")
    done = subprocess.run(
        command(which, result, where, name, *arguments),
        env=environment(folder, **extra),
        cwd=str(folder),
        capture_output=True,
        text=True,
        errors="replace",
        timeout=300,
    )
    value = None
    if os.path.exists(result):
        with open(result, encoding="utf-8") as file:
            value = json.load(file)
    return done.returncode, done.stdout + done.stderr, value


def run(which, folder, where, name, *arguments, **extra):
    """The result of a case. A crash, a Python error: all are failures with the last lines said."""
    code, said, value = attempt(which, folder, where, name, *arguments, **extra)
    assert code == 0 and value is not None, f"exit code {code}\n{said[-3000:]}"
    if isinstance(value, dict):
        value["console"] = said
    return value


def zip_for_blender_3():
    """The newest classic zip of `make addon`, built when there is none."""
    pattern = os.path.join(ROOT, "build", "lancer-*-blender3.zip")
    if not glob.glob(pattern):
        subprocess.run([sys.executable, os.path.join(ROOT, ".ci", "package.py")], cwd=ROOT, check=True, capture_output=True)
    found = sorted(glob.glob(pattern), key=os.path.getmtime)
    assert found, "`make addon` gave no zip for Blender 3"
    return found[-1]
