"""Limits of light: bounces by kind and of lamps, clamped direct light, caustics, exposure, and the bias that each reports."""

import dataclasses

import numpy as np
import pytest
import tiny_scenes
from tiny_scenes import lambert, move, rgb, rotate_x, scale

from addon.bindings.enums import LightKind, LobeKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, Light, Lobe, Material

ALBEDO = 0.7
GLOSSY = Material("glossy", lobes=(Lobe(LobeKind.GLOSSY, color=rgb(ALBEDO), roughness=0.5),))


def told(snapshot):
    """Return the picture's mean and the error's report."""
    with Session.upload(snapshot) as session:
        assert session.render_all()
        return session.read(Pass.COMBINED)[..., :3].mean(), session.error()


@pytest.mark.parametrize("limit", range(5))
def test_diffuse_bounces_in_a_furnace(limit):
    """In a closed ball of albedo a that emits 1, n bounces after the camera's give 1 + a + ... + a^(n + 1).

    A path has one value but for roulette; 4096 samples of it have a standard error below 1 %.
    """
    snapshot = tiny_scenes.furnace(ALBEDO, 1.0, samples=1 << 12, max_bounces=8, diffuse_bounces=limit)
    picture, error = told(snapshot)
    expected = sum(ALBEDO**n for n in range(limit + 2))
    assert picture == pytest.approx(expected, rel=0.03)
    # The ghosts find what the other bounces would have added: a sixteenth of the paths, a standard error of 4 %.
    removed = sum(ALBEDO**n for n in range(limit + 2, 10))
    assert error.cut == pytest.approx(removed / (expected + removed), rel=0.15)


def test_limits_of_other_kinds_change_no_bit():
    plain = tiny_scenes.furnace(ALBEDO, 1.0, samples=64, max_bounces=4)
    limited = tiny_scenes.with_settings(plain, glossy_bounces=0, transmission_bounces=0)
    beyond = tiny_scenes.with_settings(plain, diffuse_bounces=4)
    for other in (limited, beyond):
        assert np.array_equal(tiny_scenes.render(plain), tiny_scenes.render(other))
        assert told(other)[1].cut == 0.0


def lit_floor(material=None, lights=(), **settings):
    material = material or lambert(ALBEDO)
    instances = [Instance(mesh=0, matrix=scale(10.0), materials=(0,), name="floor")]
    camera = tiny_scenes.pencil((0.0, 0.0, 0.4), (0.0, 0.0, 0.0), 1e-3, 2)
    return tiny_scenes.scene(instances, [material], lights, [tiny_scenes.quad(1.0)], camera=camera, **settings)


def point(intensity, **fields):
    return Light("lamp", move(z=1.0), LightKind.POINT, emission=(intensity,) * 3, **fields)


def test_direct_light_is_clamped():
    """A point above a matt floor has the same light in every sample: a / pi I, or the limit."""
    lights = [point(9.0)]
    whole = ALBEDO / np.pi * 9.0
    picture, error = told(lit_floor(lights=lights, samples=16, clamp_direct=10.0))
    assert picture == pytest.approx(whole, rel=1e-4) and error.clipped_direct == 0.0
    picture, error = told(lit_floor(lights=lights, samples=16, clamp_direct=0.5))
    # Single precision.
    assert picture == pytest.approx(0.5, rel=1e-4)
    assert error.clipped_direct == pytest.approx(1.0 - 0.5 / whole, rel=1e-4) and error.clipped == 0.0


def test_clamped_direct_light_does_not_depend_on_splits():
    lights = [point(9.0)]
    for lights_each, paths in ((4, 1), (2, 3)):
        snapshot = lit_floor(lights=lights, samples=16, clamp_direct=0.5, split_lights=lights_each, split_paths=paths)
        assert told(snapshot)[0] == pytest.approx(0.5, rel=1e-4)


def test_a_lamp_lights_so_many_surfaces():
    """Two matt planes face each other under a point: with one lit surface, the floor gets none of the light of the ceiling."""

    def picture(surfaces):
        ceiling = move(z=2.0) @ rotate_x(np.pi)
        instances = [tiny_scenes.plane(0), tiny_scenes.plane(0, ceiling)]
        camera = tiny_scenes.pencil((0, 0, 0.5), (0, 0, 0), 1e-6)
        snapshot = tiny_scenes.scene(
            instances, [lambert(ALBEDO)], [point(1.0, lit_surfaces=surfaces)], camera=camera, samples=1 << 12, max_bounces=4
        )
        return told(snapshot)

    direct = ALBEDO / np.pi
    (first, error), (second, _), (every, none) = picture(1), picture(2), picture(0)
    # Single precision; the bounces' noise is below 2 %.
    assert first == pytest.approx(direct, rel=1e-4) and direct < second < every
    assert error.cut == pytest.approx(1.0 - direct / every, rel=0.15) and none.cut == 0.0


