"""Forecasts of time and error, from curves with known results and from renders of a small scene."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes as tiny

from addon.bindings.session import Cancelled, Session
from addon.bindings.snapshot import Camera, Light, Material
from addon.measure.forecast import Range, classic_seconds, forecast, slope
from addon.measure.schedule import SAMPLES, TARGET, TIME, Schedule
from addon.measure.trial_renders import Measured, Point, measure

RATE = 2e-6  # seconds of a pixel's sample
REACH = 1.96


def curve(factor, power, edges, width, samples, spread=0.0, noise=None):
    """Return points of a picture of that width, with squared error 1 + edges / width times that of an infinite picture."""
    points = []
    for i, count in enumerate(samples):
        error = factor * count**-power * math.sqrt(1.0 + edges / width)
        error *= math.exp(spread * noise[i]) if noise is not None else 1.0
        points.append(Point(count, error, error * math.exp(REACH * spread), 0.1 / count, RATE * width**2 * count))
    return tuple(points)


def synthetic(power, edges=0.0, spread=0.0, generator=None):
    """Return the Measured of two pictures with widths of 128 and 64 pixels."""
    refined, even = [8, 16, 32, 64, 120, 230, 450], [8, 16, 32, 64, 128, 256]
    noise = [None, None] if generator is None else [generator.normal(size=len(s)) for s in (refined, even)]
    return Measured(
        curve(2.0, power, edges, 128, refined, spread, noise[0]),
        curve(2.0, power, edges, 64, even, spread, noise[1]),
        128**2,
        64**2,
        before=0.5,
        classic_seconds=RATE / 4,
    )


def truth(power, target, edges=0.0, spread=0.0, width=512):
    """Return the samples at which the error's bound reaches the target, by bisection."""
    narrowed = math.exp(REACH * spread * 128 / width)

    def bound(samples):
        return 2.0 * samples**-power * math.sqrt(1.0 + edges / width) * narrowed + 0.1 / samples

    low, high = 1.0, 1e12
    while high / low > 1.0 + 1e-12:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if bound(middle) > target else (low, middle)
    return low


@pytest.mark.parametrize("power", [0.4, 0.5, 0.7])
@pytest.mark.parametrize("target", [0.1, 0.03, 0.01])
def test_a_power_law_goes_on(power, target):
    told = forecast(synthetic(power, edges=100.0), 512**2, target, 1 << 40)
    want = truth(power, target, edges=100.0)
    assert told.ended_by == TARGET and told.samples.low <= want <= told.samples.high
    # Between points of a power law linear interpolation of logarithms is exact. Beyond them the prior slope has a small weight:
    # its deviation is 0.12, that of the fit of four points with deviation 0.01 is 0.006, so that the slope's error is at most
    # 0.25 % of 0.15. And the share of undiscovered light falls faster than the error.
    assert told.samples.value == pytest.approx(want, rel=0.05)
    assert told.seconds.value == pytest.approx(0.5 + RATE * 512**2 * told.samples.value, rel=1e-9)
    assert told.error.value == pytest.approx(target, rel=0.05)


@pytest.mark.parametrize("edges", [0.0, 50.0, 300.0])
def test_error_that_edges_bring_falls_with_the_width(edges):
    measured = synthetic(0.5, edges)
    told, nearer = (forecast(measured, width**2, samples=256) for width in (1024, 256))
    # The error is 2 / 16 without edges. The two widths determine both parts of the model exactly.
    want = 0.125 * math.sqrt(1.0 + edges / 1024)
    assert told.error.value == pytest.approx(want, rel=1e-9)
    # The model is approximate: the larger the whole picture, the wider the interval.
    wide, narrow = (math.log(one.error.high / one.error.value) for one in (told, nearer))
    assert wide == 0.0 if edges == 0.0 else wide > 1.1 * narrow > 0.0


@pytest.mark.parametrize("target", [0.2, 0.03])
def test_the_interval_holds_the_truth(target):
    """With errors that are known to 5 %, at least 95 % of intervals contain the true samples, between the points and beyond."""
    generator = np.random.default_rng(4)
    inside = 0
    for _ in range(400):
        told = forecast(synthetic(0.5, 50.0, 0.05, generator), 512**2, target, 1 << 40)
        inside += told.samples.low <= truth(0.5, target, 50.0, 0.05) <= told.samples.high
    # The standard deviation of 400 trials at 95 % is 1.1 %: three deviations.
    assert inside / 400 >= 0.95 - 0.033


