"""Costs of features: the arithmetic against closed forms, and measurements with a large difference."""

import dataclasses

import numpy as np
import pytest
import tiny_scenes as tiny

from addon.bindings.enums import LobeKind
from addon.bindings.session import Cancelled
from addon.bindings.shading import Lobe, Material
from addon.bindings.snapshot import Camera, Light
from addon.measure.costs import Cost, measure_costs, median_with_uncertainty, small_picture


def shells(count=24):
    """Return nested glass spheres: paths pass through all surfaces, while opaque spheres end them at the first."""
    # Glass of index 1.001 refracts and reflects hardly any light.
    glass = Material("glass", lobes=(Lobe(LobeKind.DIELECTRIC, color=(1, 1, 1), ior=1.001),))
    onion = [tiny.sphere(0, tiny.scale(1.0 - i / (2 * count)), name=f"shell {i}") for i in range(count)]
    camera = Camera(tiny.look_at((0, -3, 0), (0, 0, 0)), width=64, height=36, window=(-0.2, 0.2, -0.2, 0.2))
    lamp = Light("lamp", tiny.move(2, -3, 4), emission=(10, 10, 10))
    return tiny.scene(onion, [glass], [lamp], camera=camera, max_bounces=3, samples=8)


def test_costly_glass_gives_a_hint():
    told = []
    costs = measure_costs(shells(), 0.5, tell=lambda fraction, text: told.append((fraction, text)))
    hints = {hint.name: hint for hint in costs.hints}
    # Four path segments and their shadow rays, against one and its shadow ray.
    hint = hints["glass"]
    assert hint.share > 0.25 and hint.count == 1 and 0.0 <= hint.uncertainty < hint.share
    assert hint.text.startswith("1 material uses refraction; without it this frame would take ")
    assert hint.text.endswith(" % less time for the same samples") and hint.without
    assert costs.frame_seconds > 0.0 and hint.seconds == pytest.approx(hint.share * costs.frame_seconds, rel=1e-12)
    assert told[0] == (0.0, "1 material uses refraction")


def test_a_scene_with_nothing_to_take_away_gives_none():
    lamp = Light("lamp", tiny.move(2, -3, 4))
    snapshot = tiny.scene([tiny.sphere()], [tiny.lambert()], [lamp], max_bounces=3)
    plain = dataclasses.replace(snapshot, instances=dataclasses.replace(snapshot.instances, kinds=np.uint32([2])))
    costs = measure_costs(plain, 0.5)
    assert (costs.measured, costs.skipped, costs.hints) == ((), (), ())


def test_no_time_is_told():
    costs = measure_costs(shells(), 0.0)
    assert costs.measured == () and "glass" in costs.skipped


def test_the_snapshot_stays_as_it_was():
    snapshot = shells()
    measure_costs(snapshot, 0.0)
    assert snapshot == shells()


def test_it_can_be_stopped():
    with pytest.raises(Cancelled):
        measure_costs(shells(), 10.0, poll=lambda: True)
    calls = iter(range(100_000))
    # After filling and building of the small scene, within a run.
    with pytest.raises(Cancelled):
        measure_costs(shells(), 1000.0, poll=lambda: next(calls) > 30)


@pytest.mark.parametrize(
    "share, uncertainty, expected", [(0.2, 0.1, True), (0.2, 0.3, False), (0.02, 0.001, False), (-0.5, 0.1, False)]
)
def test_only_what_is_beyond_doubt_and_3_percent_is_a_hint(share, uncertainty, expected):
    assert Cost("glass", 1, share, uncertainty, 1.0, "", "").is_hint is expected


@pytest.mark.parametrize("count", [6, 9, 25, 40])
def test_the_interval_holds_the_truth(count):
    """At least 95 % of intervals contain the median of a skewed distribution, like times on a busy machine."""
    generator = np.random.default_rng(1)
    inside = 0
    for _ in range(2000):
        middle, half = median_with_uncertainty(list(generator.lognormal(0.0, 0.3, count) ** 3))
        inside += abs(middle - 1.0) <= half
    # The standard deviation of 2000 trials at 95 % is 0.5 %: four deviations.
    assert inside / 2000 >= 0.95 - 0.02


def test_the_interval_is_as_narrow_as_order_allows():
    """Of nine values the second and the eighth: the median is outside with probability 2 * 10 / 512 = 3.9 %."""
    assert median_with_uncertainty([1, 2, 3, 4, 5, 6, 7, 8, 100]) == (5, 3)
    # The interval is that of the first and the last of eight: the second would leave a probability of 2 * 9 / 256 = 7 %.
    assert median_with_uncertainty([1, 2, 3, 4, 5, 6, 7, 8]) == (4.5, 3.5)
    # The interval is that of the least and the greatest of six, 2 / 64; five would leave 6 %.
    assert median_with_uncertainty([1.0, 2.0, 3.0, 4.0, 5.0, 7.0]) == (3.5, 3.5)
    assert median_with_uncertainty([3.0, 1.0, 2.0]) == (2.0, float("inf"))


@pytest.mark.parametrize("size, region", [((1920, 1080), None), ((4000, 100), (500, 20, 2000, 50)), ((64, 64), None)])
def test_a_small_picture_shows_the_same(size, region):
    width, height = size
    x, y, w, h = region or (0, 0, width, height)
    camera = Camera(width=width, height=height, x=x, y=y, region_width=w, region_height=h)
    small = small_picture(camera, 10_000)
    assert small.region_width * small.region_height <= max(1.1 * 10_000, 1)
    # Rounding to whole pixels moves an edge by at most one of them.
    pixel = 1.0 / min(small.width, small.height)
    for a, b in (("x", "width"), ("y", "height"), ("region_width", "width"), ("region_height", "height")):
        assert getattr(small, a) / getattr(small, b) == pytest.approx(getattr(camera, a) / getattr(camera, b), abs=pixel)
    assert small.x + small.region_width <= small.width and small.y + small.region_height <= small.height
