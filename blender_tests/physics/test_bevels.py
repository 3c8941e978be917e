"""Bevel against closed forms: its normal as emission."""

import math

import numpy as np
import pytest
import tiny_scenes as tiny
from looking import BLACK, EXACT, FIRST, INFINITE, as_color, bevel, glowing, seen, wall
from tiny_scenes import move, pencil, plane, rotate_x, scene

from addon.bindings.enums import (
    Integrator,
    LobeKind,
    NodeKind,
    VectorOperation,
)
from addon.bindings.shading import Lobe, Material, Node
from addon.bindings.snapshot import Instance, MeshData


def edge_mesh():
    """Return the edge x = z = 0 between a floor z = 0, x < 0 and a side x = 0, z < 0 below it, which faces +x."""
    floor = [(-5, -5, 0), (0, -5, 0), (0, 5, 0), (-5, 5, 0)]
    side = [(0, -5, -5), (0, 5, -5), (0, 5, 0), (0, -5, 0)]
    return MeshData("edge", floor + side, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])


def rounded(place, radius=1.0):
    """Return the normal at a distance from the edge: the mean over both faces, weighted by (radius - r)^3 at distance r."""
    steps = np.linspace(-radius, radius, 1601)
    step = steps[1] - steps[0]
    y, along = np.meshgrid(steps, np.linspace(0, radius, 801)[:-1] + step / 2)

    def sum_of(r):
        return np.sum(np.maximum(radius - r, 0.0) ** 3)

    # On the floor, from the edge inwards by up to place + radius.
    inwards = np.arange(0, place + radius, step) + step / 2
    floor = sum_of(np.hypot(*np.meshgrid(steps, inwards - place)))
    side = sum_of(np.sqrt(y * y + along * along + place * place))
    normal = np.array([side, 0.0, floor])
    return normal / np.linalg.norm(normal)


def normal_at(place, node, *more, **settings):
    """Return the mean normal at a distance from the edge, not of unit length."""
    materials = [glowing(node, *more, as_color(len(more)))]
    got = seen(materials, [Instance(mesh=0, materials=(0,))], [edge_mesh()], at=(-place, 0.0, 0.0), **settings)
    return 2 * got - 1


@pytest.mark.parametrize("place", [1e-4, 0.2, 0.5, 0.8])
def test_an_edge_is_rounded(place):
    got = normal_at(place, bevel(1.0))
    got /= np.linalg.norm(got)
    # The mean of 128 rays strays by at most 0.1 from its direction; as a direction is not linear in the sum, it is biased by
    # at most the square of that.
    assert got == pytest.approx(rounded(place), abs=0.01)


def test_at_an_edge_the_normal_bisects():
    got = normal_at(1e-6, bevel(0.5))
    assert got / np.linalg.norm(got) == pytest.approx([math.sqrt(0.5), 0.0, math.sqrt(0.5)], abs=0.01)


def test_two_rays_lie_along_the_axes_of_cycles():
    """One of two rays goes along the normal. The other is turned by 45 degrees against this edge, so that it meets the side
    if it starts below the edge and its disk, of radius r, lets it reach the side before its end.
    """
    count = 1024
    turned = Node(NodeKind.VECTOR_MATH, VectorOperation.CEIL, inputs=(FIRST,))
    materials = [glowing(bevel(1.0, rays=2), turned)]
    got = seen(materials, [Instance(mesh=0, materials=(0,))], [edge_mesh()], at=(-1e-6, 0.0, 0.0), samples=count)
    r = (np.arange(10000) + 0.5) / 10000
    reaching = np.arcsin(np.minimum(np.sqrt(1 - r * r) / r, 1)) / (math.pi / 2)
    share = 0.5 * np.mean(20 * r * (1 - r) ** 3 * reaching)
    assert got[0] == pytest.approx(share, abs=5 * math.sqrt(share * (1 - share) / count))


def test_far_from_edges_the_normal_stays():
    assert normal_at(1.0, bevel(0.99)) == pytest.approx([0, 0, 1], abs=EXACT)


def test_the_other_side_is_rounded_inwards():
    """Seen from below, the normal is on the viewer's side."""
    assert normal_at(2.0, bevel(1.0), side=-1.0) == pytest.approx([0, 0, -1], abs=EXACT)


def test_another_object_is_not_rounded():
    things = [plane(), wall(-0.1)]
    got = 2 * seen([glowing(bevel(1.0), as_color(0)), BLACK], things) - 1
    assert got == pytest.approx([0, 0, 1], abs=EXACT)


def test_a_bevel_is_added_to_another_normal():
    """The difference from the surface's own normal, which is not the shading normal if the material is bumped."""
    given, own = np.array([0.0, 0.6, 0.8]), np.array([0.6, 0.0, 0.8])
    far = normal_at(2.0, bevel(1.0, normal=tuple(given)))
    assert far == pytest.approx(given, abs=EXACT)
    bumped = normal_at(2.0, bevel(1.0, normal=tuple(given), own=tuple(own)))
    sum_of = given + (0, 0, 1) - own
    assert bumped == pytest.approx(sum_of / np.linalg.norm(sum_of), abs=EXACT)


def test_without_rays_the_own_normal_stays():
    own = (0.6, 0.0, 0.8)
    for node in (bevel(0.0, own=own), bevel(1.0, own=own, rays=0), bevel(FIRST, own=own)):
        assert normal_at(1e-3, INFINITE, node, samples=2) == pytest.approx(own, abs=EXACT)
    got = normal_at(1e-3, bevel(1.0, own=own), samples=2, integrator=Integrator.CLASSIC)
    assert got == pytest.approx(own, abs=EXACT)


def reflected(kind, radius):
    """Return the light that a floor of one lobe gets from the normals of an edge above, which it sees as colours."""
    floor = Material("floor", lobes=(Lobe(kind, color=(1, 1, 1)),))
    above = move(0, 0, 1.0) @ rotate_x(math.pi)
    things = [plane(1), Instance(mesh=0, materials=(0,), matrix=above)]
    materials = [glowing(bevel(radius), as_color(0)), floor]
    camera = pencil((-1e-3, 0.0, 0.5), (-1e-3, 0.0, 0.0))
    return tiny.radiance(scene(things, materials, meshes=[edge_mesh()], camera=camera, samples=16, max_bounces=1))


def test_edges_are_rounded_where_paths_arrive_sharply():
    """A mirror shows the bevel, a diffuse floor the edge."""
    assert np.array_equal(reflected(LobeKind.LAMBERT, 1.0), reflected(LobeKind.LAMBERT, 0.0))
    assert np.abs(reflected(LobeKind.MIRROR, 1.0) - reflected(LobeKind.MIRROR, 0.0)).max() > 0.1
