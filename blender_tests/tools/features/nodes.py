"""The nanoseconds that nodes take for one vertex, on one thread: measured here, and as the Material tab tells them.

The picture of a square whose material has several copies of a node is compared with that of one copy, in processor time. All
copies are summed, so that each is needed.
"""

import time

from addon.bindings.enums import (
    Coordinate,
    Interpolation,
    MathOperation,
    MixMode,
    NodeKind,
    NoiseFlag,
    NoiseKind,
    Projection,
    VectorOperation,
    VoronoiFeature,
    VoronoiFlag,
)
from addon.bindings.session import Session
from addon.bindings.shading import Node, NodeRef
from addon.measure.costs import median_with_uncertainty
from addon.measure.node_costs import nanoseconds
from addon.measure.node_speed import slowness, square

from .cases import checks

_UV = NodeRef(0)
_COPIES = 9
_RUN_SECONDS = 0.1
_NORMAL = (0.0, 0.0, 0.0)


def _of(kind, *inputs, **fields):
    return Node(kind, inputs=inputs, **fields)


def _noise(dimensions, detail=2.0, color=False, distortion=0.0):
    flags = dimensions - 1 | NoiseFlag.NORMALIZED | NoiseFlag.REPEATS | (NoiseFlag.COLOR if color else 0)
    inputs = _UV, (0.3, 5.0, distortion), (detail, 0.5, 2.0), (0.0, 1.0, 0.0)
    return _of(NodeKind.NOISE, *inputs, option=NoiseKind.FBM, flags=int(flags))


def _voronoi(dimensions, feature, color=False):
    inputs = _UV, (0.3, 5.0, 1.0), (0.0, 0.5, 2.0), (1.0, 0.5, 0.0)
    flags = dimensions - 1 | (VoronoiFlag.COLOR if color else 0)
    return _of(NodeKind.VORONOI, *inputs, option=feature, flags=int(flags))


