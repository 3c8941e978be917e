"""Extreme cameras: a finite picture, or an error with a message."""

import dataclasses

import numpy as np
import pytest
from tiny_scenes import scene, showroom, sphere

from addon.bindings.abi import CameraKind, LancerError, Pass
from addon.bindings.session import Session

SHOT = showroom(12, samples=2)
# window: half its width; at 1e-300 all pixels have the same ray, at 1e300 the view has 180 degrees.
LENSES = {
    **{f"window {half:g}": {"window": (-half, half, -half, half)} for half in (1e-300, 1e-30, 1e-6, 1e6, 1e30, 1e300)},
    "lens of next to nothing": {"lens_radius": 1e-300, "focal_distance": 1.0},
    "lens as wide as the scene is": {"lens_radius": 100.0},
    "sharp at the lens": {"lens_radius": 0.1, "focal_distance": 1e-300},
    "sharp at the horizon": {"lens_radius": 0.1, "focal_distance": np.inf},
    "pinhole without focus": {"lens_radius": 0.0, "focal_distance": 0.0},
    "pinhole with undefined focus": {"lens_radius": 0.0, "focal_distance": np.nan},
    "clipped at the lens": {"clip_start": 0.0, "clip_end": 1e-300},
    "clipped beyond all": {"clip_start": 1e300, "clip_end": np.inf},
}
ANGLES = {
    CameraKind.EQUIRECTANGULAR: lambda x: (-x, x, -x, x),
    CameraKind.FISHEYE_EQUIDISTANT: lambda x: (x,),
    CameraKind.FISHEYE_EQUISOLID: lambda x: (x, x, x, x),
    CameraKind.FISHEYE_POLYNOMIAL: lambda x: (x, x, x, x, x, x, x, x),
    CameraKind.CYLINDRICAL: lambda x: (-x, x, -x, x, x),
}


def seen(**fields):
    """Render with changed fields of the camera; return the number of invalid samples and all passes."""
    shot = dataclasses.replace(SHOT, camera=dataclasses.replace(SHOT.camera, **fields))
    with Session.upload(shot) as session:
        assert session.render_all()
        return session.statistics().invalid_samples, {which.name: session.read(which) for which in Pass}


def assert_numbers(**fields):
    invalid, passes = seen(**fields)
    assert invalid == 0
    assert [name for name, values in passes.items() if not np.isfinite(values).all()] == []
    assert passes["COMBINED"].min() >= 0.0


@pytest.mark.parametrize("name", LENSES)
def test_lenses(library, name):
    assert_numbers(**LENSES[name])


@pytest.mark.parametrize("size", [1e-300, 1e-30, 1e-6, 1e6, 1e30, 1e300])
@pytest.mark.parametrize("kind", ANGLES)
def test_panoramas(library, kind, size):
    numbers = ANGLES[kind](size)
    assert_numbers(kind=kind, window=(0, 1, 0, 1), panorama=(*numbers, *(0.0,) * (8 - len(numbers))))


def at(x):
    matrix = np.array(SHOT.camera.matrix)
    matrix[0, 3] = x
    return {"matrix": matrix}


@pytest.mark.parametrize("x", [1e6, 1e9, 1e15])
def test_eyes_far_away(library, x):
    assert_numbers(**at(x))


REFUSED = {
    "eye": at(1e20),
    "eye beyond squares": at(1e200),
    "eye nowhere": at(np.inf),
    "eye undefined": at(np.nan),
    "lens": {"lens_radius": 1e30},
    "lens beyond squares": {"lens_radius": 1e300},
    "lens undefined": {"lens_radius": np.nan},
    "focus": {"lens_radius": 0.1, "focal_distance": 0.0},
    "focus undefined": {"lens_radius": 0.1, "focal_distance": np.nan},
    "window": {"window": (0.0, 0.0, -1.0, 1.0)},
    "window undefined": {"window": (0.0, np.nan, -1.0, 1.0)},
    "clips": {"clip_start": 2.0, "clip_end": 1.0},
    "clips undefined": {"clip_start": np.nan, "clip_end": 1.0},
}


@pytest.mark.parametrize("name", REFUSED)
def test_refusals(library, name):
    with pytest.raises(LancerError, match="^camera: "):
        seen(**REFUSED[name])


@pytest.mark.parametrize("value", [1e31, 1e200, np.inf, np.nan])
def test_things_beyond_all_bounds_are_left_out(library, value):
    """Objects that large or that far away are left out, with a message that names them; other objects are rendered."""
    matrix = np.eye(4)
    for row, column in ((0, 0), (1, 3)):
        wild = matrix.copy()
        wild[row, column] = value
        shot = scene([sphere(0), sphere(0, wild, name="Wild")], SHOT.materials[:1], world=1.0)
        with Session.upload(shot) as session:
            assert session.render_all()
            assert len(session.messages()) == 1 and "'Wild'" in session.messages()[0]
            assert session.statistics().instances == 1
            assert 0.0 < session.read()[..., 0].mean() < 1.0
