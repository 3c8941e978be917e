"""Trial renders of small pictures of a scene, from which forecast.py predicts time and error of the whole picture.

One small picture is refined where the error is largest, like a render with a target; the other, with a quarter of its pixels,
gets equal samples everywhere. The two sizes show how the error depends on the size of the picture.
"""

from __future__ import annotations

import dataclasses
import math
import time
from dataclasses import dataclass

from ..bindings.abi import LancerError
from ..bindings.enums import Integrator
from ..bindings.session import Cancelled, Scene, Session
from .costs import small_picture, with_splits
from .schedule import DENOISED_POWER, FIRST_LOOK

# Limits of the pixels of the larger picture, and the smaller picture's fraction and least pixels.
_FEWEST, _MOST = 1024, 36864
_QUARTER, _LEAST_QUARTER = 4, 64
# Share of the time for the equal samples of all pixels, in each picture.
_EVEN_SHARE = 0.2
_FIRST = 8  # samples before which no point is recorded
_NEXT = 0.7  # target of the next round, relative to the last bound
_DEEPEST = 1 << 16  # most samples of a pixel
_ENOUGH = 0.01  # an error below which the measurement ends
_CLASSIC_DEPTH = 16  # the core's limit
# Expected exponents p of error ~ samples^-p. Of a picture: 1/2 for independent samples, up to 3/4 at edges and 1 in smooth
# places for low-discrepancy samples, less if further samples keep finding brighter fireflies. Denoised pictures have less noise
# at few samples, and less to gain.
SLOPE, DENOISED_SLOPE = 0.55, 1.0 / DENOISED_POWER
_REACH = 1.96  # standard deviations of the 95 % interval of a Gaussian


@dataclass(frozen=True)
class Point:
    """samples: the mean over pixels; seconds: since the first sample."""

    samples: float
    error: float
    high: float
    cannot_exclude: float
    seconds: float
    denoised: tuple | None = None  # (error, high) of the denoised picture

    @property
    def spread(self):
        """The standard deviation of the error's logarithm."""
        return math.log(max(self.high / self.error, 1.0)) / _REACH if self.error > 0.0 else 0.0


@dataclass(frozen=True)
class Measured:
    """Points of the two small pictures, in order of samples."""

    refined: tuple  # the larger picture; equal samples for all pixels up to FIRST_LOOK
    even: tuple  # the smaller picture
    pixels: int
    even_pixels: int
    before: float = 0.0  # seconds from F12 to the first sample
    classic_seconds: float = 0.0  # of a pixel's sample in CLASSIC; 0 = not measured
    slope: float = SLOPE  # of the error: samples^-slope, as expected before any measurement

    def of_denoised(self):
        """Return the Measured of the denoised pictures; None if they were not measured."""
        refined, even = (_of_denoised(points) for points in (self.refined, self.even))
        if not (refined and even):
            return None
        return dataclasses.replace(self, refined=refined, even=even, slope=DENOISED_SLOPE)


def _of_denoised(points):
    found = [(point, *point.denoised) for point in points if point.denoised is not None]
    return tuple(dataclasses.replace(point, error=error, high=high) for point, error, high in found)


def measure(snapshot, seconds=10.0, poll=None, tell=None, library=None, denoised=None):
    """Return the Measured of a snapshot after about that many seconds; tell(fraction, text) reports progress.

    denoised: has prepared(settings), for sessions whose pictures are to be denoised, and error_of(session), the (error, high)
    of the denoised picture or None.

    Raise Cancelled if poll returns True, LancerError if the trial renders have no error.
    """
    started = time.monotonic()
    tell = tell or (lambda fraction, text: None)
    with Scene.upload(snapshot, library, poll) as scene:
        begun = time.monotonic()

        def show(text):
            tell(min(1.0, (time.monotonic() - begun) / max(seconds, 1e-9)), text)

        if denoised is not None:
            snapshot = dataclasses.replace(snapshot, settings=denoised.prepared(snapshot.settings))
        error_of = denoised.error_of if denoised is not None else None
        run = _Run(scene, with_splits(scene, snapshot, poll), begun + seconds, poll, show, error_of)
        classic = run.classic() if snapshot.settings.integrator == Integrator.PATH else 0.0
        large, small = run.cameras(seconds)
        even = run.even(small, begun + 2.0 * _EVEN_SHARE * seconds)
        refined = run.refined(large)
    if not (even and refined):
        raise LancerError("the error of the trial renders is unknown, so that nothing follows from them")
    return Measured(tuple(refined), tuple(even), _pixels(large), _pixels(small), begun - started, classic)


