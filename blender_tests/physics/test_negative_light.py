"""Lights that take light away: a scene whose emission is negated has the negated picture, sample by sample."""

import dataclasses

import numpy as np
import pytest
import tiny_scenes
from tiny_scenes import move, rotate_x, scale

from addon.bindings.abi import Integrator, LightKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Instance, Light, Material

SOURCES = ("point", "spot", "sun", "area", "ball", "many", "mesh", "sphere", "sky")


def snapshot(source, sign, **settings):
    """A lambertian floor with a block, lit by one source whose emission has that sign."""

    def lamp(kind, z=2.0, **fields):
        strength = 2.0 if kind == LightKind.SUN else 20.0
        return Light("lamp", move(0.4, 0.3, z), kind, emission=tuple(sign * strength * c for c in (1.0, 0.8, 0.5)), **fields)

    lights = {
        "point": [lamp(LightKind.POINT)],
        "spot": [lamp(LightKind.SPOT, radius=0.1, spot_angle=1.5, spot_blend=0.5)],
        "sun": [lamp(LightKind.SUN, sun_angle=0.2)],
        "area": [lamp(LightKind.AREA, size=(0.6, 0.4))],
        "ball": [lamp(LightKind.POINT, radius=0.3, soft_falloff=False)],
        "many": [lamp(LightKind.POINT, z=1.5 + 0.1 * i, radius=0.05) for i in range(9)],
    }
    glow = Material("glow", lobes=(), emission=tuple(sign * c for c in (6.0, 4.0, 3.0)))
    sources = {
        "mesh": [Instance(mesh=0, materials=(1,), matrix=move(0.4, 0.3, 2.0) @ rotate_x(np.pi) @ scale(0.4))],
        "sphere": [tiny_scenes.sphere(1, move(0.4, 0.3, 2.0) @ scale(0.3))],
    }
    return tiny_scenes.scene(
        [
            tiny_scenes.plane(),
            Instance(mesh=0, materials=(0,), matrix=move(-0.6, 0.2, 0.5) @ rotate_x(0.5)),
            *sources.get(source, ()),
        ],
        [tiny_scenes.lambert((0.8, 0.6, 0.4)), glow],
        lights.get(source, ()),
        [tiny_scenes.quad()],
        world=tuple(sign * c for c in (0.3, 0.4, 0.6)) if source == "sky" else 0.0,
        camera=Camera(matrix=tiny_scenes.look_at((3, -4, 3), (0, 0, 0.3)), width=24, height=16),
        **settings,
    )


def measure(record):
    with Session.upload(record) as session:
        session.render_all()
        return session.read(Pass.COMBINED), session.error()


def negated(light, dark):
    return np.array_equal(dark[..., :3], -light[..., :3]) and np.array_equal(dark[..., 3], light[..., 3])


@pytest.mark.parametrize("source", SOURCES)
def test_negated_picture(source):
    """Choices depend on the size of emissions alone, so that every sample is negated, and errors stay what they are."""
    settings = dict(samples=16, max_bounces=3)
    (light, error), (dark, dark_error) = (measure(snapshot(source, sign, **settings)) for sign in (1.0, -1.0))
    assert light[..., :3].mean() > 0.01 and negated(light, dark)
    assert error.error > 0.0 and dataclasses.asdict(error) == dataclasses.asdict(dark_error)


@pytest.mark.parametrize("settings", [dict(clamp_indirect=0.05, max_bounces=3), dict(integrator=Integrator.CLASSIC)], ids=str)
def test_negated_picture_under_settings(settings):
    (light, error), (dark, dark_error) = (measure(snapshot("area", sign, samples=16, **settings)) for sign in (1.0, -1.0))
    assert light[..., :3].mean() > 0.01 and negated(light, dark)
    assert error.clipped == dark_error.clipped and (error.clipped > 0.0) == ("clamp_indirect" in settings)


def test_error_of_light_that_is_partly_taken_away():
    """The reported interval contains the true error, with pixels of both signs."""
    record = snapshot("area", -1.0, samples=16)
    record = dataclasses.replace(record, world=(0.35, 0.35, 0.35))
    pictures, errors = [], []
    for seed in range(24):
        picture, error = measure(tiny_scenes.with_settings(record, seed=seed))
        pictures.append(picture[..., :3].astype(float) @ (0.2126, 0.7152, 0.0722))
        errors.append(error)
    level = np.abs(np.mean(pictures, axis=0))
    assert np.min(np.mean(pictures, axis=0)) < -0.05 and np.max(np.mean(pictures, axis=0)) > 0.05
    true = np.sqrt(np.mean(np.var(pictures, axis=0, ddof=1) / (level + 0.01 * level.mean()) ** 2))
    # 24 pictures of 384 pixels know the true error to 1 %, which the interval of one picture is far wider than.
    assert np.mean([error.low for error in errors]) < true < np.mean([error.high for error in errors])
