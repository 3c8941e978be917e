"""Surfaces of different tessellation in one plane: one of them is visible everywhere with even light; glass on a floor."""

import dataclasses

import numpy as np
import pytest
from ten_scenes import GLASS
from tiny_scenes import lambert, look_at, move, plane, quad, render, rotate_x, rotate_y, scale, scene, veiled

from addon.bindings.abi import Accelerator, InstanceKind, LightKind
from addon.bindings.snapshot import Camera, Instance, Light, MeshData

RED, GREEN = lambert((0.8, 0, 0)), lambert((0, 0.8, 0))
PLACE = move(0.1, 0.2, 0.3) @ rotate_x(0.3) @ rotate_y(0.2)
CORNERS = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
BOX = MeshData("box", CORNERS, [t for a, b, c, d in FACES for t in ((a, b, c), (a, c, d))])


def grid(n, matrix=None):
    """Return the square of quad(2), subdivided, with its vertices transformed by a matrix."""
    x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
    points = np.stack([x.ravel(), y.ravel(), np.zeros(x.size), np.ones(x.size)])
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    triangles = np.concatenate(
        [np.stack([first, first + 1, first + n + 2], 1), np.stack([first, first + n + 2, first + n + 1], 1)]
    )
    return MeshData("grid", (points if matrix is None else matrix @ points)[:3].T, triangles)


def stored(matrix):
    """Return the matrix rounded to float, as Blender stores it."""
    return matrix.astype(np.float32).astype(float)


# The red instance, the green one, their meshes: both share the plane z = 0 of PLACE.
CASES = {
    f"a grid a rounding {side} the top of a box": (
        Instance(matrix=stored(PLACE @ move(0, 0, -1)), materials=(0,)),
        Instance(mesh=1, matrix=stored(PLACE @ move(0, 0, height)), materials=(1,)),
        [BOX, grid(9)],
    )
    for side, height in (("above", 2.0**-24), ("below", -(2.0**-24)))
} | {
    "a grid whose corners were moved": (
        Instance(matrix=stored(PLACE), materials=(0,)),
        Instance(mesh=1, materials=(1,)),
        [quad(2.0), grid(9, PLACE)],
    ),
    "an endless plane": (
        Instance(kind=InstanceKind.PLANE, matrix=stored(PLACE), materials=(0,)),
        Instance(mesh=0, materials=(1,)),
        [grid(9, PLACE)],
    ),
}


@pytest.mark.parametrize("accelerator", Accelerator)
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("name", CASES)
def test_the_first_is_seen_and_lit(library, name, size, accelerator):
    first, second, meshes = CASES[name]
    eye = (PLACE @ (1.5, -2.5, 0.8, 1))[:3]
    lens = Camera(
        matrix=stored(look_at(size * eye, size * PLACE[:3, 3])), width=48, height=48, window=(-0.15, 0.15, -0.1, 0.1),
        clip_start=1e-3 * size, clip_end=1e3 * size,
    )  # fmt: skip
    lamps = [Light("sun", rotate_x(0.5), LightKind.SUN, emission=(np.pi,) * 3)]

    def picture(things):
        larger = [dataclasses.replace(t, matrix=size * t.matrix) for t in things]
        shot = scene(larger, [RED, GREEN], lamps, meshes, (0.1, 0, 0), lens, samples=4, max_bounces=3, accelerator=accelerator)
        return render(shot)

    seen, alone = picture([first, second]), picture([first])
    assert seen[..., 1].max() == 0.0 and seen[..., 0].min() > 0.04
    # The same surface and light: only the rounding of points differs.
    assert np.allclose(seen[..., 0], alone[..., 0], rtol=1e-4)


@pytest.mark.parametrize("glass_first", [True, False])
@pytest.mark.parametrize("place", [np.eye(4), PLACE], ids=["upright", "turned"])
def test_no_light_passes_between_glass_and_floor(library, place, glass_first):
    """A black floor over a lamp: any light that reaches the eye has leaked through the floor."""
    block = Instance(matrix=stored(place @ move(0, 0, 1)), materials=(0,))
    floor = plane(1, stored(place))
    below = Instance(mesh=1, matrix=stored(place @ move(0, 0, -1) @ scale(20)), materials=(2,))
    lens = Camera(matrix=look_at((place @ (1.5, -4, 3, 1))[:3], (place @ (0, 0, 1, 1))[:3]), width=64, height=64)
    things = [block, floor, below] if glass_first else [floor, block, below]
    black, lamp = lambert(0.0), lambert(0.0, emission=(1.0,) * 3)
    seen = render(scene(things, [GLASS, black, lamp], [], [BOX, quad(1.0)], 0.0, lens, samples=16, max_bounces=12))
    assert np.count_nonzero(seen[..., :3]) == 0


