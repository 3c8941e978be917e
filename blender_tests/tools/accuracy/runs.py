"""Render one scene many times, and compare the error that each render reports with its actual error."""

import dataclasses
import hashlib
import math
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from addon.bindings.abi import Pass
from addon.bindings.session import Scene, Session
from addon.denoise import view_layer
from addon.measure.schedule import SAMPLES, TARGET, Schedule
from tools.harness.errors import Reference, luminance, root_mean_square
from tools.harness.kept import kept_picture

from . import denoised, figures

REFERENCE_PARTS = 8
# Far from the seeds of the runs.
_REFERENCE_SEED = 1001
# More samples than any pixel of a run takes: runs end at their targets, never at this limit.
_UNBOUNDED = 1 << 20


@dataclasses.dataclass(frozen=True)
class Plan:
    seeds: int = 20
    counts: tuple = (64, 256)
    denoised: tuple = (16, 64, 256)
    targets: tuple = (0.1, 0.05, 0.02, 0.01)
    # Samples per pixel that a run may take on average: a target that needs more is scaled up.
    budgets: tuple = (32, 96, 160, 256)
    reference: float = 1.0  # share of the samples that the scene asks for
    threads: int = 2


QUICK = Plan(seeds=6, counts=(64,), denoised=(16, 64), targets=(0.05,), budgets=(96,), reference=0.25)


