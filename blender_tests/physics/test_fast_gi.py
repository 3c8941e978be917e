"""Fast GI: near surfaces end paths and the environment beyond is changed, or ambient light is added."""

import numpy as np
import pytest
import tiny_scenes
from tiny_scenes import lambert, move, rotate_x, scale

from addon.bindings.snapshot import Instance

ALBEDO = 0.6


def open_floor(**settings):
    return tiny_scenes.scene(
        [tiny_scenes.plane(0)], [lambert(ALBEDO)], world=1.0, camera=tiny_scenes.pencil(), **{"samples": 256, **settings}
    )


def roofed(height, **settings):
    """A floor under a wide roof, both matt: no sky reaches the floor."""
    roof = Instance(mesh=0, matrix=move(z=height) @ rotate_x(np.pi) @ scale(1e4), materials=(0,), name="roof")
    floor = Instance(mesh=0, matrix=scale(1e4), materials=(0,), name="floor")
    return tiny_scenes.scene(
        [floor, roof], [lambert(ALBEDO)], (), [tiny_scenes.quad(1.0)], 1.0,
        tiny_scenes.pencil((0, 0, 0.5), (0, 0, 0), 1e-6), **{"samples": 1 << 12, **settings},
    )  # fmt: skip


def level(snapshot):
    return tiny_scenes.radiance(snapshot).mean()


def test_the_sky_is_changed_beyond_the_distance():
    """An open floor reflects the factor's share of a white sky; a limit of two bounces leaves it as it is."""
    fast = {"max_bounces": 4, "fast_factor": 0.25, "fast_distance": 3.0}
    # A sky of one radiance has one value in every sample but for the loss below the horizon of rounding.
    assert level(open_floor(fast_bounces=1, **fast)) == pytest.approx(0.25 * ALBEDO, rel=1e-3)
    assert level(open_floor(fast_bounces=2, **fast)) == pytest.approx(ALBEDO, rel=1e-3)


def test_surfaces_beyond_the_distance_are_not_there():
    """The roof at height h hides the sky within a cone: rays longer than r see the sky, at cosines below h / r.

    The share of a cosine-weighted hemisphere below that is (h / r)^2; 4096 samples have a standard error below 0.01.
    """
    height, reach = 1.0, 2.0
    fast = {"max_bounces": 4, "fast_bounces": 1, "fast_factor": 1.0, "fast_distance": reach}
    assert level(roofed(height, **fast)) == pytest.approx(ALBEDO * (height / reach) ** 2, abs=0.03)
    assert level(roofed(height, max_bounces=0)) < 1e-2


def test_an_object_has_a_distance_of_its_own():
    snapshot = roofed(1.0, max_bounces=4, fast_bounces=1, fast_factor=1.0, fast_distance=2.0)
    own = snapshot.instances.replaced(fast_distances=np.array([0.5, 0.0], np.float32))
    assert level(snapshot.replaced(instances=own)) == pytest.approx(ALBEDO, rel=0.01)


def test_ambient_light_is_added():
    """An open floor reflects a and the sky; under a roof, the open share (h / r)^2 alone, at each bounce."""
    assert level(open_floor(ambient=0.5, max_bounces=0)) == pytest.approx(ALBEDO * 1.5, rel=1e-3)
    reach = 2.0
    added = 0.5 * ALBEDO / reach**2
    expected = sum(added * ALBEDO**n for n in range(4))
    # The standard error is below 0.01; the far sky of grazing rays adds less.
    assert level(roofed(1.0, ambient=0.5, fast_distance=reach, max_bounces=2)) == pytest.approx(expected, abs=0.03)


def test_off_it_changes_no_bit():
    plain = tiny_scenes.showroom(16)
    other = tiny_scenes.with_settings(plain, fast_factor=0.3, fast_distance=2.0)
    assert np.array_equal(tiny_scenes.render(plain), tiny_scenes.render(other))