def test_what_ends_a_render():
    measured = synthetic(0.5)
    assert forecast(measured, 512**2, 0.01, 1024).ended_by == SAMPLES
    assert forecast(measured, 512**2, 0.01, 1024).samples == Range(1024.0, 1024.0, 1024.0)
    late = forecast(measured, 512**2, 0.01, 1 << 40, time_limit=60.0)
    assert late.ended_by == TIME and late.seconds.value == 60.0
    assert not late.misses(0.01) and not forecast(measured, 512**2, 0.9, 8192).misses(0.9)
    assert forecast(measured, 512**2, 0.01, 1024).misses(0.01) and not forecast(measured, 512**2, 0.0, 1024).misses(0.0)
    # The time limit minus half a second before the first sample.
    assert late.samples.value == pytest.approx(59.5 / (RATE * 512**2), rel=1e-6)
    # A target is not checked before 16 samples.
    assert forecast(measured, 512**2, 0.9, 8192).samples.value == 16.0
    assert classic_seconds(measured, 512**2, 16) == pytest.approx(0.5 + 4 * RATE * 512**2)
    assert classic_seconds(dataclasses.replace(measured, classic_seconds=0.0), 512**2, 16) is None


@pytest.mark.parametrize("power", [0.4, 0.9])
def test_an_uncertain_slope_leans_on_what_is_known_before(power):
    sure, deviation = slope(curve(1.0, power, 0.0, 64, [8, 16, 32, 64], spread=0.01))
    assert sure == pytest.approx(power, abs=0.02) and deviation < 0.02
    unsure, deviation = slope(curve(1.0, power, 0.0, 64, [8, 16, 32, 64], spread=1.0))
    assert abs(unsure - 0.55) < 0.1 * abs(power - 0.55) and 0.1 < deviation <= 0.12


def lamplit(width, **settings):
    """Return a ball on a floor under a wide lamp: soft shadows and edges, no fireflies."""
    lamp = Light("lamp", tiny.move(0, -2, 4) @ tiny.rotate_x(-0.4), tiny.LightKind.AREA, emission=(3, 3, 3), size=(2, 2))
    camera = Camera(
        tiny.look_at((0, -6, 2.5), (0, 0, 0.6)), width=width, height=width * 9 // 16, window=(-0.4, 0.4, -0.225, 0.225)
    )
    instances = [tiny.plane(0), tiny.sphere(1, tiny.move(z=1))]
    materials = [tiny.lambert(0.6), Material("red", lobes=(tiny.Lobe(color=(0.7, 0.1, 0.1)),))]
    return tiny.scene(instances, materials, [lamp], world=0.3, camera=camera, max_bounces=3, threads=2, **settings)


def test_a_render_with_a_target_takes_what_was_told():
    snapshot = lamplit(240, samples=4096)
    # Measure until the error is 1 %, so that the result does not depend on the machine's speed.
    measured = measure(snapshot, 1000.0)
    assert measured.refined[-1].error < 0.01 and measured.before > 0.0 and measured.classic_seconds > 0.0
    for target in (0.03, 0.012):
        told = forecast(measured, 240 * 135, target, 4096)
        with Session.upload(tiny.with_settings(snapshot, target_error=target, seed=7)) as session:
            schedule = Schedule(session)
            while schedule.start():
                while not schedule.wait(0.05).finished:
                    pass
            samples, error = session.statistics().samples / (240 * 135), session.error()
        assert schedule.reason == told.ended_by == TARGET
        # Pixels that need slightly more samples get twice as many.
        assert told.samples.low <= samples <= 2.0 * told.samples.high
        assert told.error.low / 2.0**0.5 <= error.error <= told.error.high


def test_it_can_be_stopped_and_tells_how_far_it_is():
    told = []
    measure(lamplit(32), 0.2, tell=lambda fraction, text: told.append(fraction))
    assert told == sorted(told) and 0.0 <= told[0] and told[-1] <= 1.0 and len(told) >= 2
    with pytest.raises(Cancelled):
        measure(lamplit(32), 1000.0, poll=lambda: True)
    calls = iter(range(100_000))
    with pytest.raises(Cancelled):
        measure(tiny.showroom(256), 1000.0, poll=lambda: next(calls) > 60)


def test_small_pictures():
    """Of one pixel and of four all are measured."""
    measured = measure(tiny.scene([tiny.plane()], [tiny.lambert()], world=1.0), 0.1)
    assert measured.pixels == measured.even_pixels == 1
    # Every sample of an endless white plane is the same.
    assert forecast(measured, 1, samples=64).error.value < 1e-12
    measured = measure(tiny.showroom(2, time_limit=3.0), 0.1)
    assert measured.pixels == measured.even_pixels == 4
    told = forecast(measured, 4, samples=64)
    assert 0.0 < told.error.low <= told.error.value <= told.error.high


def test_a_black_picture_has_no_error():
    black = tiny.scene([tiny.plane()], [tiny.lambert()], camera=tiny.pencil(pixels=32))
    measured = measure(black, 0.1)
    told = forecast(measured, 1024, 0.01, 4096)
    assert told.error.value < 1e-12 and told.samples.value == 16.0 and told.seconds.low <= told.seconds.high