class _Run:
    """The renders of one measurement."""

    def __init__(self, scene, snapshot, until, poll, show, denoised):
        self.denoised = denoised
        self.scene, self.camera, self.poll, self.until, self.show = scene, snapshot.camera, poll, until, show
        self.doing = "Preparing the scene"
        # A target makes the film ready for refinement.
        self.refining = dataclasses.replace(snapshot.settings, target_error=1e-6, time_limit=0.0, samples=_DEEPEST)
        self.settings = dataclasses.replace(self.refining, target_error=0.0)

    def cameras(self, seconds):
        """Return the cameras of both pictures, as large as the time allows for FIRST_LOOK samples per pixel."""
        camera = small_picture(self.camera, _FEWEST)
        with Session(self.scene, camera, self.settings) as session:
            once = self._seconds(session, camera)
        wanted = _EVEN_SHARE * seconds / (FIRST_LOOK * max(once, 1e-9))
        large = small_picture(self.camera, min(max(wanted, _FEWEST), _MOST))
        return large, small_picture(large, max(_pixels(large) / _QUARTER, _LEAST_QUARTER))

    def even(self, camera, until):
        """Return the points with equal samples for all pixels: at least FIRST_LOOK, then as long as time allows."""
        points = []
        self.doing = "Equal samples for all pixels"
        with Session(self.scene, camera, self.settings) as session:
            for done in self._doubling(session, camera, points):
                # The next range takes as long as all ranges before it.
                late = time.monotonic() + session.statistics().render_seconds > until
                if done >= FIRST_LOOK and (late or session.error().bound <= _ENOUGH):
                    break
        return points

    def refined(self, camera):
        points = []
        self.doing = "Samples where the error is largest"
        with Session(self.scene, camera, self.refining) as session:
            for done in self._doubling(session, camera, points):
                if done >= FIRST_LOOK:
                    break
            while time.monotonic() < self.until:
                bound = session.error().bound
                if not _ENOUGH < bound < math.inf or not session.refine(_NEXT * bound):
                    break
                self._wait(session, until=self.until)
                self._add(points, session, camera)
        return points

    def _doubling(self, session, camera, points):
        """Render 1, 2, 4 ... samples per pixel; after each range add a point and yield the samples done."""
        done = 0
        while done < _DEEPEST:
            self._render(session, done, max(1, done))
            done += max(1, done)
            self._add(points, session, camera)
            yield done

    def _add(self, points, session, camera):
        error, statistics = session.error(), session.statistics()
        samples = statistics.samples / _pixels(camera)
        if samples < _FIRST or not error.known or points and points[-1].samples >= samples:
            return
        found = (samples, error.error, error.high, error.cannot_exclude, statistics.render_seconds)
        points.append(Point(*found, self.denoised(session) if self.denoised is not None else None))

    def classic(self):
        """Return the seconds of a pixel's sample in CLASSIC."""
        bounces = min(self.settings.max_bounces, _CLASSIC_DEPTH)
        camera = small_picture(self.camera, 4 * _FEWEST)
        settings = dataclasses.replace(self.settings, integrator=Integrator.CLASSIC, max_bounces=bounces)
        with Session(self.scene, camera, settings) as session:
            return self._seconds(session, camera)

    def _seconds(self, session, camera):
        """Return the seconds of a pixel's sample, without the first sample, which warms the caches."""
        self._render(session, 0, 1)
        before = session.statistics().render_seconds
        self._render(session, 1, 3)
        return (session.statistics().render_seconds - before) / (3 * _pixels(camera))

    def _render(self, session, first, count):
        session.render(first, count)
        self._wait(session)

    def _wait(self, session, until=math.inf):
        stopped = False
        while True:
            progress = session.wait(0.05)
            self.show(self.doing)
            if progress.finished:
                break
            if self.poll is not None and self.poll():
                session.cancel()
            elif not stopped and time.monotonic() > until:
                stopped = True
                session.stop()
        if progress.cancelled:
            raise Cancelled


def _pixels(camera):
    return camera.region_width * camera.region_height
