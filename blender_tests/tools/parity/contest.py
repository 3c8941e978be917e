"""One case by both engines: build, render in halves, add samples until the noise is small, judge."""

import time
from dataclasses import dataclass, field

import bpy
import numpy as np

from scenes.parity import figures

from . import engines

# With few samples, the most that noise may add to a limit, in limits. `make test` must find faults that are larger.
MOST_ADDED = 3.0


@dataclass
class Outcome:
    case: object
    verdict: str = "error"  # pass, fail, noise, error, absent
    note: str = ""  # a remark, in a sentence
    samples: int = 0  # of each engine
    seconds: dict = field(default_factory=dict)  # by engine
    parts: dict = field(default_factory=dict)  # pass -> (Figures, Verdict)
    pictures: dict = field(default_factory=dict)  # pass -> (ours, theirs)
    messages: list = field(default_factory=list)

    @property
    def worst(self):
        """Return the pass with the worst verdict; of several, the one with the largest difference relative to its limits."""
        limit = self.case.limits

        def badness(name):
            numbers, verdict = self.parts[name]
            return figures.WORST_FIRST[::-1].index(verdict.name), figures.share(figures.decisive(numbers, limit), limit)

        return max(self.parts, key=badness, default=None)


class Halves:
    """The two halves of one engine's pictures, each the mean of its renders. render: in place of engines.render."""

    def __init__(self, engine, render=None):
        self.engine = engine
        self._render = render or engines.render
        self.seconds = 0.0
        self._sums = ({}, {})
        self._samples = 0

    def add(self, scene, case, samples, seed, folder):
        started = time.perf_counter()
        for half in (0, 1):
            pictures = self._render(scene, self.engine, case, samples, seed + half, folder)
            for name, picture in pictures.items():
                sums = self._sums[half]
                sums[name] = sums.get(name, 0.0) + samples * picture.astype(np.float64)
        self._samples += samples
        self.seconds += time.perf_counter() - started

    @property
    def pictures(self):
        """Return {pass: (half, half)}."""
        first, second = self._sums
        return {name: (first[name] / self._samples, second[name] / self._samples) for name in first if name in second}


def run(case, folder, engine_pair=("LANCER", "CYCLES"), most_samples=1024, noise_aware=False, first_seed=1):
    """Return the Outcome of a case. most_samples: of each half. noise_aware: a difference that noise explains is no failure."""
    outcome = Outcome(case)
    absent = _absent(case)
    if absent:
        outcome.verdict, outcome.note = "absent", absent
        return outcome
    try:
        _contest(case, outcome, folder, engine_pair, most_samples, first_seed)
    except Exception as error:
        # A scene that raises an error is one line of the page; the others still run.
        first_line = next(iter(str(error).splitlines()), "")
        outcome.verdict, outcome.note = "error", f"{type(error).__name__}: {first_line}"
        return outcome
    if outcome.verdict == "noise" and noise_aware and _bearable(case, outcome):
        outcome.verdict = "pass"
    if case.announced and "LANCER" in engine_pair and not any(case.announced in text for text in outcome.messages):
        outcome.verdict, outcome.note = "fail", f"no message says '{case.announced}'"
    return outcome


def _bearable(case, outcome):
    """Return whether noise adds at most MOST_ADDED limits to each limit; to limits of data it may add nothing."""
    limit = case.limits
    return case.kind.averages and all(
        more.mean <= MOST_ADDED * limit.mean and more.p99 <= MOST_ADDED * limit.p99
        for more in (figures.allowance(numbers) for numbers, _ in outcome.parts.values())
    )


def _absent(case):
    version = bpy.app.version[:2]
    if version < case.since:
        return f"needs Blender {case.since[0]}.{case.since[1]}"
    if version >= case.until:
        return f"gone since Blender {case.until[0]}.{case.until[1]}"
    return case.needs() if case.needs else ""


def open_empty():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.view_settings.view_transform = "Standard"
    return scene


