"""Spherical stereo: where the rays of an eye begin, and where they go."""

import numpy as np
import pytest
import tiny_scenes

from addon.bindings.enums import CameraKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Material

EYE, MEETING = 0.1, 2.0
RADIUS = 10.0
GLOW = Material("glow", lobes=(), emission=(1.0, 1.0, 1.0))


def places(kind, window, panorama=(0.0,) * 8, **stereo):
    """Return where the rays of a picture of 9 x 5 pixels hit a ball around the camera, and the directions without stereo."""
    looking = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0]], float)  # along y, z up
    ball = tiny_scenes.sphere(0, tiny_scenes.scale(RADIUS))

    def hits(**fields):
        camera = Camera(looking, kind=kind, width=9, height=5, window=window, panorama=panorama, **fields)
        snapshot = tiny_scenes.scene([ball], [GLOW], camera=camera, passes=(Pass.COMBINED, Pass.POSITION), integrator=2)
        with Session.upload(snapshot) as session:
            assert session.render_all()
            return session.read(Pass.POSITION)[..., :3].astype(float)

    directions = hits()
    return hits(**stereo), directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def expected(directions, offset, convergence):
    """Return where the ball is hit: the eye beside the direction, about z; the ray meets the middle's at the convergence."""
    side = np.cross(directions, (0.0, 0.0, 1.0))
    eyes = offset[..., None] * side / np.linalg.norm(side, axis=-1, keepdims=True)
    d = convergence * directions - eyes if convergence else directions
    d = d / np.linalg.norm(d, axis=-1, keepdims=True)
    along = (eyes * d).sum(-1)
    t = -along + np.sqrt(along**2 + RADIUS**2 - (eyes**2).sum(-1))
    return eyes + t[..., None] * d


PANORAMA = (CameraKind.EQUIRECTANGULAR, (0.0, 1.0, 0.0, 1.0), (-1.4, 1.4, -3.0, 3.0, 0, 0, 0, 0))
PERSPECTIVE = (CameraKind.PERSPECTIVE, (-0.9, 0.9, -0.5, 0.5))


@pytest.mark.parametrize("camera", [PANORAMA, PERSPECTIVE])
@pytest.mark.parametrize("eye", [-EYE, EYE])
@pytest.mark.parametrize("convergence", [0.0, MEETING])
def test_eyes(camera, eye, convergence):
    found, directions = places(*camera, eye_offset=eye, convergence_distance=convergence)
    # The pass is in single precision.
    assert found == pytest.approx(expected(directions, np.full((5, 9), eye), convergence), abs=1e-5)


def test_poles():
    low, high = 0.3, 0.9
    found, directions = places(*PANORAMA, eye_offset=EYE, pole_merge_from=low, pole_merge_to=high)
    altitude = np.abs(np.arcsin(directions[..., 2]))
    fade = np.cos(0.5 * np.pi * np.clip((altitude - low) / (high - low), 0.0, 1.0))
    assert found == pytest.approx(expected(directions, EYE * fade, 0.0), abs=1e-5)
    assert fade.min() < 1e-6 and fade.max() == 1.0


def test_without_an_offset_the_picture_keeps_its_bits():
    plain = tiny_scenes.showroom(16)
    other = plain.replaced(camera=plain.camera.replaced(convergence_distance=3.0, pole_merge_to=1.0))
    assert np.array_equal(tiny_scenes.render(plain), tiny_scenes.render(other))
