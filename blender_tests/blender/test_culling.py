"""Simplify's culling and its limit of the size of images, by the rules of Cycles."""

from types import SimpleNamespace

import numpy as np
import pytest

from addon.bindings.enums import AlphaMode, CameraKind
from addon.bindings.snapshot import Camera, Image
from addon.export.culling import Culling
from addon.export.smaller_images import smaller

BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
LOOKING_DOWN = np.eye(4)[:3]


def culling(kind=CameraKind.PERSPECTIVE, by_camera=True, by_distance=False, margin=0.0, distance=20.0, **render):
    cycles = SimpleNamespace(
        use_camera_cull=by_camera, use_distance_cull=by_distance, camera_cull_margin=margin, distance_cull_margin=distance
    )
    scene = SimpleNamespace(cycles=cycles, render=SimpleNamespace(**{"use_simplify": True, "use_multiview": False, **render}))
    return Culling(scene, Camera(LOOKING_DOWN, kind=kind, window=(-1, 1, -1, 1), clip_start=0.1, clip_end=100.0))


def places(*points):
    matrices = np.tile(np.eye(4)[:3], (len(points), 1, 1))
    matrices[:, :, 3] = points
    return matrices


def culled(which, points, switches=1):
    count = len(points)
    return which.culled(np.full(count, switches), np.tile(BOX, (count, 1, 1)), places(*points)).tolist()


def test_boxes_beside_the_picture_are_culled():
    """At a depth of 9 to 11 the picture reaches 9 to 11 to each side: a box of 2 is beside it from 12 on, or behind."""
    points = [(0, 0, -10), (9.9, 0, -10), (13, 0, -10), (0, -13, -10), (0, 0, 10)]
    assert culled(culling(), points) == [False, False, True, True, True]
    # A margin of the picture's side in front; behind the camera it is a length.
    assert culled(culling(margin=0.5), points) == [False, False, False, False, True]
    assert culled(culling(CameraKind.ORTHOGRAPHIC), [(0, 0, -10), (2.5, 0, -10)]) == [False, True]


def test_distant_boxes_are_culled():
    points = [(0, 0, -10), (0, 0, -20.5), (0, 0, -21.5)]
    assert culled(culling(by_camera=False, by_distance=True), points, 2) == [False, False, True]


def test_both_switches_must_agree():
    both = culling(by_distance=True, distance=20.0)
    points = [(0, 0, -30), (13, 0, -10), (40, 0, -30)]
    assert culled(both, points, 3) == [False, False, True]
    assert culled(both, points, 1) == [False, True, True] and culled(both, points, 2) == [True, False, True]
    assert culled(both, points, 0) == [False, False, False]


@pytest.mark.parametrize(
    "off", [{"use_simplify": False}, {"use_multiview": True}, {"kind": CameraKind.EQUIRECTANGULAR}, {"by_camera": False}]
)
def test_nothing_is_culled(off):
    thing = SimpleNamespace(cycles=SimpleNamespace(use_camera_cull=True, use_distance_cull=True))
    assert culling(**off).switches(thing) == 0 and culling().switches(thing) == 1
    assert culling(by_distance=True, distance=0.0).switches(thing) == 1
    assert culling().switches(SimpleNamespace()) == 0


def test_images_are_halved_until_they_fit():
    texels = np.arange(6 * 10, dtype=np.uint8).reshape(6, 10, 1)
    picture = Image("picture", texels)
    assert smaller(picture, (16, 1.0)) is picture and smaller(picture, (0, 1.0)) is picture
    half = smaller(picture, (5, 1.0)).texels
    # The means of squares of four, rounded.
    assert half.shape == (3, 5, 1) and half[0, 0, 0] == round((0 + 1 + 10 + 11) / 4)
    assert smaller(picture, (4, 1.0)).texels.shape == (1, 2, 1)
    assert smaller(picture, (0, 0.5)).texels.shape == (3, 5, 1) and smaller(picture, (0, 0.6)).texels.shape == (3, 5, 1)


def test_clear_texels_have_no_colour():
    texels = np.zeros((2, 2, 4), np.float32)
    texels[0, 0], texels[1, 1] = (1.0, 0.5, 0.0, 1.0), (0.0, 9.0, 9.0, 0.0)
    texel = smaller(Image("picture", texels, alpha=AlphaMode.STRAIGHT), (1, 1.0)).texels[0, 0]
    assert texel.tolist() == [1.0, 0.5, 0.0, 0.25]