class Measured:
    """A scene that is uploaded once and rendered with many settings."""

    def __init__(self, scene, plan, folder, say):
        self.name, self.plan, self.folder, self.say = scene.name, plan, Path(folder), say
        self.snapshot = scene.build()
        self.samples = max(64, int(scene.reference * plan.reference))

    def measure(self):
        with Scene.upload(self.snapshot) as self.uploaded:
            reference = self._reference()
            result = {"reference": {"samples": self.samples, "error": reference.error, "noisy": float(reference.noisy.mean())}}
            even, last = self._even(reference)
            result["even"] = even
            result["targets"] = self._targets(reference, last)
            result["denoised"] = self._denoised(reference)
        return result

    def _session(self, seed, **settings):
        # Paths split as in a render by F12.
        settings = dataclasses.replace(self.snapshot.settings, threads=1, seed=seed, split_lights=0, split_paths=0, **settings)
        return Session(self.uploaded, self.snapshot.camera, settings)

    def _each(self, function, seeds, what):
        """Return [function(seed)]; as many run at a time as there are threads. Each has one thread, which changes no bit."""
        results = []
        with ThreadPoolExecutor(self.plan.threads) as pool:
            for result in pool.map(function, seeds):
                results.append(result)
                self.say(f"{self.name}: {what}, {len(results)} of {len(seeds)}")
        return results

    def _fingerprint(self):
        """Return a digest of the picture's first samples: a reference is valid as long as it is the same."""
        with self._session(_REFERENCE_SEED, samples=16) as session:
            session.render_all()
            return hashlib.sha256(session.read().tobytes()).hexdigest()[:16]

    def _reference(self):
        """Return the reference. Each part is kept in a file, so that an interrupted run continues with the next part."""
        key, count = self._fingerprint(), self.samples // REFERENCE_PARTS

        def render(number):
            with self._session(_REFERENCE_SEED + number, samples=count) as session:
                session.render_all()
                return luminance(session.read())

        def part(number):
            path = self.folder / "references" / f"{self.name}-{key}-{count}-{number}.npy"
            return kept_picture(path, lambda _: render(number))

        return Reference(np.stack(self._each(part, range(REFERENCE_PARTS), f"reference of {self.samples} samples")))

    def _even(self, reference):
        """Return error bars and intervals by number of samples, equal in all pixels, and the errors reported at the last."""

        def run(seed):
            results, first = [], 0
            with self._session(seed, samples=self.plan.counts[-1]) as session:
                for count in self.plan.counts:
                    session.render(first, count - first)
                    while not session.wait(1.0).finished:
                        pass
                    first = count
                    results.append((luminance(session.read()), session.read(Pass.ERROR)[..., 0], session.error()))
            return results

        runs = self._each(run, range(self.plan.seeds), "even samples")
        result = {}
        for place, count in enumerate(self.plan.counts):
            result[str(count)] = _compare([run[place] for run in runs], reference)
        return result, [run[-1][2] for run in runs]

    def _denoised(self, reference):
        """Return the figures of denoised pictures by number of samples."""

        def run(seed):
            settings = dataclasses.replace(self.snapshot.settings, threads=1, seed=seed, split_lights=0, split_paths=0)
            settings = view_layer.prepared(dataclasses.replace(settings, samples=self.plan.denoised[-1]))
            results, first = [], 0
            with Session(self.uploaded, self.snapshot.camera, settings) as session:
                for count in self.plan.denoised:
                    session.render(first, count - first)
                    while not session.wait(1.0).finished:
                        pass
                    first = count
                    results.append((denoised.denoised(session), session.error()))
            return results

        runs = self._each(run, range(self.plan.seeds), "denoised")
        return {
            str(count): denoised.compared([run[place] for run in runs], reference)
            for place, count in enumerate(self.plan.denoised)
        }

    def _targets(self, reference, told):
        result = []
        count = self.plan.counts[-1]
        for asked, budget in zip(self.plan.targets, self.plan.budgets, strict=True):
            # The interval narrows with the square root of the samples, the part that cannot be excluded with the samples.
            more = budget / count
            least = max(e.high / math.sqrt(more) + e.cannot_exclude / more for e in told)
            target = max(asked, float(f"{least:.2g}"))

            def run(seed, target=target):
                with self._session(seed, samples=_UNBOUNDED, target_error=target) as session:
                    schedule = Schedule(session)
                    while schedule.start():
                        while not schedule.wait(1.0).finished:
                            pass
                    samples = session.statistics().samples / schedule.pixels
                    return luminance(session.read()), samples, schedule.reason, schedule.error

            runs = self._each(run, range(self.plan.seeds), f"target {target:g}")
            result.append({"asked": asked, "target": target, **self._judge(runs, target, reference)})
        return result

    def _judge(self, runs, target, reference):
        pictures = np.stack([run[0] for run in runs])
        real = [reference.distance(picture) for picture in pictures]
        samples = float(np.mean([run[1] for run in runs]))
        # The error of the same number of samples, spread evenly.
        spent = max(1, round(samples))

        def even(seed):
            with self._session(seed, samples=spent) as session:
                session.render_all()
                return reference.distance(luminance(session.read()))

        evenly = root_mean_square(self._each(even, range(100, 104), "the same samples evenly"))
        own = root_mean_square(real)
        return {
            "met": float(np.mean([error <= target for error in real])),
            "ended_by_target": float(np.mean([run[2] is TARGET for run in runs])),
            "ended_by_samples": float(np.mean([run[2] is SAMPLES for run in runs])),
            "real": real,
            "samples": samples,
            "even_error": evenly,
            # Samples that even sampling needs for the error of these runs, over the samples that they took.
            "even_samples_ratio": (evenly / own) ** 2 if own > 0.0 else 1.0,
            "reference_share": (reference.error / own) ** 2 if own > 0.0 else 0.0,
            "bias": figures.bias(pictures, reference),
        }


def _compare(runs, reference):
    noisy = reference.noisy
    within, within_all, holds, bounded, real = [], [], [], [], []
    for picture, bars, told in runs:
        good = figures.inside(picture, bars, reference)
        within.append(float(good[noisy].mean()) if noisy.any() else None)
        within_all.append(float(good.mean()))
        error = reference.distance(picture)
        real.append(error)
        holds.append(told.low <= error <= told.high)
        bounded.append(told.low <= error <= told.bound)
    pictures = np.stack([run[0] for run in runs])
    own = root_mean_square(real)
    return {
        "inside": within,
        "inside_all": within_all,
        "holds": holds,
        "holds_with_unmet": bounded,
        "real": real,
        "told": [run[2].error for run in runs],
        "low": [run[2].low for run in runs],
        "high": [run[2].high for run in runs],
        "cannot_exclude": [run[2].cannot_exclude for run in runs],
        "reference_share": (reference.error / own) ** 2 if own > 0.0 else 0.0,
        "bias": figures.bias(pictures, reference),
    }
