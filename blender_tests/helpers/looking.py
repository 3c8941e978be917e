"""Places from which nodes look around by rays, and the nodes: Ambient Occlusion, Bevel, Raycast."""

import math

import tiny_scenes as tiny
from tiny_scenes import move, pencil, plane, rotate_y, scene

from addon.bindings.enums import (
    Coordinate,
    MathOperation,
    NodeKind,
    VectorOperation,
)
from addon.bindings.shading import Material, Node, NodeRef
from addon.bindings.snapshot import MeshData

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


def raycast(direction=(0.0, 0.0, 1.0), length=10.0, option=0, flags=0, position=FIRST, **fields):
    return Node(NodeKind.RAYCAST, option=option, flags=flags, inputs=(position, direction, length), **fields)


def corner_mesh():
    """Return a floor z = 0 and a wall x = -0.5 as one mesh, each wide enough for rays of length 1."""
    floor = [(-0.5, -5, 0), (5, -5, 0), (5, 5, 0), (-0.5, 5, 0)]
    upright = [(-0.5, -5, 0), (-0.5, 5, 0), (-0.5, 5, 5), (-0.5, -5, 5)]
    return MeshData("corner", floor + upright, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
