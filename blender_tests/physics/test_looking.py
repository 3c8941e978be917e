"""Ambient Occlusion, Bevel and Raycast against closed forms: the nodes' values as emission."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes as tiny
from tiny_scenes import move, pencil, plane, rotate_x, rotate_y, scene, sphere

from addon.bindings.enums import (
    Accelerator,
    Coordinate,
    Features,
    Integrator,
    LobeKind,
    MathOperation,
    NodeKind,
    Pass,
    Ray,
    VectorOperation,
)
from addon.bindings.session import Session
from addon.bindings.shading import Lobe, Material, Node, NodeRef, World
from addon.bindings.snapshot import Instance, MeshData

INSIDE, ALONE = 1, 2
FAR = 1e30
NO_NORMAL = (0.0, 0.0, 0.0)
FIRST = NodeRef(0)
POSITION = Node(NodeKind.COORDINATE, Coordinate.POSITION)
INFINITE = Node(NodeKind.MATH, MathOperation.EXPONENT, inputs=(100.0,))
RAYS, SAMPLES = 128, 256
# A few float roundings of numbers that are at most 10.
EXACT = 1e-5


def noise(share):
    """Return five standard errors of a share that independent rays estimate; those of a sequence err less."""
    return 5 * math.sqrt(share * (1 - share) / (RAYS * SAMPLES))


def glowing(*nodes):
    """Return a material that emits the value of its last node and scatters nothing."""
    return Material("glow", lobes=(), emission=NodeRef(len(nodes) - 1), nodes=nodes)


def occlusion(distance, flags=0, normal=NO_NORMAL, rays=RAYS):
    return Node(NodeKind.OCCLUSION, option=rays, flags=flags, inputs=(distance, normal))


def bevel(radius, normal=NO_NORMAL, own=NO_NORMAL, rays=RAYS):
    return Node(NodeKind.BEVEL, option=rays, inputs=(radius, normal, own))


def as_color(node):
    """Return the node that moves the components of a normal, the result of the given node, to 0 to 1."""
    return Node(NodeKind.VECTOR_MATH, VectorOperation.MULTIPLY_ADD, inputs=(NodeRef(node), (0.5,) * 3, (0.5,) * 3))


def seen(materials, instances, meshes=(), at=(0.0, 0.0, 0.0), side=1.0, width=1e-6, samples=SAMPLES, **settings):
    """Return the mean colour of a place in the plane z = 0, from above or from below."""
    camera = pencil((at[0], at[1], side), at, width)
    return tiny.radiance(scene(instances, materials, meshes=meshes, camera=camera, samples=samples, **settings))


def beside_a_wall(place, reach):
    """Return the open share at a distance from an infinite wall, by rays of a reach: the disk without a segment."""
    c = min(place / reach, 1.0)
    return 1 - (math.acos(c) - c * math.sqrt(1 - c * c)) / math.pi


def wall(x=0.0, material=1, **fields):
    """Return an infinite plane across x that faces +x."""
    return plane(material, move(x) @ rotate_y(math.pi / 2), **fields)


BLACK = Material("black", lobes=())


# ---- Ambient Occlusion ----


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


def corner_mesh():
    """Return a floor z = 0 and a wall x = -0.5 as one mesh, each wide enough for rays of length 1."""
    floor = [(-0.5, -5, 0), (5, -5, 0), (5, 5, 0), (-0.5, 5, 0)]
    upright = [(-0.5, -5, 0), (-0.5, 5, 0), (-0.5, 5, 5), (-0.5, -5, 5)]
    return MeshData("corner", floor + upright, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])


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


# ---- Bevel ----


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


# ---- Raycast ----


def raycast(direction=(0.0, 0.0, 1.0), length=10.0, option=0, flags=0, position=FIRST):
    return Node(NodeKind.RAYCAST, option=option, flags=flags, inputs=(position, direction, length))


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


# ---- all of them ----


def _room(**settings):
    """Return a scene with all three nodes on meshes and exact surfaces, as colours and normals, behind lobes of all kinds."""
    snapshot = tiny.showroom(24, samples=4, **settings)
    nodes = (
        POSITION,
        occlusion(1.5, rays=3),
        bevel(0.2, rays=3),
        raycast((0.3, 0.2, 1.0), 4.0, position=NodeRef(0)),
        Node(NodeKind.VECTOR_MATH, VectorOperation.ADD, inputs=(NodeRef(1), NodeRef(3))),
    )

    def looking(number, material):
        color = NodeRef(4 if number else 1)
        lobes = tuple(dataclasses.replace(lobe, color=color, normal=NodeRef(2)) for lobe in material.lobes)
        return dataclasses.replace(material, nodes=nodes, lobes=lobes)

    materials = tuple(
        looking(number, material) if number in (0, 1, 5) else material for number, material in enumerate(snapshot.materials)
    )
    return dataclasses.replace(snapshot, materials=materials)


def _bits(snapshot, pieces=(4,)):
    with Session.upload(snapshot) as session:
        first = 0
        for count in pieces:
            session.render(first, count)
            while not session.wait(0.1).finished:
                pass
            first += count
        return {which.name: session.read(which).tobytes() for which in Pass}


@pytest.fixture(scope="module")
def alone():
    return _bits(_room(threads=1))


@pytest.mark.parametrize("settings", [
    {"threads": 2}, {"threads": 7, "tile_size": 5}, {"threads": 2, "tile_size": 1000}, {"features": Features.ALL},
    *({"accelerator": accelerator} for accelerator in Accelerator),
], ids=str)  # fmt: skip
def test_the_same_bits_however_the_work_is_divided(alone, settings):
    assert _bits(_room(**settings)) == alone


def test_the_same_bits_for_any_pieces(alone):
    assert _bits(_room(threads=2), (1, 3)) == alone


def test_looking_costs_nothing_where_nothing_looks(alone):
    """The rays have numbers of their own: nodes that look and change nothing leave the bits."""
    plain = tiny.showroom(24, samples=4)
    floor = dataclasses.replace(plain.materials[0], nodes=(occlusion(1.5, rays=3), bevel(0.2)))
    looking = dataclasses.replace(plain, materials=(floor, *plain.materials[1:]))
    assert _bits(looking) == _bits(plain) != alone
