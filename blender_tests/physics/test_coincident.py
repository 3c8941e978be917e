"""Coincident surfaces of different materials: the first is visible in every pixel, and lit as if it were alone."""

import numpy as np
import pytest
from ten_scenes import SMOOTH
from tiny_scenes import lambert, look_at, move, quad, render, rotate_x, rotate_y, scene

from addon.bindings.abi import Accelerator, InstanceKind, LightKind
from addon.bindings.snapshot import Camera, Instance, Light, MeshData

PLACE = rotate_x(0.3) @ rotate_y(0.2) @ move(0.1, 0.2, 0.3)
QUAD = quad(2.0)
INSIDE_OUT = MeshData("inside out", QUAD.positions, QUAD.triangles[:, ::-1])
FACES = np.concatenate([QUAD.triangles, QUAD.triangles[:, [2, 0, 1]]])
BOTH = MeshData("both", QUAD.positions, FACES, material_slots=[0, 0, 1, 1])


def twice(**fields):
    return [Instance(matrix=PLACE, materials=(material,), **fields) for material in (0, 1)]


def of_two_meshes():
    first, second = twice()
    return [first, Instance(mesh=1, matrix=PLACE, materials=second.materials)]


# Instances and their meshes.
CASES = {
    "copies": (twice(), [QUAD]),
    "smooth copies": (twice(), [SMOOTH]),
    "a copy inside out": (of_two_meshes(), [QUAD, INSIDE_OUT]),
    "faces of one mesh": ([Instance(matrix=PLACE, materials=(0, 1))], [BOTH]),
    **{kind.name.lower(): (twice(kind=kind), []) for kind in InstanceKind if kind != InstanceKind.MESH},
}


@pytest.mark.parametrize("accelerator", Accelerator)
@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("name", CASES)
def test_the_first_is_seen(library, name, threads, accelerator):
    things, shapes = CASES[name]
    lamps = [Light("sun", rotate_x(0.5), LightKind.SUN, emission=(np.pi,) * 3)]
    # From above and from below, on the faces' backs.
    for height in (5.0, -5.0):
        lens = Camera(matrix=look_at((0.5, -1, height), (0, 0, 0)), width=32, height=32, window=(-0.1, 0.1, -0.1, 0.1))

        def picture(things, lens=lens):
            shot = scene(
                things, [lambert((0.8, 0, 0)), lambert((0, 0.8, 0))], lamps, shapes, (0.1, 0, 0), lens,
                samples=4, max_bounces=3, threads=threads, accelerator=accelerator,
            )  # fmt: skip
            return render(shot)

        seen = picture(things)
        assert seen[..., 1].max() == 0.0 and seen[..., 0].min() > 0.04
        if len(things) == 2:
            assert np.array_equal(seen, picture(things[:1]))
