"""Delays that an artist sees in a real window: gaps of Blender's main loop in a render, pictures of a 3D view."""

import json
import subprocess
import tempfile
from pathlib import Path

import blenders
import windows

from tools.harness.places import ROOT
from tools.harness.turns import by_turns, middle, middles
from tools.harness.workers import LONGEST, Failed

_SCRIPTS = ROOT / "blender_tests" / "blender" / "in_blender"
_ENGINES = ("LANCER", "CYCLES")
_SCREEN = (1280, 800)
_REGION = (960, 540)


def gaps(rounds, seconds, threads):
    """Return {engine: {longest, median: seconds}} of Lancer and Cycles, measured by turns."""
    answers = _answers(rounds, "window_gaps.py", _SCREEN, seconds, threads)
    return {engine: middles(found, ("longest", "median")) for engine, found in answers.items()}


def view(rounds, threads):
    """Return {engine: {edits, moves: seconds until shown, pictures_per_second, pixel_size}}, measured by turns."""
    answers = _answers(rounds, "window_view.py", _REGION, threads)
    for answer in (answer for found in answers.values() for answer in found):
        if answer["region"] != list(_REGION):
            raise Failed(f"the view has {answer['region']} pixels")
        # Medians of several edits and moves in one window.
        answer.update({name: middle(answer[name])["median"] for name in ("edits", "moves")})
    names = ("edits", "moves", "pictures_per_second")
    figures = {engine: middles(found, names) for engine, found in answers.items()}
    figures["LANCER"].update(middles(answers["LANCER"], ("pixel_size",)))
    return figures


def edits(rounds, threads):
    """Return {engine: {kind of edit: seconds until shown}} in a view of a million faces, measured by turns.

    hold: the longest seconds for which the add-on held Blender's main loop.
    """
    answers = _answers(rounds, "window_edits.py", _REGION, threads)
    names = [name for name in answers["LANCER"][0] if name not in ("region", "hold")]
    for answer in (answer for found in answers.values() for answer in found):
        answer.update({name: middle(answer[name])["median"] for name in names})
    figures = {engine: middles(found, names) for engine, found in answers.items()}
    figures["LANCER"].update(middles(answers["LANCER"], ("hold",)))
    return figures


def shared(threads):
    """Return {LANCER: {first, second: bytes that a 3D view of a million faces adds to the program}}."""
    with windows.screen(*_SCREEN) as display:
        return {"LANCER": _measured(display, "window_shared.py", _SCREEN, "LANCER", threads)}


def _answers(rounds, script, size, *arguments):
    """Return {engine: [answer of each window]}."""
    with windows.screen(*_SCREEN) as display:
        return by_turns(rounds, _ENGINES, lambda engine, _: _measured(display, script, size, engine, *arguments))


def _measured(display, script, size, engine, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "answer.json"
        place = ["-p", "0", "0", *map(str, size)]
        given = [str(answer), engine, *map(str, arguments)]
        environment = blenders.environment(folder, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1")
        command = [blenders.program(), "--factory-startup", *place, "-P", str(_SCRIPTS / script), "--", *given]
        try:
            subprocess.run(command, env=environment, cwd=folder, capture_output=True, timeout=LONGEST)
        except subprocess.TimeoutExpired:
            raise Failed(f"{engine} in a window: not done after {LONGEST:.0f} s") from None
        if not answer.exists():
            raise Failed(f"{engine} in a window gave no answer")
        return json.loads(answer.read_text())