@pytest.mark.parametrize("height", [2.0**-24, 0.0, -(2.0**-24)])
@pytest.mark.parametrize("lamp_first", [True, False])
def test_a_shining_face_is_there_before_those_that_do_not(library, lamp_first, height):
    """An emitting face in the plane of a ceiling lights the floor, whatever the rounding and the order."""
    ceiling = Instance(mesh=0, matrix=stored(PLACE), materials=(0,))
    lamp = Instance(mesh=1, matrix=stored(PLACE @ move(0, 0, height)), materials=(1,))
    floor = Instance(mesh=0, matrix=stored(PLACE @ move(0, 0, -1)), materials=(0,))
    looks = [lambert(0.5), lambert(0.0, emission=(1.0,) * 3)]
    eye, spot = (PLACE @ (0, 0, -0.5, 1))[:3], (PLACE @ (0.1, 0.2, -1, 1))[:3]
    lens = Camera(matrix=look_at(eye, spot), width=16, height=16)

    def picture(*things):
        return render(scene(things, looks, [], [grid(5), quad(1.0)], 0.0, lens, samples=64))[..., 0]

    seen = picture(lamp, ceiling, floor) if lamp_first else picture(ceiling, lamp, floor)
    assert np.allclose(seen, picture(lamp, floor), rtol=1e-4)


def test_a_veil_of_light_on_a_ceiling_is_not_there(library):
    """A transparent emitter in the plane of an opaque face is invisible and lights nothing, so that no light leaks."""
    ceiling = Instance(mesh=0, matrix=stored(PLACE), materials=(0,))
    lamp = Instance(mesh=1, matrix=stored(PLACE @ move(0, 0, 2.0**-24)), materials=(1,))
    floor = Instance(mesh=0, matrix=stored(PLACE @ move(0, 0, -1)), materials=(0,))
    looks = [lambert(0.5), dataclasses.replace(veiled(lambert(0.0), 0.5), emission=(1.0,) * 3)]
    lens = Camera(matrix=look_at((PLACE @ (0, 0, -0.5, 1))[:3], (PLACE @ (0.1, 0.2, -1, 1))[:3]), width=16, height=16)
    assert render(scene([lamp, ceiling, floor], looks, [], [grid(5), quad(1.0)], 0.0, lens, samples=64))[..., :3].max() == 0.0


@pytest.mark.parametrize("height", [2.0**-24, -(2.0**-24)])
def test_veils_in_one_plane_are_one_veil(library, height):
    """Of two transparent faces in one plane only one counts: half of the light passes, for sun and camera rays."""
    veil = Instance(mesh=0, matrix=stored(PLACE), materials=(0,))
    other = Instance(mesh=1, matrix=stored(PLACE @ move(0, 0, height)), materials=(1,))
    floor = plane(2, stored(PLACE @ move(0, 0, -1)))
    looks = [veiled(lambert((0.8, 0, 0)), 0.5), veiled(lambert((0, 0.8, 0)), 0.5), lambert(0.5)]
    lens = Camera(
        matrix=look_at((PLACE @ (0.5, -2, 3, 1))[:3], PLACE[:3, 3]), width=32, height=32, window=(-0.5, 0.5, -0.5, 0.5)
    )
    lamps = [Light("sun", rotate_x(0.2), LightKind.SUN, emission=(np.pi,) * 3)]

    def picture(*things):
        return render(scene(things, looks, lamps, [grid(5), grid(8)], 0.0, lens, samples=64, max_bounces=0))

    seen, alone = picture(veil, other, floor), picture(veil, floor)
    assert alone[..., 1].max() > 0.1 and np.allclose(seen, alone, rtol=1e-4, atol=1e-6)
