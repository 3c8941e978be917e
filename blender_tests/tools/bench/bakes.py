"""Bakes of a room and of a thing outdoors by Lancer and Cycles: the errors of their texels, by turns."""

import numpy as np

from tools.harness import errors, estimates, workers
from tools.harness.turns import by_turns, middles

from . import jobs

# The scene, the baked object, and the samples of both engines.
_BAKED = {"room": ("Tall block", 256), "sun": ("Column 1 1", 256)}
_KINDS = ("COMBINED", "DIFFUSE")
_ENGINES = ("LANCER", "CYCLES")


def measure(rounds, threads, quick, say):
    """Return {scene, kind: figures}; each round has another seed.

    efficiency_ratio: Lancer's over Cycles' of 1 / (squared error x seconds); of_processors: by their seconds.
    """
    found = {}
    for name, (thing, samples) in _BAKED.items():
        for kind in _KINDS:
            settings = {"name": name, "thing": thing, "kind": kind, "threads": threads}
            settings |= {"side": 64, "samples": samples // 4} if quick else {"side": 128, "samples": samples}
            found[f"{name}, {kind.lower()}"] = figures = _both(max(3, rounds), settings)
            say(f"bake of {name}, {kind.lower()}: {figures['efficiency_ratio']['value']:.2f}x of Cycles' efficiency")
    return found


def _both(rounds, settings):
    path = jobs.OUTPUT / "pictures" / "bake.npy"

    def render(engine, number):
        answer = workers.ask("bench.bake_worker", "bake", engine=engine, seed=number + 1, path=str(path), **settings)
        return answer, np.load(path)

    turns = by_turns(rounds, _ENGINES, render)
    pictures = {engine: np.stack([errors.luminance(picture) for _, picture in found]) for engine, found in turns.items()}
    means = {engine: found.mean(axis=0) for engine, found in pictures.items()}
    # Texels without a surface are black in every picture.
    shown = np.logical_or.reduce([found.any(axis=0) for found in pictures.values()])
    level = errors.level_of(means["CYCLES"][shown])
    squares, result = {}, {}
    for engine, found in turns.items():
        # The squared distance from the mean of all is (n - 1)/n of the variance.
        apart = (pictures[engine] - means[engine])[:, shown] / level
        squares[engine] = (np.mean(apart**2, axis=1) * rounds / (rounds - 1)).tolist()
        result[engine] = middles([answer for answer, _ in found]) | {"squared_errors": squares[engine]}
    for ratio, clock in (("efficiency_ratio", "seconds"), ("efficiency_ratio_of_processors", "cpu_seconds")):
        pairs = [(squares[engine], [answer[clock] for answer, _ in turns[engine]]) for engine in _ENGINES]
        result[ratio] = estimates.efficiency_ratio(*pairs)
    result["level_ratio"] = float(means["LANCER"][shown].mean() / means["CYCLES"][shown].mean())
    return result
