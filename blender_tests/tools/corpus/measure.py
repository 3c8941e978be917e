"""Measure one file with both engines: a first render, renders by turns with the same seeds and samples, and a verdict."""

import dataclasses
import tempfile
import time
from pathlib import Path

import numpy as np

from scenes.parity import figures
from tools.harness import denoised
from tools.harness.conversation import Ended
from tools.harness.displayed import Displayed
from tools.harness.pictures import write_pair
from tools.harness.turns import by_turns
from tools.parity.page import as_record

from . import noise

# Real files mix Principled and multiple scattering with everything else.
KIND = figures.KINDS["LOBES"]
# Besides the blocks of that kind, the picture is compared in this many larger squares across, whose means have less noise.
_LARGE_SQUARES = 8
ENGINES = ("LANCER", "CYCLES")
# Least share of the budget for renders, however long opening the file takes.
_LEAST_SHARE = 0.4
# Verdicts of files whose pictures converge to the same, and the seed of their denoised pictures, beyond those of the rounds.
_COMPARABLE = ("equal", "noise")
_DENOISED_SEED = 501
# A file that differs without a message is rendered once more with this many times the samples.
_AGAIN = 4


@dataclasses.dataclass(frozen=True)
class Plan:
    """pixels: of the longer side; budget: seconds for all renders of a file; limit: seconds for one request."""

    pixels: int = 320
    budget: float = 60.0
    probe: int = 4  # samples of the first look
    rounds: int = 4  # seeds of each engine, an even number
    least: int = 4
    most: int = 1024
    limit: float = 300.0
    threads: int = 2
    memory: float = 8e9  # bytes of one process
    denoised: bool = False  # whether denoised pictures are compared, too


QUICK = Plan(budget=8.0, probe=2, rounds=2, least=2, most=64, limit=120.0)


