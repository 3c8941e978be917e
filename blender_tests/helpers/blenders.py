"""Where the Blenders are, and how a case runs inside one. A crash or a hang fails its own case and costs no other."""

import atexit
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from blender_server import BlenderServer

# Tools ask for Blenders, too, where there is no pytest.
ROOT = str(Path(__file__).resolve().parents[2])
MODULE, PROGRAM = "bpy module", "Blender program"
_INSTALL = """
import bpy, sys
bpy.ops.preferences.addon_install(filepath=sys.argv[-1])
bpy.ops.preferences.addon_enable(module="lancer")
bpy.ops.wm.save_userpref()
"""
_servers = {}


def places(folder):
    """The variables that keep a user's settings out."""
    names = ("CONFIG", "SCRIPTS", "DATAFILES")
    return {"HOME": str(folder), **{f"BLENDER_USER_{name}": os.path.join(str(folder), name.lower()) for name in names}}


def environment(folder, **extra):
    """No user's settings, no display."""
    keep = {k: v for k, v in os.environ.items() if not k.startswith("BLENDER_") and k != "DISPLAY"}
    return {**keep, **places(folder), **extra}


def program():
    """Debian's Blender, or what LANCER_TEST_BLENDER names."""
    path = os.environ.get("LANCER_TEST_BLENDER") or shutil.which("blender")
    assert path, "Blender is missing: apt-get install blender python3-numpy"
    return path


def module_python():
    """This Python, or what LANCER_TEST_PYTHON names: its bpy module is installed into."""
    return os.environ.get("LANCER_TEST_PYTHON") or sys.executable


def _start(which, folder, **extra):
    path = None if which == MODULE else program()
    return BlenderServer(path, environment(folder, **extra), os.path.join(str(folder), "blender.txt"))


def _shared(which):
    """The Blender of a kind that runs case after case."""
    server = _servers.get(which)
    if server is None or not server.is_open:
        server = _servers[which] = _start(which, tempfile.mkdtemp(prefix="lancer-blender-"))
    return server


@atexit.register
def close_all():
    for server in _servers.values():
        if server.is_open:
            server.close()
        shutil.rmtree(os.path.dirname(server.output), ignore_errors=True)


def attempt(which, folder, where, name, *arguments, alone=False, **extra):
    """(exit code, all that was said, the case's result or None).

    alone: in a process of its own, whose start and end are part of it; so is a case with other variables of the environment,
    which are extra.
    """
    alone = alone or bool(extra)
    server = _start(which, folder, **extra) if alone else _shared(which)
    # The folder may have the files of a case before.
    result, log = (os.path.join(str(folder), file) for file in ("result.json", "said.txt"))
    for path in (result, log):
        if os.path.exists(path):
            os.remove(path)
    code = server.run(
        folder=str(folder),
        log=log,
        environment={**places(folder), **extra},
        where=where,
        name=name,
        arguments=[str(argument) for argument in arguments],
        result=result,
    )
    if alone or code:
        # A Blender in which a case has failed is not the one to run the next.
        ended = server.close() if server.is_open else code
        code = code or ended
    said = "".join(_text(path) for path in ((server.output, log) if alone or not os.path.exists(log) else (log,)))
    return code, said, json.loads(_text(result)) if os.path.exists(result) else None


def _text(path):
    return Path(path).read_text(encoding="utf-8", errors="replace") if os.path.exists(path) else ""


def run(which, folder, where, name, *arguments, **how):
    """The result of a case, as attempt() takes it. A crash, a Python error: all are failures with the last lines said."""
    code, said, value = attempt(which, folder, where, name, *arguments, **how)
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


def install(folder):
    """Install the add-on from its zip into a user's folder of Debian's Blender."""
    start = [program(), "-b", "--factory-startup", "--python-exit-code", "3"]
    done = subprocess.run(
        [*start, "--python-expr", _INSTALL, "--", zip_for_blender_3()],
        env=environment(folder),
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
    )
    assert done.returncode == 0, done.stdout + done.stderr
