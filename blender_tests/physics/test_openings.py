"""Openings: half of the light samples of the sky go through them, which changes the noise and not the picture."""

import dataclasses

import numpy as np
import pytest
import tiny_scenes as tiny

from addon.bindings.enums import AreaShape, Coordinate, LightKind, LobeKind, NodeKind
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, Light, Lobe, Material, MeshData, Node, NodeRef, World

EVEN = World((1.0, 1.0, 1.0))
# Red by the direction's height, green by its x.
UNEVEN = World(NodeRef(0), nodes=(Node(NodeKind.COORDINATE, option=Coordinate.GENERATED),), map_resolution=32)
SKIES = {"even": EVEN, "uneven": UNEVEN}
SIDE = 0.5


def room(albedo=0.5):
    """Return the faces of a box of side 4 around z = 2, whose ceiling has a square hole of 2 SIDE in its middle."""
    ends = (-2.0, -SIDE, SIDE, 2.0)
    faces = []
    for i, (left, right) in enumerate(zip(ends, ends[1:], strict=False)):
        for k, (low, high) in enumerate(zip(ends, ends[1:], strict=False)):
            if (i, k) != (1, 1):
                faces.append([(left, low, 4), (left, high, 4), (right, high, 4), (right, low, 4)])
    faces.append([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)])
    for a, b in (((-2, -2), (2, -2)), ((2, -2), (2, 2)), ((2, 2), (-2, 2)), ((-2, 2), (-2, -2))):
        faces.append([(*a, 0), (*a, 4), (*b, 4), (*b, 0)])
    corners = np.array(faces, float).reshape(-1, 3)
    triangles = [(4 * i + a, 4 * i + b, 4 * i + c) for i in range(len(faces)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    return MeshData("room", corners, triangles), tiny.lambert(albedo)


def opening(height=4.0, size=2 * SIDE, x=0.0, **fields):
    """Return an opening that faces down."""
    place = tiny.move(x, 0.0, height)
    return Light("window", place, LightKind.AREA, size=(size, size), emission=(0, 0, 0), opening=True, **fields)


def lit(lights, sky, material=None, pixels=24, samples=64, **settings):
    """Return the pixels of the floor's place (1, 0, 0) and the mean over pixels of each channel's error."""
    mesh, matt = room()
    camera = tiny.pencil((1.0, 0.0, 1.0), (1.0, 0.0, 0.0), pixels=pixels)
    snapshot = tiny.scene([Instance(mesh=0)], [material or matt], lights, [mesh], camera=camera, samples=samples, **settings)
    return tiny.render(dataclasses.replace(snapshot, world=sky))[..., :3].reshape(-1, 3)


def mean_and_error(pixels):
    return pixels.mean(axis=0), pixels.std(axis=0, ddof=1) / np.sqrt(len(pixels))


@pytest.mark.parametrize("sky", SKIES)
def test_an_opening_leaves_the_mean_and_takes_noise(sky):
    """Pixels are independent: their means agree within 4 standard errors, the chance of which is 6e-5 for each channel.

    A cosine lobe finds the hole, 1 by 1 at a distance of 4, with a probability of about 2 %: the variance of the light is some
    50 times its squared mean. Light samples of the whole even sky do not exist; those through the hole leave less than 1.
    """
    without, with_opening = (lit(lights, SKIES[sky], max_bounces=2) for lights in ((), (opening(),)))
    (mean, error), (guided_mean, guided_error) = mean_and_error(without), mean_and_error(with_opening)
    assert np.all(np.abs(mean - guided_mean) <= 4 * np.hypot(error, guided_error)), (mean, guided_mean, error, guided_error)
    assert np.all(guided_error < 0.5 * error), (error, guided_error)


@pytest.mark.parametrize("lights", [
    pytest.param((opening(shape=AreaShape.ELLIPSE),), id="an ellipse that covers a part"),
    pytest.param((opening(size=0.3, x=0.2), opening(), opening(5.0, 3.0)), id="overlapping ones"),
    pytest.param((opening(-1.0),), id="one that no place is before"),
    pytest.param((opening(3.0, 0.2, 1.0),), id="a small one before the wrong place"),
])  # fmt: skip
def test_any_openings_leave_the_mean(lights):
    plain, guided = lit((), UNEVEN), lit(lights, UNEVEN)
    (mean, error), (guided_mean, guided_error) = mean_and_error(plain), mean_and_error(guided)
    assert np.all(np.abs(mean - guided_mean) <= 4 * np.hypot(error, guided_error)), (mean, guided_mean, error, guided_error)


def test_gloss_is_weighed_by_the_same_densities():
    """A rough mirror finds the hole by its own samples, too: both techniques share the light."""
    gloss = Material("gloss", lobes=(Lobe(LobeKind.GLOSSY, color=(0.8,) * 3, roughness=0.5),))
    (mean, error), (guided_mean, guided_error) = (
        mean_and_error(lit(lights, UNEVEN, gloss, max_bounces=2)) for lights in ((), (opening(),))
    )
    assert np.all(np.abs(mean - guided_mean) <= 4 * np.hypot(error, guided_error)), (mean, guided_mean, error, guided_error)


def test_an_opening_before_an_open_sky_is_exact():
    """A floor below an even sky, without a room: the albedo, whatever guides the samples."""
    floor = [tiny.plane()]
    camera = tiny.pencil(pixels=16)
    snapshot = tiny.scene(floor, [tiny.lambert(0.5)], [opening(1.0, 2.0)], world=1.0, camera=camera, samples=256)
    mean, error = mean_and_error(tiny.render(snapshot)[..., :3].reshape(-1, 3))
    assert np.all(np.abs(mean - 0.5) <= 4 * error) and np.all(error < 2e-3)


def test_openings_are_no_lamps_and_change_nothing_under_a_black_sky():
    snapshot = tiny.showroom(16)
    opened = dataclasses.replace(snapshot, lights=(*snapshot.lights, opening()), world=World((0.0, 0.0, 0.0)))
    black = dataclasses.replace(snapshot, world=World((0.0, 0.0, 0.0)))
    assert np.array_equal(tiny.render(black), tiny.render(opened))
    with Session.upload(opened) as session:
        assert "openings" in session.statistics().features.split()
