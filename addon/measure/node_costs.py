"""Nanoseconds that the core's nodes take for one vertex, in lanes, on the reference machine.

Measured by `make features` (blender_tests/tools/features/nodes.py) on one thread of an AMD EPYC with AVX-512. Linked detail
counts as the default. node_speed.py compares this machine with the reference.
"""

from ..bindings.enums import (
    ColorModel,
    Coordinate,
    GradientKind,
    Interpolation,
    MathOperation,
    MixMode,
    NodeKind,
    NoiseFlag,
    Projection,
    VectorOperation,
    VoronoiFeature,
    VoronoiFlag,
    VoronoiMetric,
)
from ..bindings.parameters import parameters
from ..bindings.shading import NodeRef

_SIMPLE = 2.0  # a few instructions
_WAVES = 18.0  # a function by a polynomial, as the sine
_HEIGHTS = 3  # evaluations of a bump's height
_RAY = 250.0  # a ray of a node that looks around, in a scene of a hundred thousand triangles
_DETAIL = 2.0  # of textures whose detail is linked

_MATHS = {
    **dict.fromkeys((MathOperation.SINE, MathOperation.COSINE, MathOperation.TANGENT, MathOperation.ARCSINE), _WAVES),
    **dict.fromkeys((MathOperation.ARCCOSINE, MathOperation.ARCTANGENT, MathOperation.ARCTAN2, MathOperation.SINH), _WAVES),
    **dict.fromkeys((MathOperation.COSH, MathOperation.TANH, MathOperation.LOGARITHM), _WAVES),
    MathOperation.EXPONENT: 5.0,
    MathOperation.MODULO: 12.0,
    MathOperation.POWER: 35.0,
}
_VECTORS = {
    **dict.fromkeys((VectorOperation.SINE, VectorOperation.COSINE, VectorOperation.TANGENT), 43.0),
    VectorOperation.MODULO: 22.0,
}
_MIXES = {MixMode.HUE: 6.0, MixMode.SATURATION: 8.0, MixMode.COLOR: 6.0, MixMode.VALUE: 6.0}
_COORDINATES = {
    **dict.fromkeys((Coordinate.GENERATED, Coordinate.UV, Coordinate.CAMERA, Coordinate.FROM_CAMERA), 16.0),
    **dict.fromkeys((Coordinate.EDGE_U, Coordinate.EDGE_V), 11.0),
    Coordinate.WINDOW: 30.0,
}
_GRADIENTS = {GradientKind.RADIAL: _WAVES}
_LOOK_UPS = {Interpolation.LINEAR: 15.0, Interpolation.CLOSEST: 10.0, Interpolation.CUBIC: 35.0}
_VOXELS = {Interpolation.LINEAR: 30.0, Interpolation.CLOSEST: 7.0, Interpolation.CUBIC: 150.0}
# By the number of dimensions: for the texture, and for each of its octaves.
_NOISE = ((5.0, 3.5), (6.0, 6.8), (10.0, 14.5), (12.0, 42.0))
# Costs of Voronoi cells, by the number of dimensions.
_CELLS = {
    VoronoiFeature.F1: (10.0, 35.0, 150.0, 710.0),
    VoronoiFeature.F2: (10.0, 36.0, 155.0, 800.0),
    VoronoiFeature.SMOOTH_F1: (20.0, 220.0, 1270.0, 9600.0),
    VoronoiFeature.DISTANCE_TO_EDGE: (6.0, 53.0, 250.0, 1280.0),
    VoronoiFeature.N_SPHERE_RADIUS: (10.0, 50.0, 240.0, 1230.0),
}
# Kinds whose cost hardly depends on their options and inputs.
_KINDS = {
    NodeKind.ATTRIBUTE: 16.0,
    NodeKind.BRICK: 8.0,
    NodeKind.CHECKER: 5.0,
    NodeKind.CURVES: 12.0,
    NodeKind.DISPLACEMENT: 5.0,
    NodeKind.ENVIRONMENT: 30.0,
    NodeKind.GAMMA: 75.0,
    NodeKind.IES: 40.0,
    NodeKind.NORMAL_MAP: 55.0,
    NodeKind.RADIAL_TILING: 370.0,
    NodeKind.RAYCAST: _RAY,
    NodeKind.SKY: 90.0,
    NodeKind.TANGENT: 28.0,
    NodeKind.VECTOR_TRANSFORM: 4.0,
    NodeKind.WHITE_NOISE: 4.0,
    NodeKind.WIREFRAME: 18.0,
}


def nanoseconds(node):
    """Return what one evaluation of a snapshot.Node takes; of a bump, without its height."""
    rule = _RULES.get(node.kind)
    return _KINDS.get(node.kind, _SIMPLE) if rule is None else rule(node)


def costs_of(material):
    """Return the nanoseconds that each node of a material takes for a vertex; 0 for those that displacement alone reads."""
    shading = [value for _, name, value in parameters(material) if name != "displacement"]
    return [times * nanoseconds(node) for times, node in zip(_runs(material.nodes, shading), material.nodes, strict=True)]


