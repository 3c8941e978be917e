"""What each feature of a scene costs, measured: the scene and the scene without it take turns in short runs, small pictures.

Time is that of the processor, so that what else the machine does counts little. A figure comes with its uncertainty, and a hint
is given only where the saving is beyond both that and 3 %.
"""

from __future__ import annotations

import dataclasses
import math
import time
from dataclasses import dataclass

from ..bindings.enums import Integrator
from ..bindings.session import Cancelled, Scene, Session
from .scene_features import used_features, without

LEAST_SAVING = 0.03
_PIXELS = 16384
_RUN_SECONDS = 0.03  # of the processor, for each run
# Fewer than six say nothing about their median at 95 %.
_LEAST_ROUNDS, _MOST_ROUNDS = 6, 40
_ENOUGH = 0.005  # an uncertainty below which nothing more is asked


@dataclass(frozen=True)
class Cost:
    """Of one feature: share of the time for the same samples that would be saved without it, negative where it saves time."""

    name: str
    count: int
    share: float
    uncertainty: float  # half of the 95 % interval
    seconds: float  # of the whole frame's sampling
    text: str
    without: str

    @property
    def is_hint(self):
        return self.share > max(self.uncertainty, LEAST_SAVING)


@dataclass(frozen=True)
class Costs:
    measured: tuple = ()  # of Cost, the dearest first
    skipped: tuple = ()  # names of features for which there was no time
    frame_seconds: float = 0.0  # of sampling, by the runs that were timed

    @property
    def hints(self):
        return tuple(cost for cost in self.measured if cost.is_hint)


def median(values):
    ordered = sorted(values)
    half = len(ordered) // 2
    return ordered[half] if len(ordered) % 2 else (ordered[half - 1] + ordered[half]) / 2.0


