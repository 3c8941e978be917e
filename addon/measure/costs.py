"""Measured cost of each feature: short renders of small pictures alternate between the scene and the scene without it.

Times are processor times, so that other work on the machine has little influence. Each figure has an uncertainty; a feature is
a hint only if its saving exceeds both the uncertainty and 3 %.
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
_RUN_SECONDS = 0.03  # processor time of a run
# The 95 % interval of a median needs at least six values.
_LEAST_ROUNDS, _MOST_ROUNDS = 6, 40
_ENOUGH = 0.005  # an uncertainty below which a measurement ends


@dataclass(frozen=True)
class Cost:
    """Cost of one feature. share: the share of time saved without it at equal samples; negative if the feature saves time."""

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
    measured: tuple = ()  # of Cost, the highest first
    skipped: tuple = ()  # names of features for which time did not suffice
    frame_seconds: float = 0.0  # sampling time of the frame, extrapolated from the timed runs

    @property
    def hints(self):
        return tuple(cost for cost in self.measured if cost.is_hint)


def median(values):
    ordered = sorted(values)
    half = len(ordered) // 2
    return ordered[half] if len(ordered) % 2 else (ordered[half - 1] + ordered[half]) / 2.0


def median_with_uncertainty(values):
    """Return the median and the distance to the farther end of its 95 % interval, for any distribution of the values."""
    ordered, n = sorted(values), len(values)
    middle = median(values)
    # The true median is below value k (from 0) with the probability that at most k of n fair coins show heads.
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
    """Return the camera with the same view and at most about pixels pixels."""
    factor = math.sqrt(pixels / (camera.region_width * camera.region_height))
    if factor >= 1.0:
        return camera
    size = {name: max(1, round(getattr(camera, name) * factor)) for name in ("width", "height")}
    x, y = (min(int(getattr(camera, name) * factor), size[of] - 1) for name, of in (("x", "width"), ("y", "height")))
    width = min(max(1, round(camera.region_width * factor)), size["width"] - x)
    height = min(max(1, round(camera.region_height * factor)), size["height"] - y)
    return dataclasses.replace(camera, **size, x=x, y=y, region_width=width, region_height=height)


def with_splits(scene, snapshot, poll=None):
    """Return the snapshot with the split of samples that the pilot chooses for the whole picture; raise Cancelled by poll.

    For a small picture the pilot might choose another split.
    """
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
    """A session for timed runs, each of which continues with the next samples."""

    def __init__(self, scene, camera, settings, poll):
        self.session = Session(scene, camera, settings)
        self.poll = poll
        self.first = 0

    def __call__(self, samples):
        """Render samples per pixel and return the processor time in seconds; raise Cancelled by poll."""
        # A short run ends before the loop below polls.
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
    """Measure the Costs of the features of a snapshot in about that many seconds; raise Cancelled if poll returns True.

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
    """Return (camera, runs, samples per run, wall seconds of a pixel's sample) for runs of about _RUN_SECONDS."""
    camera = small_picture(snapshot.camera)
    while True:
        runs = _Runs(scene, camera, snapshot.settings, poll)
        once = min(runs(1) for _ in range(2))
        pixels = camera.region_width * camera.region_height
        if once <= 4.0 * _RUN_SECONDS or pixels <= 64:
            break
        # One sample per pixel takes too long: reduce the picture.
        runs.session.close()
        camera = small_picture(camera, pixels * _RUN_SECONDS / once)
    samples = min(4096, max(1, round(_RUN_SECONDS / max(once, 1e-6))))
    before = runs.session.statistics()
    runs(samples)
    after = runs.session.statistics()
    taken, drawn = after.render_seconds - before.render_seconds, after.samples - before.samples
    return camera, runs, samples, taken / max(drawn, 1)


def _ratios(scene, snapshot, feature, camera, base, samples, until, poll, library):
    """Return ratios of the time without the feature to the time with it, each from runs with, without, without, with."""
    plain = without(snapshot, feature.name, library)
    same = all(
        getattr(plain, name) is getattr(snapshot, name) for name in ("meshes", "instances", "materials", "lights", "world")
    )
    other = scene if same else Scene.upload(plain, library, poll)
    try:
        lens = dataclasses.replace(camera, lens_radius=plain.camera.lens_radius)
        runs = _Runs(other, lens, plain.settings, poll)
        with runs.session:
            # The first run warms the caches.
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