def _runs(nodes, values):
    """Return how often each node runs for a vertex, as the core schedules them: a bump runs its height's nodes itself."""
    needed, in_heights = {value.node for value in values if isinstance(value, NodeRef)}, [0] * len(nodes)
    # Nodes refer to earlier ones only: going backward visits every reader of a node before the node.
    for number in reversed(range(len(nodes))):
        if number not in needed:
            continue
        inputs = [*nodes[number].inputs]
        if nodes[number].kind == NodeKind.BUMP:
            inside = _height_nodes(nodes, number)
            inputs = [value for inner in (number, *inside) for value in nodes[inner].inputs]
            inputs = [value for value in inputs if isinstance(value, NodeRef) and value.node not in inside]
            for inner in inside:
                in_heights[inner] += _HEIGHTS
        needed.update(value.node for value in inputs if isinstance(value, NodeRef))
    return [(number in needed) + times for number, times in enumerate(in_heights)]


def _height_nodes(nodes, bump):
    """Return the nodes that a bump runs for its height: those from its first one on that the height depends on."""
    found, open_ = set(), [nodes[bump].inputs[2]]
    while open_:
        value = open_.pop()
        if isinstance(value, NodeRef) and value.node >= nodes[bump].first and value.node not in found:
            found.add(value.node)
            inner = nodes[value.node]
            # A bump inside a height passes on its normal.
            open_.extend(inner.inputs[3:4] if inner.kind == NodeKind.BUMP else inner.inputs)
    return found


def _math(node):
    return _MATHS.get(node.option, _SIMPLE)


def _vector_math(node):
    return _VECTORS.get(node.option, _SIMPLE)


def _mix(node):
    return _MIXES.get(node.option, 4.0)


def _model(node):
    return 4.0 if node.option in (ColorModel.TO_HSL, ColorModel.FROM_HSL) else 2.0


def _coordinate(node):
    return _COORDINATES.get(node.option, _SIMPLE)


def _gradient(node):
    return _GRADIENTS.get(node.option, _SIMPLE)


def _mapping(node):
    return 72.0 if isinstance(node.inputs[2], NodeRef) else 11.0


def _layer_weight(node):
    return 4.0 if node.option == 0 else 33.0


def _octaves(packed):
    """Return the octaves of a texture; packed: the input whose first number is its detail."""
    return 1.0 + min(max(_number(packed, 0, _DETAIL), 0.0), 15.0)


def _number(packed, channel, default):
    """Return one of the numbers of an input; default if it varies."""
    if isinstance(packed, NodeRef):
        return default
    return packed[channel] if isinstance(packed, tuple) else packed


def _noise(node):
    base, octave = _NOISE[node.flags & 3]
    channels = 3.0 if node.flags & NoiseFlag.COLOR else 1.0
    # Distortion moves each coordinate by noise of one octave.
    moved = octave * (1 + (node.flags & 3)) if _number(node.inputs[1], 2, 1.0) else 0.0
    return channels * (base + octave * _octaves(node.inputs[2])) + moved


def _wave(node):
    base, octave = _NOISE[2]
    return _WAVES + (base + octave * _octaves(node.inputs[2]) if _number(node.inputs[1], 1, 1.0) else 0.0)


def _voronoi(node):
    cells = _CELLS[node.option][node.flags & 3] * _octaves(node.inputs[2])
    if node.flags & (VoronoiFlag.COLOR | VoronoiFlag.POSITION):
        cells *= 1.1
    # The power of each distance.
    return cells * (4.0 if node.flags >> 2 & 3 == VoronoiMetric.MINKOWSKI and node.flags & 3 else 1.0)


def _magic(node):
    return 70.0 + 16.0 * node.option


def _gabor(node):
    return 3700.0 if node.option else 1400.0


def _image(node):
    once = _LOOK_UPS.get(node.flags >> 4 & 15, 0.0)
    return once * (1.5 if node.option == Projection.BOX else 1.0)


def _voxels(node):
    return _VOXELS.get(node.option, 0.0)


def _looking(node):
    return _RAY * max(node.option, 1)


_RULES = {
    NodeKind.BEVEL: _looking,
    NodeKind.COLOR_MODEL: _model,
    NodeKind.COORDINATE: _coordinate,
    NodeKind.GABOR: _gabor,
    NodeKind.GRADIENT: _gradient,
    NodeKind.IMAGE: _image,
    NodeKind.LAYER_WEIGHT: _layer_weight,
    NodeKind.MAGIC: _magic,
    NodeKind.MAPPING: _mapping,
    NodeKind.MATH: _math,
    NodeKind.MIX: _mix,
    NodeKind.NOISE: _noise,
    NodeKind.OCCLUSION: _looking,
    NodeKind.VECTOR_MATH: _vector_math,
    NodeKind.VORONOI: _voronoi,
    NodeKind.VOXELS: _voxels,
    NodeKind.WAVE: _wave,
}