def median_with_uncertainty(values):
    """The median, and the farther end of its 95 % interval: between two of the values, however they are distributed."""
    ordered, n = sorted(values), len(values)
    middle = median(values)
    # The median lies below the value number k (from 0) with the chance that at most k of n coins show heads.
    chance, outside = 0.0, -1
    for k in range(n // 2):
        chance += math.comb(n, k) / 2.0**n
        if 2.0 * chance > 0.05:
            break
        outside = k
    if outside < 0:
        return middle, math.inf
    return middle, max(middle - ordered[outside], ordered[n - 1 - outside] - middle)


def small_picture(camera, pixels=_PIXELS):
    """The camera with a picture of about so many pixels, of the same view."""
    factor = math.sqrt(pixels / (camera.region_width * camera.region_height))
    if factor >= 1.0:
        return camera
    size = {name: max(1, round(getattr(camera, name) * factor)) for name in ("width", "height")}
    x, y = (min(int(getattr(camera, name) * factor), size[of] - 1) for name, of in (("x", "width"), ("y", "height")))
    width = min(max(1, round(camera.region_width * factor)), size["width"] - x)
    height = min(max(1, round(camera.region_height * factor)), size["height"] - y)
    return dataclasses.replace(camera, **size, x=x, y=y, region_width=width, region_height=height)


def with_splits(scene, snapshot, poll=None):
    """The snapshot, its samples split as those of the whole picture are: a small one might find another way."""
    settings = snapshot.settings
    if settings.integrator != Integrator.PATH or settings.split_lights or settings.split_paths:
        return snapshot
    with Session(scene, dataclasses.replace(snapshot.camera, region_width=1, region_height=1), settings) as session:
        if not session.render_all(1, poll):
            raise Cancelled
        found = session.statistics()
    splits = {"split_lights": found.split_lights, "split_paths": found.split_paths}
    return dataclasses.replace(snapshot, settings=dataclasses.replace(settings, **splits))


class _Runs:
    """A session that renders the same number of samples again and again, timed."""

    def __init__(self, scene, camera, settings, poll):
        self.session = Session(scene, camera, settings)
        self.poll = poll
        self.first = 0

    def __call__(self, samples):
        """Seconds of the processor."""
        # A short run ends before it is watched once.
        if self.poll is not None and self.poll():
            raise Cancelled
        start = time.process_time()
        self.session.render(self.first, samples)
        while True:
            progress = self.session.wait(0.05)
            if progress.finished:
                break
            if self.poll is not None and self.poll():
                self.session.cancel()
        if progress.cancelled:
            raise Cancelled
        self.first += samples
        return time.process_time() - start


def measure_costs(snapshot, seconds=10.0, poll=None, tell=None, library=None):
    """Costs of what snapshot uses, in about so many seconds. Raises Cancelled where poll asks for it.

    tell(fraction, text) is called before each feature.
    """
    start = time.monotonic()
    features = [feature for feature in used_features(snapshot) if feature.without]
    with Scene.upload(snapshot, library, poll) as scene:
        snapshot = with_splits(scene, snapshot, poll)
        camera, base, samples, per_sample = _calibrated(scene, snapshot, poll)
        measured, skipped = [], []
        with base.session:
            for number, feature in enumerate(features):
                left = start + seconds - time.monotonic()
                if left <= 0.0:
                    skipped.append(feature.name)
                    continue
                if tell is not None:
                    tell(number / len(features), feature.text)
                until = time.monotonic() + left / (len(features) - number)
                ratios = _ratios(scene, snapshot, feature, camera, base, samples, until, poll, library)
                measured.append((feature, *median_with_uncertainty(ratios)))
    pixels = snapshot.camera.region_width * snapshot.camera.region_height
    frame = per_sample * pixels * snapshot.settings.samples
    costs = [_cost(feature, 1.0 - ratio, uncertainty, frame) for feature, ratio, uncertainty in measured]
    return Costs(tuple(sorted(costs, key=lambda cost: -cost.share)), tuple(skipped), frame)


def _calibrated(scene, snapshot, poll):
    """(camera, runs, samples a run, wall seconds of a pixel's sample) for runs that are long enough to be timed, no longer."""
    camera = small_picture(snapshot.camera)
    while True:
        runs = _Runs(scene, camera, snapshot.settings, poll)
        once = min(runs(1) for _ in range(2))
        pixels = camera.region_width * camera.region_height
        if once <= 4.0 * _RUN_SECONDS or pixels <= 64:
            break
        # A sample of so large a picture takes too long here.
        runs.session.close()
        camera = small_picture(camera, pixels * _RUN_SECONDS / once)
    samples = min(4096, max(1, round(_RUN_SECONDS / max(once, 1e-6))))
    before = runs.session.statistics()
    runs(samples)
    after = runs.session.statistics()
    taken, drawn = after.render_seconds - before.render_seconds, after.samples - before.samples
    return camera, runs, samples, taken / max(drawn, 1)


def _ratios(scene, snapshot, feature, camera, base, samples, until, poll, library):
    """Time without the feature over the time with it, in turns: with, without, without, with."""
    plain = without(snapshot, feature.name, library)
    same = all(
        getattr(plain, name) is getattr(snapshot, name) for name in ("meshes", "instances", "materials", "lights", "world")
    )
    other = scene if same else Scene.upload(plain, library, poll)
    try:
        lens = dataclasses.replace(camera, lens_radius=plain.camera.lens_radius)
        runs = _Runs(other, lens, plain.settings, poll)
        with runs.session:
            # The first look at a scene brings it into the caches.
            runs(samples)
            ratios = []
            while len(ratios) < _MOST_ROUNDS:
                times = [base(samples), runs(samples), runs(samples), base(samples)]
                ratios.append((times[1] + times[2]) / (times[0] + times[3]))
                enough = median_with_uncertainty(ratios)[1] < _ENOUGH or time.monotonic() > until
                if len(ratios) >= _LEAST_ROUNDS and enough:
                    break
    finally:
        if not same:
            other.close()
    return ratios


def _cost(feature, share, uncertainty, frame_seconds):
    less = f"{abs(share) * 100:.0f} % {'less' if share > 0.0 else 'more'}"
    text = f"{feature.text}; without {feature.pronoun} this frame would take {less} time for the same samples"
    return Cost(feature.name, feature.count, share, uncertainty, share * frame_seconds, text, feature.without)