NODES = {
    "add": _of(NodeKind.MATH, _UV, 0.5, 0.0, option=MathOperation.ADD),
    "sine": _of(NodeKind.MATH, _UV, 0.0, 0.0, option=MathOperation.SINE),
    "power": _of(NodeKind.MATH, _UV, 0.7, 0.0, option=MathOperation.POWER),
    "modulo": _of(NodeKind.MATH, _UV, 0.7, 0.0, option=MathOperation.MODULO),
    "multiply vectors": _of(NodeKind.VECTOR_MATH, _UV, (0.3, 0.4, 0.5), _NORMAL, 1.0, option=VectorOperation.MULTIPLY),
    "sine of vectors": _of(NodeKind.VECTOR_MATH, _UV, _NORMAL, _NORMAL, 1.0, option=VectorOperation.SINE),
    "mix": _of(NodeKind.MIX, 0.4, _UV, (0.3, 0.4, 0.5), option=MixMode.MIX),
    "mix hues": _of(NodeKind.MIX, 0.4, _UV, (0.3, 0.4, 0.5), option=MixMode.HUE),
    "gamma": _of(NodeKind.GAMMA, _UV, 0.7),
    "mapping": _of(NodeKind.MAPPING, _UV, _NORMAL, (0.1, 0.2, 0.3), (1.0, 2.0, 3.0)),
    "mapping by a linked angle": _of(NodeKind.MAPPING, _UV, _NORMAL, _UV, (1.0, 2.0, 3.0)),
    "UV map": _of(NodeKind.COORDINATE, option=Coordinate.UV),
    "object coordinates": _of(NodeKind.COORDINATE, option=Coordinate.OBJECT),
    "window coordinates": _of(NodeKind.COORDINATE, option=Coordinate.WINDOW),
    "normal map": _of(NodeKind.NORMAL_MAP, 1.0, _UV, _NORMAL),
    "facing": _of(NodeKind.LAYER_WEIGHT, 0.4, _NORMAL, option=1),
    "picture": _of(NodeKind.IMAGE, _UV, image_count=1),
    "picture, cubic": _of(NodeKind.IMAGE, _UV, image_count=1, flags=Interpolation.CUBIC << 4),
    "picture, box": _of(NodeKind.IMAGE, _UV, 0.2, image_count=1, option=Projection.BOX),
    "sky picture": _of(NodeKind.ENVIRONMENT, _UV, image_count=1),
    "wave": _of(NodeKind.WAVE, _UV, (5.0, 0.0, 0.0), _NORMAL),
    "wave, distorted": _of(NodeKind.WAVE, _UV, (5.0, 1.0, 0.0), (2.0, 1.0, 0.5)),
    "magic": _of(NodeKind.MAGIC, _UV, (5.0, 1.0, 0.0), option=2),
    "magic, 10 deep": _of(NodeKind.MAGIC, _UV, (5.0, 1.0, 0.0), option=10),
    "checker": _of(NodeKind.CHECKER, _UV, 5.0),
    "brick": _of(NodeKind.BRICK, _UV, (5.0, 0.02, 0.1), (0.0, 0.5, 0.25), (0.5, 1.0, 0.0), (2.0, 2.0, 0.0)),
    "white noise": _of(NodeKind.WHITE_NOISE, _UV, 0.5, flags=2),
    "Gabor": _of(NodeKind.GABOR, _UV, (5.0, 2.0, 1.0), (0.5, 0.0, 0.0)),
    "Gabor 3D": _of(NodeKind.GABOR, _UV, (5.0, 2.0, 1.0), (0.5, 0.0, 1.0), option=1),
    "radial tiling": _of(NodeKind.RADIAL_TILING, _UV, (5.0, 0.1, 0.0)),
    "noise 1D": _noise(1),
    "noise 2D": _noise(2),
    "noise 3D": _noise(3),
    "noise 4D": _noise(4),
    "noise 3D, detail 8": _noise(3, 8.0),
    "noise 3D, colours": _noise(3, color=True),
    "noise 3D, distorted": _noise(3, distortion=0.5),
    "Voronoi 1D": _voronoi(1, VoronoiFeature.F1),
    "Voronoi 2D": _voronoi(2, VoronoiFeature.F1),
    "Voronoi 3D": _voronoi(3, VoronoiFeature.F1),
    "Voronoi 3D, colours": _voronoi(3, VoronoiFeature.F1, True),
    "Voronoi 4D": _voronoi(4, VoronoiFeature.F1),
    "Voronoi 2D, smooth": _voronoi(2, VoronoiFeature.SMOOTH_F1),
    "Voronoi 3D, smooth": _voronoi(3, VoronoiFeature.SMOOTH_F1),
    "Voronoi 3D, edges": _voronoi(3, VoronoiFeature.DISTANCE_TO_EDGE),
}


def _copies(node, count):
    """Return the nodes of a program with that many copies of a node, and their sum as its last node."""
    nodes = [Node(NodeKind.COORDINATE, option=Coordinate.UV), *[node] * count]
    for number in range(count - 1):
        last = NodeRef(1 if number == 0 else len(nodes) - 1)
        total = (last, NodeRef(number + 2), _NORMAL, 1.0)
        nodes.append(Node(NodeKind.VECTOR_MATH, option=VectorOperation.ADD, inputs=total))
    return nodes


def _seconds(session, first, samples):
    start = time.process_time()
    session.render(first, samples)
    while not session.wait(1.0).finished:
        pass
    return time.process_time() - start


def measured(node, rounds=7):
    """Return the nanoseconds of one evaluation of a node, and their uncertainty."""
    one, many = (square(_copies(node, count), [checks()]) for count in (1, _COPIES))
    vertices = one.camera.region_width * one.camera.region_height
    sums = nanoseconds(_copies(node, 2)[-1]) * slowness()
    with Session.upload(one) as few, Session.upload(many) as more:
        # The first samples warm the caches.
        _seconds(few, 0, 4)
        samples = max(4, round(4 * _RUN_SECONDS / max(_seconds(more, 0, 4), 1e-6)))
        at, found = 4, []
        for _ in range(rounds):
            extra = _seconds(more, at, samples) - _seconds(few, at, samples)
            found.append(extra * 1e9 / (samples * vertices * (_COPIES - 1)) - sums)
            at += samples
    return median_with_uncertainty(found)


def measure(node):
    """Return the figures of a node for the page."""
    value, uncertainty = measured(node)
    return {"nanoseconds": value, "uncertainty": uncertainty, "told": nanoseconds(node) * slowness()}
