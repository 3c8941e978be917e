"""What Cycles leaves out of Math, Vector Math and Mix nodes with one constant input: it bypasses them or takes a constant.

neutral.py keeps the bits of every float. These rules also hold for every finite number, but a zero may change its sign, and 0
times infinity is 0: as in Cycles' picture.
"""

from ..bindings.enums import MathOperation, MixMode, VectorOperation
from ..bindings.shading import NodeRef
from .arithmetic import is_constant

_NOWHERE = (0.0, 0.0, 0.0)
# First operands that leave the second one as it is.
_NEUTRAL = {MathOperation.ADD: 0.0, MathOperation.MULTIPLY: 1.0}
_NEUTRAL_COLORS = {MixMode.ADD: 0.0, MixMode.MULTIPLY: 1.0}
# Modes that give the first colour exactly where the factor is 0, of those that Cycles then bypasses.
_KEEP_FIRST = {
    MixMode.MIX, MixMode.DARKEN, MixMode.MULTIPLY, MixMode.ADD, MixMode.SUBTRACT, MixMode.DIFFERENCE, MixMode.DIVIDE,
    MixMode.SOFT_LIGHT, MixMode.LINEAR_LIGHT, MixMode.HUE, MixMode.COLOR,
}  # fmt: skip


def of_math(operation, a, b):
    """Return the value of a Math node of which one input is constant; None if it needs a node."""
    m = MathOperation
    if not _varies(a, b):
        return None
    if operation == m.POWER and (is_constant(a, 1.0) or is_constant(b, 0.0)):
        return 1.0
    nothing = operation == m.MULTIPLY and (is_constant(a, 0.0) or is_constant(b, 0.0))
    if nothing or operation == m.DIVIDE and is_constant(a, 0.0):
        return 0.0
    if operation in (m.ADD, m.SUBTRACT) and is_constant(b, 0.0):
        return a
    if operation in (m.MULTIPLY, m.DIVIDE, m.POWER) and is_constant(b, 1.0):
        return a
    return b if operation in _NEUTRAL and is_constant(a, _NEUTRAL[operation]) else None


def of_vector_math(operation, a, b, scale):
    """Return the value of a Vector Math node of which one input is constant; None if it needs a node."""
    v = VectorOperation
    if operation == v.SCALE:
        b = scale
    if not _varies(a, b):
        return None
    if operation in (v.ADD, v.SUBTRACT) and is_constant(b, 0.0):
        return a
    if operation == v.ADD and is_constant(a, 0.0):
        return b
    is_nothing = is_constant(a, 0.0) or is_constant(b, 0.0)
    if is_nothing and operation == v.DOT_PRODUCT:
        return 0.0
    if is_nothing and operation in (v.MULTIPLY, v.DIVIDE, v.CROSS_PRODUCT, v.SCALE):
        return _NOWHERE
    return None


def first_of_mix(mode, factor):
    """Whether a mix of colours with this factor is the first one."""
    return is_constant(factor, 0.0) and mode in _KEEP_FIRST


def of_mix(mode, factor, a, b):
    """Return the value of a mix of colours, not clamped, of which one input is constant; None if it needs a node."""
    m, whole = MixMode, is_constant(factor, 1.0)
    if first_of_mix(mode, factor) or mode in (m.ADD, m.SUBTRACT) and is_constant(b, 0.0):
        return a
    if mode in (m.MULTIPLY, m.DIVIDE) and is_constant(a, 0.0) or whole and mode == m.MULTIPLY and is_constant(b, 0.0):
        return _NOWHERE
    if whole and mode in (m.MULTIPLY, m.DIVIDE) and is_constant(b, 1.0):
        return a
    keeps_second = mode == m.MIX or mode in _NEUTRAL_COLORS and is_constant(a, _NEUTRAL_COLORS[mode])
    return b if whole and keeps_second else None


def _varies(*values):
    return any(isinstance(value, NodeRef) for value in values)
