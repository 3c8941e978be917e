"""What an artist at a real window waits for: gaps of Blender's main loop in a render, pictures of a 3D view."""

import json
import subprocess
import tempfile
from pathlib import Path

import blenders
import windows

from . import jobs
from .estimates import middle

_SCRIPTS = jobs.ROOT / "blender_tests" / "blender" / "in_blender"
_ENGINES = ("LANCER", "CYCLES")
_SCREEN = (1280, 800)
_REGION = (960, 540)


def gaps(rounds, seconds, threads):
    """{engine: {longest, median: seconds}} of Lancer and Cycles by turns."""
    answers = _by_turns(rounds, "window_gaps.py", _SCREEN, seconds, threads)
    return {engine: _middles(found, ("longest", "median")) for engine, found in answers.items()}


def view(rounds, threads):
    """{engine: {edits, moves: seconds until seen, pictures_per_second, pixel_size}} of both engines by turns."""
    answers = _by_turns(rounds, "window_view.py", _REGION, threads)
    for answer in (answer for found in answers.values() for answer in found):
        if answer["region"] != list(_REGION):
            raise jobs.Failed(f"the view has {answer['region']} pixels")
        # Of several edits and moves in one window.
        answer.update({name: middle(answer[name])["median"] for name in ("edits", "moves")})
    names = ("edits", "moves", "pictures_per_second")
    figures = {engine: _middles(found, names) for engine, found in answers.items()}
    figures["LANCER"].update(_middles(answers["LANCER"], ("pixel_size",)))
    return figures


def _middles(answers, names):
    return {name: middle(answer[name] for answer in answers) for name in names}


def _by_turns(rounds, script, size, *arguments):
    """{engine: what each window answered}"""
    found = {engine: [] for engine in _ENGINES}
    with windows.screen(*_SCREEN) as display:
        for _ in range(rounds):
            for engine, answers in found.items():
                answers.append(_measured(display, script, size, engine, *arguments))
    return found


def _measured(display, script, size, engine, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "answer.json"
        place = ["-p", "0", "0", *map(str, size)]
        given = [str(answer), engine, *map(str, arguments)]
        environment = blenders.environment(folder, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1")
        command = [blenders.program(), "--factory-startup", *place, "-P", str(_SCRIPTS / script), "--", *given]
        try:
            subprocess.run(command, env=environment, cwd=folder, capture_output=True, timeout=jobs.LONGEST)
        except subprocess.TimeoutExpired:
            raise jobs.Failed(f"{engine} in a window: not done after {jobs.LONGEST:.0f} s") from None
        if not answer.exists():
            raise jobs.Failed(f"{engine} in a window gave no answer")
        return json.loads(answer.read_text())
