"""The time that nodes take here: pictures of one square whose material evaluates them, on one thread.

The speed of this machine, compared with the reference machine of node_costs.py, is measured once, in less than a tenth of a
second.
"""

import functools
import math

import numpy as np

from ..bindings.abi import LancerError
from ..bindings.enums import Coordinate, NodeKind, NoiseFlag, NoiseKind, VectorOperation, VoronoiFeature
from ..bindings.session import Session
from ..bindings.shading import Material, Node, NodeRef
from ..bindings.snapshot import Camera, Instance, InstanceTable, MeshData, SceneSnapshot, Settings
from .node_costs import costs_of

_SIDE = 32  # pixels
_ROUNDS = 16
# A usual mix of textures and operations, behind texture coordinates.
_COORDINATES = (Node(NodeKind.COORDINATE, option=Coordinate.UV),)
_USUAL = (
    Node(NodeKind.NOISE, option=NoiseKind.FBM, flags=2 | NoiseFlag.NORMALIZED | NoiseFlag.REPEATS,
         inputs=(NodeRef(0), (0.0, 5.0, 0.0), (4.0, 0.5, 2.0), (0.0, 1.0, 0.0))),
    Node(NodeKind.VORONOI, option=VoronoiFeature.F1, flags=2,
         inputs=(NodeRef(1), (0.0, 5.0, 1.0), (0.0, 0.5, 2.0), (1.0, 0.5, 0.0))),
    Node(NodeKind.VECTOR_MATH, option=VectorOperation.SINE, inputs=(NodeRef(2), 0.0, 0.0, 1.0)),
)  # fmt: skip


def square(nodes, images=()):
    """Return the scene of a square, which fills the picture, whose emission is the last of the nodes."""
    corners = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    mesh = MeshData("square", corners, triangles, uvs=corners[triangles][..., :2] * 0.5 + 0.5)
    material = Material("nodes", lobes=(), emission=NodeRef(len(nodes) - 1), nodes=tuple(nodes))
    above = np.eye(4)
    above[2, 3] = 1.0
    return SceneSnapshot(
        meshes=(mesh,), materials=(material,), images=tuple(images),
        instances=InstanceTable.build([Instance(mesh=0, matrix=np.eye(4), materials=(0,), name="square")]),
        camera=Camera(above, width=_SIDE, height=_SIDE), settings=Settings(max_bounces=0, threads=1),
    )  # fmt: skip


def vertex_nanoseconds(session, first, samples):
    """Return the nanoseconds of a vertex of a square's samples, with all that the renderer does for it."""
    before = session.statistics().render_seconds
    session.render(first, samples)
    while not session.wait(0.05).finished:
        pass
    return (session.statistics().render_seconds - before) * 1e9 / (_SIDE * _SIDE * samples)


@functools.cache
def slowness():
    """Return how many times longer nodes take on this machine than on the reference machine; 1 if the core fails."""
    scene = square(_COORDINATES + _USUAL)
    plain = square(_COORDINATES)
    try:
        with Session.upload(scene) as session, Session.upload(plain) as base:
            least = [math.inf, math.inf]
            # Other work on the machine makes a round longer, never shorter: a short one of many is undisturbed.
            for sample in range(_ROUNDS):
                for which, of in enumerate((session, base)):
                    least[which] = min(least[which], vertex_nanoseconds(of, sample, 1))
    except LancerError:
        return 1.0
    known = sum(costs_of(scene.materials[0])) - sum(costs_of(plain.materials[0]))
    return max(least[0] - least[1], 0.1 * known) / known
