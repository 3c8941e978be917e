"""The parity scenes that are flagged as quick, small and with few samples; and the runner itself, with fake engines."""

import collections
import json
import os
import pathlib
import sys
import tempfile

import bpy
import numpy as np
from tools.parity import contest, engines, page, run

from addon.engine import render_engine as engine
from scenes.parity import catalogue


def subset(engine_name, pattern):
    """Compare the quick scenes. A difference that noise explains is no failure: a limit grows by 1.5 times the mean noise, that
    of the 99th percentile by four standard deviations of a block; two halves with different seeds give the noise."""
    outcomes = []
    with tempfile.TemporaryDirectory() as folder:
        for case in catalogue.select(pattern, quick=True):
            case = catalogue.smaller(case)
            outcomes.append(contest.run(case, folder, (engine_name, "CYCLES"), run.QUICK_SAMPLES, noise_aware=True))
    counts = collections.Counter(outcome.verdict for outcome in outcomes)
    return {
        "version": "{}.{}".format(*bpy.app.version),
        "names": [outcome.case.name for outcome in outcomes],
        "lines": [run.line(outcome) for outcome in outcomes],
        "counts": dict(counts),
        "absent": [outcome.case.name for outcome in outcomes if outcome.verdict == "absent"],
    }


def fast_names(*patterns):
    """Return the names of all fast scenes, and those that the patterns select, one pattern after another."""
    shares = [case.name for pattern in patterns for case in catalogue.select(pattern, quick=True)]
    return {"all": [case.name for case in catalogue.select("*", quick=True)], "shares": shares}


def runner():
    """Return the runner's verdicts on made-up pictures."""
    result = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, fields, ours, theirs, few in _contests():
            outcome = _contest(folder, name, fields, ours, theirs, few)
            result[name] = [outcome.verdict, outcome.note]
    return {**result, **_arithmetic(), **_page(), "exit codes": {verdict: _exit_code(verdict) for verdict in _VERDICTS}}


_VERDICTS = ("pass", "absent", "noise", "fail", "error")
_GREY = np.full((32, 48, 3), 0.5)


def _contests():
    """Yield (name, fields of the case, our picture, theirs, few samples); a picture is a function of the seed."""

    def grey(_):
        return {"Combined": _GREY}

    def bright(_):
        return {"Combined": 1.5 * _GREY}

    def mist(_):
        return {"Mist": _GREY[..., :1]}

    def noisy(sigma, name="Combined", channels=3):
        def picture(seed):
            noise = np.random.default_rng(seed).standard_normal((32, 48, channels))
            return {name: 0.5 + sigma * noise}

        return picture

    def black(seed):
        return {"Combined": 0.0 * _GREY}

    announced = {"announced": "Pixel Jitter"}
    data = {"kind_name": "PIXELS", "passes": ("Mist",)}
    return (
        ("announced, equal", {**announced, "build": _tell}, grey, grey, False),
        ("announced, different", {**announced, "build": _tell}, grey, bright, False),
        ("not announced, equal", announced, grey, grey, False),
        ("ours is missing", {"passes": ("Combined", "Mist")}, grey, lambda seed: {**grey(seed), **mist(seed)}, False),
        ("theirs is missing", {"passes": ("Combined", "Mist")}, lambda seed: {**grey(seed), **mist(seed)}, grey, False),
        ("shows nothing", {}, black, black, False),
        ("shows nothing and must", {"dark": ("Combined",)}, black, black, False),
        ("data", data, mist, mist, False),
        ("noisy data", data, noisy(1e-5, "Mist", 1), noisy(1e-5, "Mist", 1), False),
        ("noisy data, few samples", data, noisy(1e-5, "Mist", 1), noisy(1e-5, "Mist", 1), True),
        ("some noise", {}, noisy(0.05), noisy(0.05), False),
        ("some noise, few samples", {}, noisy(0.05), noisy(0.05), True),
        ("much noise, few samples", {}, noisy(0.5), noisy(0.5), True),
        ("raises", {"build": _raise}, grey, grey, False),
        ("too new", {"since": (99, 0)}, grey, grey, False),
        ("gone", {"until": (3, 0)}, grey, grey, False),
    )


def _tell(scene):
    engine.last_messages[scene.name] = ["scene 'Scene': Cycles' Pixel Jitter is not supported"]


def _raise(scene):
    raise RuntimeError("no such mesh")


def _contest(folder, name, fields, ours, theirs, few=False):
    def render(scene, engine_name, case, samples, seed, folder):
        return ours(seed + 500) if engine_name == "LANCER" else theirs(seed)

    engine.last_messages.clear()
    case = catalogue.Case(name, "test", **{"build": lambda scene: None, **fields})
    genuine, engines.render = engines.render, render
    try:
        # A second round of samples would only repeat the same noise.
        return contest.run(case, folder, most_samples=case.samples // 2, noise_aware=few)
    finally:
        engines.render = genuine


def _arithmetic():
    kinds = ("Diffuse", "Glossy", "Transmission")
    values = {"Emission": 2.0, "Environment": 3.0}
    values.update(
        zip(
            (f"{kind} {part}" for kind in kinds for part in ("Direct", "Indirect")),
            (5.0, 7.0, 11.0, 13.0, 17.0, 19.0),
            strict=True,
        )
    )
    values.update(zip((f"{kind} Color" for kind in kinds), (0.5, 0.25, 0.125), strict=True))
    halves = contest._sum_of_passes({name: (np.array(value), np.array(value)) for name, value in values.items()})
    scene = contest.open_empty()
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.camera.location = (1, 2, 3)
    scene.collection.objects.link(scene.camera)
    bpy.context.view_layer.update()
    seen = np.array([[(1, 2, 8), (4, 6, 3), (0, 0, 0)]], float)
    return {"sum": float(halves[0]), "distances": contest._distances(scene, (seen, seen)).ravel().tolist()}


def _page():
    with tempfile.TemporaryDirectory() as folder:
        different = {"announced": "Pixel Jitter"}
        outcomes = [
            _contest(folder, "shown", different, lambda _: {"Combined": 1.5 * _GREY}, lambda _: {"Combined": _GREY}),
            _contest(folder, "hidden", {"since": (99, 0)}, None, None),
        ]
        page.write(outcomes, pathlib.Path(folder), "Lancer and Cycles")
        with open(os.path.join(folder, "index.html"), encoding="utf-8") as file:
            text = file.read()
        with open(os.path.join(folder, "parity.json"), encoding="utf-8") as file:
            record = json.load(file)
        return {"page": text, "record": record, "pictures": sorted(os.listdir(os.path.join(folder, "pictures")))}


def _exit_code(verdict):
    """Return the exit code of `make parity` if one scene passes and another has this verdict."""
    verdicts = iter(("pass", verdict))
    genuine, argv = contest.run, sys.argv
    contest.run = lambda case, *_, **__: contest.Outcome(case, next(verdicts))
    with tempfile.TemporaryDirectory() as folder:
        sys.argv = ["run.py", "--only", "point_hard,point_soft", "--output", folder]
        try:
            return run.main()
        finally:
            contest.run, sys.argv = genuine, argv
