"""How long Blender's window does not answer while it renders: gaps of a timer in its main loop, in a real window."""

import json
import subprocess
import tempfile
from pathlib import Path

import blenders
import windows

from . import jobs
from .estimates import middle

_SCRIPT = jobs.HERE.parent / "in_blender" / "window_gaps.py"
_SCREEN = (1280, 800)


def gaps(rounds, seconds, threads):
    """{engine: {longest, median: seconds}} of Lancer and Cycles by turns."""
    found = {"LANCER": [], "CYCLES": []}
    with windows.screen(*_SCREEN) as display:
        for _ in range(rounds):
            for engine, answers in found.items():
                answers.append(_measured(display, engine, seconds, threads))
    names = ("longest", "median")
    return {engine: {name: middle(answer[name] for answer in answers) for name in names} for engine, answers in found.items()}


def _measured(display, engine, seconds, threads):
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "gaps.json"
        place = ["-p", "0", "0", *map(str, _SCREEN)]
        arguments = [str(answer), engine, str(seconds), str(threads)]
        environment = blenders.environment(folder, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1")
        command = [blenders.program(), "--factory-startup", *place, "-P", str(_SCRIPT), "--", *arguments]
        try:
            subprocess.run(command, env=environment, cwd=folder, capture_output=True, timeout=jobs.LONGEST)
        except subprocess.TimeoutExpired:
            raise jobs.Failed(f"{engine} in a window: not done after {jobs.LONGEST:.0f} s") from None
        if not answer.exists():
            raise jobs.Failed(f"{engine} in a window gave no answer")
        return json.loads(answer.read_text())
