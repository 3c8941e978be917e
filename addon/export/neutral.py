"""Operations that pass on an input, or give one number for every input: they need no node.

Each rule keeps the bits of every float: zeros of both signs, infinities and NaN. A number plus 0 is no rule, as it turns -0
into 0. Cycles leaves out more (cycles_folds.py).
"""

import math

from ..bindings.enums import Coordinate, MathOperation, NodeKind, NoiseFlag, ObjectFact, VectorOperation, VoronoiFlag
from ..bindings.shading import NodeRef
from .arithmetic import is_constant, triple
from .fold import gives_number

_NOWHERE = (0.0, 0.0, 0.0)
# Operations that change no result of their own.
_SETTLED = {MathOperation.ABSOLUTE, MathOperation.CEIL, MathOperation.FLOOR, MathOperation.SIGN, MathOperation.TRUNC}
_SETTLED_OF_VECTORS = {VectorOperation.ABSOLUTE, VectorOperation.CEIL, VectorOperation.FLOOR}
_NUMBERS = {
    NodeKind.CHECKER, NodeKind.FRESNEL, NodeKind.GRADIENT, NodeKind.IES, NodeKind.LAYER_WEIGHT, NodeKind.LIGHT_PATH,
    NodeKind.OCCLUSION, NodeKind.WAVE, NodeKind.WIREFRAME,
}  # fmt: skip
_FACTS = {ObjectFact.INDEX, ObjectFact.RANDOM}


def neutral(node, nodes):
    """Return the value of a snapshot.Node that needs no node; None if it needs one. nodes: those before it."""
    rule = _RULES.get(node.kind)
    return None if rule is None else rule(node, nodes)


def is_number(value, nodes):
    """Whether the result of a node, given by a NodeRef, is one number: equal in all channels."""
    node = nodes[value.node]
    if node.kind == NodeKind.COORDINATE:
        return node.option == Coordinate.BACKFACING
    if node.kind == NodeKind.OBJECT_INFO:
        return node.option in _FACTS
    if node.kind == NodeKind.NOISE:
        return not node.flags & NoiseFlag.COLOR
    if node.kind == NodeKind.VORONOI:
        return not node.flags & (VoronoiFlag.COLOR | VoronoiFlag.POSITION)
    return node.kind in _NUMBERS or gives_number(node)


def _math(node, nodes):
    if node.flags:
        return None
    m, (a, b, _) = MathOperation, node.inputs
    if node.option in (m.LESS_THAN, m.GREATER_THAN) and a == b or node.option == m.DIVIDE and is_constant(b, 0.0):
        return 0.0
    if node.option == m.POWER and is_constant(b, 0.0):
        return 1.0
    if _is_settled(node, nodes, _SETTLED) or node.option in (m.MINIMUM, m.MAXIMUM) and a == b:
        kept = a
    else:
        kept = _kept(node.option == m.SUBTRACT, node.option == m.MULTIPLY, node.option == m.DIVIDE, a, b)
    return None if kept is None else _as_number(kept, nodes)


def _vector_math(node, nodes):
    v, (a, b, _, scale) = VectorOperation, node.inputs
    if node.option == v.DIVIDE and is_constant(b, 0.0):
        return _NOWHERE
    if _is_settled(node, nodes, _SETTLED_OF_VECTORS) or node.option in (v.MINIMUM, v.MAXIMUM) and a == b:
        return a
    if node.option == v.SCALE:
        return a if is_constant(scale, 1.0) else None
    return _kept(node.option == v.SUBTRACT, node.option == v.MULTIPLY, node.option == v.DIVIDE, a, b)


def _kept(subtracts, multiplies, divides, a, b):
    """Return the input that a difference, product or quotient passes on, or None."""
    if subtracts and is_constant(b, 0.0) and all(math.copysign(1.0, x) > 0.0 for x in triple(b)):
        return a
    if (multiplies or divides) and is_constant(b, 1.0):
        return a
    return b if multiplies and is_constant(a, 1.0) else None


def _is_settled(node, nodes, operations):
    """Whether a node repeats the operation of its input, to no effect."""
    before = _before(node.inputs[0], nodes)
    same = before is not None and (before.kind, before.option, before.flags) == (node.kind, node.option, node.flags)
    return same and node.option in operations


def _clamp(node, nodes):
    before = _before(node.inputs[0], nodes)
    # Their text tells 0 and -0 apart.
    same = before is not None and before.kind == node.kind and repr(before.inputs[1:]) == repr(node.inputs[1:])
    return node.inputs[0] if same else None


def _separate(node, nodes):
    number, before = _as_number(node.inputs[0], nodes), _before(node.inputs[0], nodes)
    if number is not None or before.kind != NodeKind.COMBINE:
        return number
    return _as_number(before.inputs[node.option], nodes)


def _combine(node, nodes):
    first, *others = node.inputs
    if isinstance(first, NodeRef) and all(other == first for other in others) and is_number(first, nodes):
        return first
    parts = [_before(value, nodes) for value in node.inputs]
    if any(part is None or part.kind != NodeKind.SEPARATE for part in parts):
        return None
    whole = [part.inputs[0] for part in parts]
    return whole[0] if [part.option for part in parts] == [0, 1, 2] and whole[0] == whole[1] == whole[2] else None


def _gamma(node, nodes):
    return (1.0, 1.0, 1.0) if is_constant(node.inputs[1], 0.0) else None


def _as_number(value, nodes):
    """Return the number that a node reads from a value; None if the value's result has channels of its own."""
    if not isinstance(value, NodeRef):
        return triple(value)[0]
    return value if is_number(value, nodes) else None


def _before(value, nodes):
    return nodes[value.node] if isinstance(value, NodeRef) else None


_RULES = {
    NodeKind.CLAMP: _clamp,
    NodeKind.COMBINE: _combine,
    NodeKind.GAMMA: _gamma,
    NodeKind.MATH: _math,
    NodeKind.SEPARATE: _separate,
    NodeKind.VECTOR_MATH: _vector_math,
}
