"""Values that Blender 3's Cycles takes as they are and newer ones clamp or normalise: reported where nodes may give them."""

from ..bindings.enums import Coordinate, NodeKind, Rules, VectorOperation
from ..bindings.shading import NodeRef
from .sockets import RULES

_APPLIES = RULES == Rules.BLENDER_3
# Kinds whose results lie within 0 to 1, but for images of high range.
_WITHIN = {
    NodeKind.IMAGE, NodeKind.ENVIRONMENT, NodeKind.ALPHA, NodeKind.FRESNEL, NodeKind.LAYER_WEIGHT, NodeKind.CLAMP,
    NodeKind.NOISE, NodeKind.VORONOI, NodeKind.GRADIENT, NodeKind.CURVES, NodeKind.INVERT, NodeKind.GREY,
}  # fmt: skip
_CLAMPED = {NodeKind.MATH: 1, NodeKind.MIX: 2}  # the flag that clamps
_UNIT = {NodeKind.NORMAL_MAP, NodeKind.BUMP, NodeKind.TANGENT}
_UNIT_COORDINATES = {
    Coordinate.NORMAL, Coordinate.SHADING_NORMAL, Coordinate.TRUE_NORMAL, Coordinate.INCOMING, Coordinate.REFLECTION,
}  # fmt: skip
_SLACK = 1e-3


def tell_range(graph, site, name, value):
    """Add a message if a value beyond 0 to 1 may reach an input that Blender 3 does not clamp."""
    if not (_APPLIES and isinstance(value, NodeRef)):
        return
    node = graph.nodes[value.node]
    if node.kind in _WITHIN and not _is_density(graph, node) or node.flags & _CLAMPED.get(node.kind, 0):
        return
    graph.tell(site, f"input '{name}' is clamped to 0 to 1, which Cycles 3 does not do")


def _is_density(graph, node):
    """Whether the alpha that a node gives is that of voxels, which has no upper bound."""
    return node.kind == NodeKind.ALPHA and graph.nodes[node.inputs[0].node].kind == NodeKind.VOXELS


def tell_length(graph, site, normal):
    """Add a message if a normal may not be of unit length, with which Blender 3 scales the light."""
    if _APPLIES and not _is_unit(graph, normal):
        graph.tell(site, "its normal is taken as a direction, while Cycles 3 scales the light by its length")


def _is_unit(graph, normal):
    if not isinstance(normal, NodeRef):
        square = sum(x * x for x in normal)
        return square == 0.0 or abs(square - 1.0) < _SLACK
    node = graph.nodes[normal.node]
    if node.kind == NodeKind.COORDINATE:
        return node.option in _UNIT_COORDINATES
    return node.kind in _UNIT or (node.kind == NodeKind.VECTOR_MATH and node.option == VectorOperation.NORMALIZE)