def box(material, **settings):
    """A matt floor in a white sky beside a mirror, whose light on the floor is a caustic."""
    mirror = Instance(mesh=0, matrix=move(y=0.5, z=0.5) @ rotate_x(np.pi / 2) @ scale(4.0), materials=(1,), name="wall")
    floor = Instance(mesh=0, matrix=scale(10.0), materials=(0,), name="floor")
    camera = tiny_scenes.pencil((0.0, 0.0, 0.4), (0.0, 0.0, 0.0), 1e-3, 2)
    return tiny_scenes.scene([floor, mirror], [lambert(ALBEDO), material], (), [tiny_scenes.quad(1.0)], 1.0, camera, **settings)


def test_caustics_are_left_out():
    """Half of the floor's sky is behind a mirror that reflects the other half: without caustics the mirror is black.

    16384 samples within a factor of two: a standard error below 1 %.
    """
    samples = {"samples": 1 << 12, "max_bounces": 3}
    black = Material("black", lobes=())
    whole, without = told(box(GLOSSY, **samples)), told(box(black, **samples))
    picture, error = told(box(GLOSSY, no_reflections=1, **samples))
    assert picture == pytest.approx(without[0], rel=0.03) and picture < 0.9 * whole[0]
    assert error.no_caustics == pytest.approx(1.0 - without[0] / whole[0], rel=0.15)
    assert told(box(GLOSSY, no_refractions=1, **samples))[0] == pytest.approx(whole[0], rel=0.03)
    assert whole[1].no_caustics == 0.0


def test_the_camera_sees_a_mirror_without_caustics():
    """The camera's ray leaves no diffuse lobe: the mirror shows the sky."""
    snapshot = lit_floor(GLOSSY, samples=1 << 10, no_reflections=1, no_refractions=1)
    snapshot = dataclasses.replace(snapshot, world=dataclasses.replace(snapshot.world, radiance=(1.0,) * 3))
    # The directions below the horizon are lost.
    assert 0.8 * ALBEDO < told(snapshot)[0] <= ALBEDO * 1.01


def test_exposure_scales_all_light():
    lights = [point(2.0, radius=0.1)]
    passes = (Pass.COMBINED, Pass.DIFFUSE_DIRECT, Pass.DIFFUSE_COLOR, Pass.ERROR)
    plain = lit_floor(lights=lights, samples=64, passes=passes)
    exposed = tiny_scenes.with_settings(plain, exposure=4.0)
    for which, factor in zip(passes, (4.0, 4.0, 1.0, 4.0), strict=True):
        before, after = (tiny_scenes.render(snapshot, which) for snapshot in (plain, exposed))
        # Powers of two change no digit.
        assert np.array_equal(after[..., :3], factor * before[..., :3]), which
    assert told(exposed)[1].error == pytest.approx(told(plain)[1].error, rel=1e-6)


def test_filter_glossy_blurs_behind_blurred_reflections_alone():
    """The camera sees a glossy floor as sharp as before; behind a matt one it changes the light of a mirror's wall."""
    mirror = Material("mirror", lobes=(Lobe(LobeKind.GLOSSY, color=rgb(0.9), roughness=0.05),))
    plain = lit_floor(mirror, [point(3.0, radius=0.3)], samples=64)
    assert np.array_equal(tiny_scenes.render(plain), tiny_scenes.render(tiny_scenes.with_settings(plain, filter_glossy=1.0)))
    behind = box(mirror, samples=64, max_bounces=3)
    blurred = tiny_scenes.with_settings(behind, filter_glossy=10.0)
    assert not np.array_equal(tiny_scenes.render(behind), tiny_scenes.render(blurred))


def test_limits_that_are_off_change_no_bit():
    """Defaults and limits that nothing reaches give the picture without them."""
    plain = tiny_scenes.showroom(16)
    for unused in ({"diffuse_bounces": 6}, {"clamp_direct": 1e9}, {"exposure": 1.0}):
        limited = tiny_scenes.with_settings(plain, **unused)
        assert np.array_equal(tiny_scenes.render(plain), tiny_scenes.render(limited)), unused
