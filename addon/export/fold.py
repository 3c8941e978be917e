"""Constant folding: the export evaluates nodes whose inputs are constant, with the core's own formulas."""

from ..bindings.enums import NodeKind, VectorOperation
from ..bindings.nodes import evaluate

# Kinds whose result depends on the inputs alone and is constant if the inputs are constant.
FOLDED = {
    NodeKind.ALPHA, NodeKind.CLAMP, NodeKind.COLOR_MODEL, NodeKind.COMBINE, NodeKind.GAMMA, NodeKind.GREY, NodeKind.INVERT,
    NodeKind.MAPPING, NodeKind.MATH, NodeKind.MIX, NodeKind.SEPARATE, NodeKind.VECTOR_MATH,
}  # fmt: skip
_NUMBERS = {NodeKind.MATH, NodeKind.SEPARATE, NodeKind.GREY, NodeKind.CLAMP, NodeKind.ALPHA}
_MEASURES = {VectorOperation.DOT_PRODUCT, VectorOperation.DISTANCE, VectorOperation.LENGTH}


def gives_number(node):
    """Whether a node's result is one number instead of three."""
    return node.kind in _NUMBERS or node.kind == NodeKind.VECTOR_MATH and node.option in _MEASURES


def fold(node):
    """Return the value of a snapshot.Node with constant inputs: a float or a tuple of three, which may not be finite."""
    value = evaluate(node)
    return value[0] if gives_number(node) else value[:3]