class Measurement:
    """start(engine): returns a Conversation with a new worker; show(text): shows the progress."""

    def __init__(self, file, plan, start, pictures, show):
        self.file, self.plan, self.pictures, self.show = file, plan, pictures, show
        self._start = start
        self._talks = {}
        self.row = {"name": file.name, "kind": file.kind, "note": file.note, "engines": {}, "told": [], "alike": []}
        self.row |= {"messages": [], "missing": {}}

    def run(self):
        """Return the row of the file: its verdict, one of verdicts.ORDER, a sentence, and all figures."""
        began = time.monotonic()
        try:
            if self.file.missing:
                return self._end("missing", self.file.missing)
            with tempfile.TemporaryDirectory() as folder:
                self._folder = Path(folder)
                return self._contest()
        finally:
            for talk in self._talks.values():
                talk.__exit__()
            self.row["seconds"] = round(time.monotonic() - began, 1)

    def _end(self, verdict, sentence=""):
        self.row |= {"verdict": verdict, "sentence": sentence}
        return self.row

    def _contest(self):
        for engine in ENGINES:
            self.show(f"opening for {engine.title()}")
            try:
                self._open(engine)
            except Ended as end:
                return self._end("unreadable", str(end))
        # If one engine cannot render a file, the page still shows the other's picture.
        failures, probes = {}, {}
        for engine in ENGINES:
            try:
                probes[engine] = self._render(engine, self.plan.probe, 0)
            except Ended as end:
                failures[engine] = end
        for engine, verdict in zip(ENGINES, ("failed", "cycles"), strict=True):
            if engine in failures:
                self._show_alone(probes)
                return self._end(verdict, f"{failures[engine].kind}: {failures[engine]}")
        if probes["LANCER"][1].get("instances") == 0:
            self.row["told"].append("no surface renders")
        dark = {engine for engine, (picture, _) in probes.items() if not np.nan_to_num(picture[..., :3]).any()}
        if len(dark) == 2:
            self._write(*(probe[0] for probe in probes.values()))
            return self._end("black", "both pictures are black")
        try:
            return self._rounds({engine: figures_ for engine, (_, figures_) in probes.items()})
        except Ended as end:
            return self._end("failed" if self._asked == "LANCER" else "cycles", f"{end.kind}: {end}")

    def _open(self, engine):
        self._asked = engine
        self._talks[engine] = self._start(engine)
        fields = {"pixels": self.plan.pixels, "threads": self.plan.threads, "path": str(self.file.path)}
        opened = self._talks[engine].ask("open", self.plan.limit, self.plan.memory, **fields)
        self.row |= opened

    def _render(self, engine, samples, seed):
        """Return (picture, figures); add the render's messages to the row."""
        self._asked = engine
        self.show(f"{engine.title()}, {samples} samples, seed {seed}")
        path = self._folder / f"{engine}.npy"
        fields = {"engine": engine, "samples": samples, "seed": seed, "picture": str(path)}
        found = self._talks[engine].ask("render", self.plan.limit, self.plan.memory, **fields)
        self.row["size"] = found["size"]
        for name in ("messages", "missing"):
            self.row[name] = found.pop(name, self.row[name])
        record = self.row["engines"].setdefault(engine, {"peak_bytes": 0})
        found["peak_bytes"] = max(found["peak_bytes"], record["peak_bytes"])
        record.update({name: value for name, value in found.items() if name not in ("wall", "seconds", "size")})
        # The time before the first ray and after the last one.
        record.setdefault("setup_seconds", max(0.0, found["wall"] - found["seconds"]))
        return np.load(path), found

    def _samples(self, probes):
        """Return the number of samples, a power of two, for which all rounds of both engines take about the budget."""
        plan = self.plan
        per_sample = sum(max(found["seconds"], 1e-3) / plan.probe for found in probes.values())
        setups = sum(record["setup_seconds"] for record in self.row["engines"].values())
        left = max(_LEAST_SHARE * plan.budget, plan.budget - setups * (plan.rounds + 1)) / plan.rounds
        samples = plan.least
        while 2 * samples <= plan.most and 2 * samples * per_sample <= left:
            samples *= 2
        return samples

    def _rounds(self, probes):
        samples = self._samples(probes)
        self._look(samples, 1)
        if self.row["verdict"] == "untold" and samples < self.plan.most:
            # A difference by chance must not count as a fault.
            self.row["first_look"] = self.row["parity"]
            self._look(_AGAIN * samples, 1 + self.plan.rounds)
        return self.row

    def _look(self, samples, first_seed):
        """Render by turns, judge, and fill the row."""
        found = by_turns(self.plan.rounds, ENGINES, lambda engine, number: self._render(engine, samples, first_seed + number))
        seconds = {engine: sum(told["seconds"] for _, told in found[engine]) for engine in ENGINES}
        ours, theirs = (np.array([picture for picture, _ in found[engine]], np.float64) for engine in ENGINES)
        self._judge(ours, theirs)
        pixels = ours.shape[1] * ours.shape[2]
        for engine in ENGINES:
            rate = pixels * samples * self.plan.rounds / max(seconds[engine], 0.01)
            self.row["engines"][engine] |= {"seconds": seconds[engine], "samples_per_second": rate}
        self.row |= {"samples": samples, "rounds": self.plan.rounds}
        self._compare_noise(*_finite(ours, theirs), seconds)
        if self.plan.denoised and self.row["verdict"] in _COMPARABLE:
            self._compare_denoised(*_finite(ours, theirs))

    def _compare_denoised(self, ours, theirs):
        """Compare denoised pictures; the means of even and of odd seeds are the references."""
        curves = {}
        for engine, pictures in zip(ENGINES, (ours, theirs), strict=True):
            self._asked = engine
            self.show(f"{engine.title()}, denoised")
            fields = {"engine": engine, "counts": denoised.COUNTS[2:8], "seed": _DENOISED_SEED, "folder": str(self._folder)}
            limit = len(denoised.COUNTS) * self.plan.limit
            walls = self._talks[engine].ask("denoised", limit, self.plan.memory, **fields)
            points = [(count, seconds, np.load(self._folder / f"{count}.npy")[..., :3]) for count, seconds in walls]
            reference = Displayed.of([pictures[start::2].mean(axis=0)[..., :3] for start in (0, 1)])
            curves[engine] = denoised.measured([points], reference)
        self.row["denoised"] = {"curves": curves, "compared": denoised.compared(*curves.values())}

    def _judge(self, ours, theirs):
        if ours.shape != theirs.shape:
            sizes = " and ".join(f"{values.shape[2]} x {values.shape[1]}" for values in (ours, theirs))
            return self._end("untold", f"pictures of different sizes: {sizes}")
        self._write(ours.mean(axis=0), theirs.mean(axis=0))
        self._tell_invalid(ours, theirs)
        parts = _parts(*_finite(ours, theirs))
        names = {part: figures.judge(numbers, KIND.limit).name for part, numbers in parts.items()}

        def badness(part):
            return -figures.WORST_FIRST.index(names[part]), figures.share(figures.decisive(parts[part], KIND.limit), KIND.limit)

        worst = max(parts, key=badness)
        numbers, name = figures.decisive(parts[worst], KIND.limit), names[worst]
        self.row["parity"] = {**as_record(numbers), "part": worst, "name": name}
        mean, p99 = f"mean {numbers.mean:.2%}", f"99th percentile {numbers.p99:.2%}"
        sentence = f"{worst}: {mean}, {p99}; noise {numbers.noise_mean:.2%} and {numbers.noise_p99:.2%}"
        if name == "fail":
            name = "told" if self.row["missing"] else "untold"
        return self._end({"pass": "equal"}.get(name, name), sentence)

    def _tell_invalid(self, ours, theirs):
        for engine, values in zip(ENGINES, (ours, theirs), strict=True):
            count = int((~np.isfinite(values)).any(axis=(0, 3)).sum())
            if count:
                text = f"{engine.title()} wrote {count} pixels that are not finite"
                self.row["told"] = [*(line for line in self.row["told"] if line != text), text]

    def _compare_noise(self, ours, theirs, seconds):
        found = noise.compare(*noise.relative_variance(ours, theirs))
        # A picture without noise, such as one of the sky alone, has no efficiency.
        if found:
            speed = seconds["CYCLES"] / max(seconds["LANCER"], 0.01)
            self.row |= {"speed": speed, "variance": found, "efficiency": speed / found["ratio"]}

    def _write(self, ours, theirs):
        """Write the pictures for the page, row 0 at the top."""
        self.pictures.mkdir(parents=True, exist_ok=True)
        flipped = (np.nan_to_num(values[::-1, :, :3], posinf=0.0, neginf=0.0) for values in (ours, theirs))
        self.row["pictures"] = write_pair(str(self.pictures), self.file.slug, *flipped)

    def _show_alone(self, probes):
        if probes:
            (picture, _) = next(iter(probes.values()))
            self._write(*(probes.get(engine, (np.zeros_like(picture), None))[0] for engine in ENGINES))


def _finite(ours, theirs):
    """Return both with pixels set to 0 where either has a value that is not finite."""
    good = (np.isfinite(ours) & np.isfinite(theirs)).all(axis=(0, 3))[None, :, :, None]
    return np.where(good, ours, 0.0), np.where(good, theirs, 0.0)


def _parts(ours, theirs):
    """Return {name: Figures} from the means of even and of odd seeds."""
    halves = [[values[start::2].mean(axis=0) for start in (0, 1)] for values in (ours, theirs)]
    large = KIND._replace(block=max(KIND.block, max(ours.shape[1:3]) // _LARGE_SQUARES))
    parts = {"Combined": (slice(0, 3), KIND), "Combined, large squares": (slice(0, 3), large), "Alpha": (slice(3, 4), KIND)}
    return {
        name: figures.measure(*([half[..., part] for half in pair] for pair in halves), kind)
        for name, (part, kind) in parts.items()
    }
