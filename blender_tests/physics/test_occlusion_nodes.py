"""Ambient Occlusion against closed forms: its value as emission."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes as tiny
from looking import (
    ALONE,
    BLACK,
    EXACT,
    FAR,
    FIRST,
    INFINITE,
    INSIDE,
    NO_NORMAL,
    as_color,
    beside_a_wall,
    corner_mesh,
    glowing,
    noise,
    occlusion,
    seen,
    wall,
)
from tiny_scenes import move, pencil, plane, rotate_y, scene, sphere

from addon.bindings.enums import (
    Integrator,
    MathOperation,
    NodeKind,
    Ray,
)
from addon.bindings.shading import Node, NodeRef, World
from addon.bindings.snapshot import Instance, MeshData


def test_nothing_occludes_a_plane():
    assert seen([glowing(occlusion(FAR))], [plane()], samples=4) == pytest.approx([1.0] * 3, abs=0)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("place", [1e-3, 0.5, 0.9, 1.5])
def test_a_wall_occludes_a_segment(place, size):
    got = seen([glowing(occlusion(size)), BLACK], [plane(), wall(-place * size)], width=1e-6 * size)[0]
    share = beside_a_wall(place, 1.0)
    assert got == pytest.approx(share, abs=noise(share) + EXACT)


def test_a_corner_is_half_open():
    got = seen([glowing(occlusion(FAR)), BLACK], [plane(), wall()], at=(1.0, 0.0, 0.0))[0]
    assert got == pytest.approx(0.5, abs=noise(0.5))


def test_two_rays_are_spread_by_the_axes_of_cycles():
    """Two rays lie in opposite quadrants. Two of the quadrants are halved by this wall, whose axis is a diagonal of the axes of
    Cycles: there both rays are open in one of four cases.
    """
    count, share = 1024, 0.5 * 0.25
    both = Node(NodeKind.MATH, MathOperation.FLOOR, inputs=(FIRST,))
    got = seen([glowing(occlusion(FAR, rays=2), both), BLACK], [plane(), wall()], at=(1.0, 0.0, 0.0), samples=count)[0]
    assert got == pytest.approx(share, abs=5 * math.sqrt(share * (1 - share) / count))


@pytest.mark.parametrize("reach", [0.5, 1.0, 1.9, 3.0])
def test_inside_a_ball_rays_end_at_chords(reach):
    """A chord at the angle t from the axis is 2 cos t long; a share 1 - c^2 of the rays has a cosine above c."""
    got = seen([glowing(occlusion(reach, INSIDE))], [sphere(0, move(z=-1.0))])[0]
    share = max(1 - (reach / 2) ** 2, 0.0)
    assert got == pytest.approx(share, abs=noise(share) + EXACT)


def test_the_viewer_is_on_the_side_of_the_normal():
    """From below, a ceiling above occludes only rays of the inside."""
    things = [plane(), plane(1, move(z=0.5))]
    for flags, expected in ((0, 1.0), (INSIDE, 0.0)):
        assert seen([glowing(occlusion(FAR, flags)), BLACK], things, side=-1.0)[0] == pytest.approx(expected, abs=2e-3), flags


@pytest.mark.parametrize("flags", [0, ALONE])
def test_only_local_sees_its_own_object(flags):
    """One wall of its own, and one of another object or of an instance of the same mesh on the other side."""
    once = beside_a_wall(0.5, 1.0)
    for others in ([wall(0.5)], [Instance(mesh=0, materials=(1,), matrix=move(0.5) @ rotate_y(-math.pi / 2))]):
        got = seen([glowing(occlusion(1.0, flags)), BLACK], [Instance(mesh=0, materials=(0,)), *others], [corner_mesh()])[0]
        share = once if flags else 2 * once - 1
        assert got == pytest.approx(share, abs=noise(share))


def test_only_local_sees_faces_in_the_plane_of_others():
    """The underside of a slab lies on a floor, which other rays meet instead; the inside is open to a share c^2."""
    faces = [(x, y, z) for z in (0.0, -0.5) for x, y in ((-5, -5), (5, -5), (5, 5), (-5, 5))]
    slab = MeshData("slab", faces, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
    things = [plane(0, move(z=-0.5)), Instance(mesh=0, materials=(0,))]
    got = seen([glowing(occlusion(1.0, INSIDE | ALONE))], things, [slab])[0]
    assert got == pytest.approx(0.25, abs=noise(0.25))


@pytest.mark.parametrize("hidden, flags, occluded", [
    (Ray.SHADOW, 0, False), (Ray.CAMERA | Ray.DIFFUSE, 0, True), (Ray.SHADOW, ALONE, True),
])  # fmt: skip
def test_occlusion_is_that_of_shadows(hidden, flags, occluded):
    """An object without shadows occludes nothing but itself."""
    share = beside_a_wall(0.5, 1.0)
    if flags:
        things, meshes = [Instance(mesh=0, materials=(0,), hidden_from=hidden)], [corner_mesh()]
    else:
        things, meshes = [plane(), wall(-0.5, hidden_from=hidden)], []
    got = seen([glowing(occlusion(1.0, flags)), BLACK], things, meshes)[0]
    assert got == pytest.approx(share if occluded else 1.0, abs=noise(share))


def test_what_does_not_look_is_open():
    """No distance, no ray, no normal; CLASSIC; a world."""
    closed = [plane(), plane(1, move(z=1e-3))]
    for node in (occlusion(0.0), occlusion(1.0, rays=0), occlusion(1.0, normal=FIRST)):
        assert seen([glowing(INFINITE, node), BLACK], closed, side=5e-4, samples=2)[0] == 1.0
    classic = seen([glowing(occlusion(1.0)), BLACK], closed, side=5e-4, samples=2, integrator=Integrator.CLASSIC)
    assert classic[0] == 1.0
    snapshot = scene(samples=2)
    sky = World(radiance=NodeRef(0), nodes=(occlusion(1.0),))
    assert tiny.radiance(dataclasses.replace(snapshot, world=sky))[0] == 1.0


def test_another_normal_turns_the_rays():
    """A normal of any length towards the wall: at a right angle, all that reach it are occluded."""
    got = seen([glowing(occlusion(1.0, normal=(-3.0, 0.0, 0.0))), BLACK], [plane(), wall(-0.5)])[0]
    # A share c^2 of the rays has a cosine below c = 0.5; the lower half meets nothing but the plane, which it starts on.
    assert got == pytest.approx(0.25, abs=noise(0.25))


def test_occlusion_is_no_bump():
    """Cycles moves no ray for the heights of a bump: occlusion as a height tilts nothing, whatever else varies."""
    height = (
        occlusion(1.0, rays=4),
        Node(NodeKind.BUMP, inputs=(1.0, 1.0, NodeRef(0), NO_NORMAL, 1.0), first=0),
        as_color(1),
    )
    camera = pencil((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), 0.8, 2)
    got = tiny.render(scene([plane(), wall(-0.5)], [glowing(*height), BLACK], camera=camera, samples=4))
    assert np.abs(got[..., :3] - (0.5, 0.5, 1.0)).max() < EXACT