def _contest(case, outcome, folder, engine_pair, most_samples, first_seed):
    scene = open_empty()
    case.build(scene)
    scene = bpy.context.scene
    pairs = [Halves(engine) for engine in engine_pair]
    samples, seed = min(case.samples, most_samples), first_seed
    while True:
        for index, halves in enumerate(pairs):
            # A contest of an engine with itself needs different seeds.
            halves.add(scene, case, samples, seed + (1000 if index and engine_pair[0] == engine_pair[1] else 0), folder)
        outcome.samples += 2 * samples
        outcome.seconds = {halves.engine: halves.seconds for halves in pairs}
        _judge(case, outcome, scene, pairs[0].pictures, pairs[1].pictures)
        verdicts = [verdict for _, verdict in outcome.parts.values()]
        limit = case.limits
        settled = all(
            verdict.name == "pass"
            and (verdict.quiet or all(figures.enough(n, limit) for n in (numbers, numbers.dim) if n))
            or any(figures.hopeless(n, limit) for n in (numbers, numbers.dim) if n)
            for numbers, verdict in outcome.parts.values()
        )
        # The next round doubles the samples.
        samples, seed = outcome.samples // 2, seed + 2
        if settled or not case.kind.averages or outcome.samples > most_samples:
            break
    names = [verdict.name for verdict in verdicts]
    outcome.verdict = next(name for name in figures.WORST_FIRST if name in names)
    if not all(verdict.quiet for verdict in verdicts) and outcome.verdict != "fail":
        outcome.note = "the noise is above a third of the limit"
        if not case.kind.averages:
            # More samples do not help: data must not depend on the seed.
            outcome.verdict = "noise"
    outcome.messages = _messages(scene)


def _judge(case, outcome, scene, ours, theirs):
    missing = set(case.passes) - set(theirs)
    if missing:
        raise ValueError(f"Cycles wrote no pass {', '.join(sorted(missing))}")
    if case.sum_of_passes:
        ours, theirs = {"Sum": _sum_of_passes(ours)}, {"Sum": ours["Combined"]}
    dark = [name for name, (one, other) in theirs.items() if not (one.any() or other.any()) and name not in case.dark]
    if dark:
        raise ValueError(f"Cycles shows nothing in {', '.join(sorted(dark))}")
    for name, pair in theirs.items():
        if name not in ours:
            raise ValueError(f"Lancer wrote no pass {name}")
        scale = _distances(scene, pair) if name == "Position" else None
        if ours[name][0].shape != pair[0].shape:
            raise ValueError(f"{name}: Lancer's picture is {ours[name][0].shape}, Cycles' is {pair[0].shape}")
        numbers = figures.measure(ours[name], pair, case.kind, scale)
        outcome.parts[name] = (numbers, figures.judge(numbers, case.limits))
        outcome.pictures[name] = tuple((a + b) / 2 for a, b in (ours[name], pair))


def _sum_of_passes(pictures):
    """Return Combined as the sum of its passes, half by half."""

    def whole(half):
        total = pictures["Emission"][half] + pictures["Environment"][half]
        for kind in ("Diffuse", "Glossy", "Transmission"):
            light = pictures[f"{kind} Direct"][half] + pictures[f"{kind} Indirect"][half]
            total = total + light * pictures[f"{kind} Color"][half]
        return total

    return whole(0), whole(1)


def _distances(scene, pair):
    """Return the distance of each pixel's surface from the camera, (height, width, 1); the mean distance if there is none."""
    picture = (pair[0] + pair[1]) / 2
    seen = np.any(picture != 0.0, axis=-1, keepdims=True)
    distances = np.linalg.norm(picture - np.array(scene.camera.matrix_world.translation), axis=-1, keepdims=True)
    return np.where(seen, distances, distances[seen].mean())


def _messages(scene):
    from addon.engine import render_engine as engine

    return list(engine.last_messages.get(scene.name, ()))
