"""Raycast against closed forms: its values as emission."""

import math

import numpy as np
import pytest
from looking import BLACK, EXACT, FIRST, INFINITE, POSITION, corner_mesh, glowing, raycast, seen, wall
from tiny_scenes import move, plane, rotate_x, rotate_y, sphere

from addon.bindings.enums import Domain, NodeKind, Ray, VectorOperation
from addon.bindings.shading import Node, NodeRef
from addon.bindings.snapshot import Instance, MeshAttribute, MeshData


def cast(node, things=None, meshes=(), **fields):
    things = [plane(), plane(1, move(z=3.0) @ rotate_x(math.pi))] if things is None else things
    return seen([glowing(POSITION, node), BLACK], things, meshes, at=(0.25, 0.5, 0.0), samples=2, **fields)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_a_ray_meets_a_plane(size):
    """The distance is in lengths of the direction."""
    things = [plane(), plane(1, move(z=3.0 * size) @ rotate_x(math.pi))]
    for long in (1.0, 2.0, 0.5):
        got = cast(raycast((0, 0, long * size)), things, side=size)
        assert got == pytest.approx([1, 0, 3 / long], rel=EXACT)
        assert cast(raycast((0, 0, long * size), 2.9 / long), things, side=size) == pytest.approx([0, 0, 2.9 / long], rel=EXACT)


def test_the_place_and_the_normal_of_a_hit():
    assert cast(raycast((0.5, 0.25, 1), option=1)) == pytest.approx([0.25 + 1.5, 0.5 + 0.75, 3.0], abs=EXACT)
    assert cast(raycast((0, 0, -1), option=1)) == pytest.approx([0] * 3)
    # The normal is on the side of the ray, whichever side faces out. Colours below 0 are cut.
    for turn in (0.0, math.pi):
        things = [plane(), plane(1, move(-2.0) @ rotate_y(math.pi / 2 + turn))]
        assert cast(raycast((-1, 0, 0), option=2), things) == pytest.approx([1, 0, 0], abs=EXACT)
    assert cast(raycast((1, 0, 0), option=2), things) == pytest.approx([0] * 3)


def test_a_ray_meets_its_own_object_elsewhere():
    """Through a ball of radius 1; from beside the surface, also at the surface itself."""
    ball = [sphere(0, move(0.25, 0.5, -1.0))]
    assert cast(raycast((0, 0, -1)), ball) == pytest.approx([1, 1, 2], abs=EXACT)
    above = Node(NodeKind.VECTOR_MATH, VectorOperation.ADD, inputs=(NodeRef(0), (0, 0, 0.5)))
    materials = [glowing(POSITION, above, raycast((0, 0, -1), position=NodeRef(1))), BLACK]
    assert seen(materials, [plane()], at=(0.25, 0.5, 0.0), samples=2) == pytest.approx([1, 1, 0.5], abs=EXACT)


def test_a_ray_alone_sees_only_its_own_object():
    assert cast(raycast(flags=1)) == pytest.approx([0, 0, 10])
    mesh = [Instance(mesh=0, materials=(0,), hidden_from=Ray.RAYCAST), wall(-0.1)]
    got = cast(raycast((-1, 0, 0.1), flags=1), mesh, [corner_mesh()])
    assert got == pytest.approx([1, 1, 0.75], abs=EXACT)


def test_a_ray_passes_objects_that_are_hidden_from_it():
    def things(hidden):
        return [plane(), plane(1, move(z=1.0), hidden_from=hidden), plane(1, move(z=2.0))]

    for hidden, expected in ((Ray.RAYCAST, 2), (Ray.SHADOW | Ray.CAMERA | Ray.DIFFUSE | Ray.GLOSSY | Ray.TRANSMISSION, 1)):
        assert cast(raycast(), things(hidden), side=0.5)[2] == pytest.approx(expected, abs=EXACT)


@pytest.mark.parametrize("way", [{"direction": (0, 0, 0)}, {"direction": FIRST}, {"position": FIRST}], ids=str)
def test_a_way_that_is_none_meets_nothing(way):
    materials = [glowing(INFINITE, raycast(**way)), BLACK]
    assert seen(materials, [plane(), plane(1, move(z=3.0))], samples=2) == pytest.approx([0, 0, 10])


def _ceiling(**values):
    """Return the mesh of a triangle below which the place of cast() is, and its attributes of corners."""
    corners = [(-4.0, -4.0, 2.0), (8.0, -4.0, 2.0), (-4.0, 8.0, 2.0)]
    attributes = [MeshAttribute(name, np.array(rows, np.float32), Domain.VERTEX) for name, rows in values.items()]
    return MeshData("ceiling", corners, [(0, 2, 1)], attributes=tuple(attributes))


def test_a_ray_reads_an_attribute_where_it_ends():
    """The weights of the corners at (0.25, 0.5) are those of a map of the triangle."""
    u, v = (0.25 + 4.0) / 12.0, (0.5 + 4.0) / 12.0
    tint = [(0.9, 0.2, 0.1, 0.5), (0.3, 0.8, 0.4, 1.0), (0.1, 0.6, 0.7, 0.25)]
    mesh = _ceiling(tint=tint, pair=[(0.2, 0.7)] * 3, number=[(0.25,), (0.5,), (0.75,)])
    things = [plane(), Instance(mesh=0, materials=(1,))]

    def read(name, flags=0, **fields):
        return cast(raycast(option=3, flags=flags, name=name, **fields), things, [mesh])

    expected = (1.0 - u - v) * np.array(tint[0]) + u * np.array(tint[1]) + v * np.array(tint[2])
    assert read("tint") == pytest.approx(expected[:3], abs=EXACT)
    assert read("tint", 2) == pytest.approx([expected[:3].mean()] * 3, abs=EXACT)
    assert read("tint", 4) == pytest.approx([expected[3]] * 3, abs=EXACT)
    assert read("number") == pytest.approx([0.25 + 0.25 * u + 0.5 * v] * 3, abs=EXACT)
    assert read("pair", 2) == pytest.approx([0.2] * 3, abs=EXACT)
    for missing in (read("other"), read("tint", length=1.5), read("tint", 1), read("tint", 4, length=1.5)):
        assert missing == pytest.approx([0] * 3)
    # As in Cycles, what a surface lacks has an alpha; what no ray meets has none.
    assert read("other", 4) == pytest.approx([1] * 3)
