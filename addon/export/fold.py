"""Nodes of constants are computed once, when they are exported, by the core's own formulas."""

from ..bindings.enums import NodeKind, VectorOperation
from ..bindings.nodes import evaluate

# What asks nothing of a place: a node of constants of these kinds is a constant.
FOLDED = {
    NodeKind.ALPHA, NodeKind.CLAMP, NodeKind.COLOR_MODEL, NodeKind.COMBINE, NodeKind.GAMMA, NodeKind.GREY, NodeKind.INVERT,
    NodeKind.MAPPING, NodeKind.MATH, NodeKind.MIX, NodeKind.SEPARATE, NodeKind.VECTOR_MATH,
}  # fmt: skip
_NUMBERS = {NodeKind.MATH, NodeKind.SEPARATE, NodeKind.GREY, NodeKind.CLAMP, NodeKind.ALPHA}
_MEASURES = {VectorOperation.DOT_PRODUCT, VectorOperation.DISTANCE, VectorOperation.LENGTH}


def gives_number(node):
    """Whether a node's result is one number and not three."""
    return node.kind in _NUMBERS or node.kind == NodeKind.VECTOR_MATH and node.option in _MEASURES


def fold(node):
    """The value of a snapshot.Node of constants: a float, or a tuple of three; not finite where its mathematics is not."""
    value = evaluate(node)
    return value[0] if gives_number(node) else value[:3]
