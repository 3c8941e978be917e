"""The mathematics of nodes on constants: what the core computes for each ray, done once where nothing varies.

Scalars are floats, colours and vectors are tuples of three. Every function takes (node, inputs) and gives a value.
"""

import math

from ..bindings.enums import MappingType, MathOperation, NodeKind, VectorOperation
from .arithmetic import clamp, divide, each, fraction, mix, scalar, triple
from .fold_colors import fold_mix

_SMALLEST_DIFFERENCE = 2.0**-23  # of two single precision numbers about 1, which COMPARE always forgives


def _power(a, b):
    if a < 0.0 and b != math.floor(b):
        return 0.0
    if a == 0.0:
        return 1.0 if b == 0.0 else 0.0
    return a**b


def _logarithm(a, base):
    return divide(math.log(a), math.log(base)) if a > 0.0 and base > 0.0 else 0.0


def _smooth_minimum(a, b, distance):
    if distance == 0.0:
        return min(a, b)
    h = max(distance - abs(a - b), 0.0) / distance
    return min(a, b) - h**3 * distance / 6.0


def _wrap(value, high, low):
    span = high - low
    return value - span * math.floor((value - low) / span) if span != 0.0 else low


def _pingpong(a, b):
    return abs(fraction((a - b) / (b * 2.0)) * b * 2.0 - b) if b != 0.0 else 0.0


def _modulo(a, b):
    return math.fmod(a, b) if b != 0.0 else 0.0


def _sign(a):
    return (a > 0.0) - (a < 0.0) + 0.0


_MATH = {
    MathOperation.ADD: lambda a, b, c: a + b,
    MathOperation.SUBTRACT: lambda a, b, c: a - b,
    MathOperation.MULTIPLY: lambda a, b, c: a * b,
    MathOperation.DIVIDE: lambda a, b, c: divide(a, b),
    MathOperation.MULTIPLY_ADD: lambda a, b, c: a * b + c,
    MathOperation.POWER: lambda a, b, c: _power(a, b),
    MathOperation.LOGARITHM: lambda a, b, c: _logarithm(a, b),
    MathOperation.SQRT: lambda a, b, c: math.sqrt(max(a, 0.0)),
    MathOperation.INVERSE_SQRT: lambda a, b, c: 1.0 / math.sqrt(a) if a > 0.0 else 0.0,
    MathOperation.ABSOLUTE: lambda a, b, c: abs(a),
    MathOperation.EXPONENT: lambda a, b, c: math.exp(a),
    MathOperation.MINIMUM: lambda a, b, c: min(a, b),
    MathOperation.MAXIMUM: lambda a, b, c: max(a, b),
    MathOperation.LESS_THAN: lambda a, b, c: float(a < b),
    MathOperation.GREATER_THAN: lambda a, b, c: float(a > b),
    MathOperation.SIGN: lambda a, b, c: _sign(a),
    MathOperation.COMPARE: lambda a, b, c: float(a == b or abs(a - b) <= max(c, _SMALLEST_DIFFERENCE)),
    MathOperation.SMOOTH_MIN: _smooth_minimum,
    MathOperation.SMOOTH_MAX: lambda a, b, c: -_smooth_minimum(-a, -b, c),
    MathOperation.ROUND: lambda a, b, c: math.floor(a + 0.5) + 0.0,
    MathOperation.FLOOR: lambda a, b, c: math.floor(a) + 0.0,
    MathOperation.CEIL: lambda a, b, c: math.ceil(a) + 0.0,
    MathOperation.TRUNC: lambda a, b, c: math.trunc(a) + 0.0,
    MathOperation.FRACT: lambda a, b, c: fraction(a),
    MathOperation.MODULO: lambda a, b, c: _modulo(a, b),
    MathOperation.FLOORED_MODULO: lambda a, b, c: a - math.floor(a / b) * b if b != 0.0 else 0.0,
    MathOperation.WRAP: _wrap,
    MathOperation.SNAP: lambda a, b, c: math.floor(divide(a, b)) * b,
    MathOperation.PINGPONG: lambda a, b, c: _pingpong(a, b),
    MathOperation.SINE: lambda a, b, c: math.sin(a),
    MathOperation.COSINE: lambda a, b, c: math.cos(a),
    MathOperation.TANGENT: lambda a, b, c: math.tan(a),
    MathOperation.ARCSINE: lambda a, b, c: math.asin(clamp(a, -1.0, 1.0)),
    MathOperation.ARCCOSINE: lambda a, b, c: math.acos(clamp(a, -1.0, 1.0)),
    MathOperation.ARCTANGENT: lambda a, b, c: math.atan(a),
    MathOperation.ARCTAN2: lambda a, b, c: math.atan2(a, b) if a != 0.0 or b != 0.0 else 0.0,
    MathOperation.SINH: lambda a, b, c: math.sinh(a),
    MathOperation.COSH: lambda a, b, c: math.cosh(a),
    MathOperation.TANH: lambda a, b, c: math.tanh(a),
    MathOperation.RADIANS: lambda a, b, c: math.radians(a),
    MathOperation.DEGREES: lambda a, b, c: math.degrees(a),
}


def _fold_math(node, inputs):
    a, b, c = (scalar(value) for value in inputs)
    result = _MATH[node.option](a, b, c)
    return clamp(result) if node.flags & 1 else result


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def length(a):
    return math.sqrt(dot(a, a))


def normalized(a):
    size = length(a)
    return tuple(x / size for x in a) if size > 0.0 else a


def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _project(a, b):
    share = divide(dot(a, b), dot(b, b))
    return tuple(share * x for x in b)


def _reflect(a, b):
    n = normalized(b)
    return tuple(x - 2.0 * dot(a, n) * y for x, y in zip(a, n, strict=True))


_VECTOR = {
    VectorOperation.ADD: lambda a, b, c, s: each(lambda x, y: x + y, a, b),
    VectorOperation.SUBTRACT: lambda a, b, c, s: each(lambda x, y: x - y, a, b),
    VectorOperation.MULTIPLY: lambda a, b, c, s: each(lambda x, y: x * y, a, b),
    VectorOperation.DIVIDE: lambda a, b, c, s: each(divide, a, b),
    VectorOperation.MULTIPLY_ADD: lambda a, b, c, s: each(lambda x, y, z: x * y + z, a, b, c),
    VectorOperation.CROSS_PRODUCT: lambda a, b, c, s: _cross(a, b),
    VectorOperation.PROJECT: lambda a, b, c, s: _project(a, b),
    VectorOperation.REFLECT: lambda a, b, c, s: _reflect(a, b),
    VectorOperation.DOT_PRODUCT: lambda a, b, c, s: dot(a, b),
    VectorOperation.DISTANCE: lambda a, b, c, s: math.dist(a, b),
    VectorOperation.LENGTH: lambda a, b, c, s: length(a),
    VectorOperation.SCALE: lambda a, b, c, s: each(lambda x: x * s, a),
    VectorOperation.NORMALIZE: lambda a, b, c, s: normalized(a),
    VectorOperation.ABSOLUTE: lambda a, b, c, s: each(abs, a),
    VectorOperation.MINIMUM: lambda a, b, c, s: each(min, a, b),
    VectorOperation.MAXIMUM: lambda a, b, c, s: each(max, a, b),
    VectorOperation.FLOOR: lambda a, b, c, s: each(lambda x: math.floor(x) + 0.0, a),
    VectorOperation.CEIL: lambda a, b, c, s: each(lambda x: math.ceil(x) + 0.0, a),
    VectorOperation.FRACTION: lambda a, b, c, s: each(fraction, a),
    VectorOperation.MODULO: lambda a, b, c, s: each(_modulo, a, b),
    VectorOperation.SNAP: lambda a, b, c, s: each(lambda x, y: math.floor(divide(x, y)) * y, a, b),
    VectorOperation.SINE: lambda a, b, c, s: each(math.sin, a),
    VectorOperation.COSINE: lambda a, b, c, s: each(math.cos, a),
    VectorOperation.TANGENT: lambda a, b, c, s: each(math.tan, a),
}


def _fold_vector_math(node, inputs):
    a, b, c, s = inputs
    return _VECTOR[node.option](triple(a), triple(b), triple(c), scalar(s))


def rotation(angles):
    """Rows of the matrix of Euler angles in the order X, Y, Z."""
    (cx, cy, cz), (sx, sy, sz) = (each(f, angles) for f in (math.cos, math.sin))
    return (
        (cy * cz, sy * sx * cz - cx * sz, sy * cx * cz + sx * sz),
        (cy * sz, sy * sx * sz + cx * cz, sy * cx * sz - sx * cz),
        (-sy, cy * sx, cy * cx),
    )


def _fold_mapping(node, inputs):
    vector, location, angles, scale = map(triple, inputs)
    rows = rotation(angles)
    if node.option == MappingType.TEXTURE:
        moved = each(lambda x, y: x - y, vector, location)
        return each(divide, tuple(dot(column, moved) for column in zip(*rows, strict=True)), scale)
    if node.option == MappingType.NORMAL:
        scaled = each(divide, vector, scale)
        return normalized(tuple(dot(row, scaled) for row in rows))
    scaled = each(lambda x, y: x * y, vector, scale)
    turned = tuple(dot(row, scaled) for row in rows)
    return each(lambda x, y: x + y, turned, location) if node.option == MappingType.POINT else turned


def _fold_gamma(node, inputs):
    color, exponent = triple(inputs[0]), scalar(inputs[1])
    return each(lambda x: x**exponent if x > 0.0 else x, color) if exponent != 0.0 else (1.0, 1.0, 1.0)


def _fold_clamp(node, inputs):
    value, low, high = map(scalar, inputs)
    return clamp(value, low, high)


def _fold_invert(node, inputs):
    factor = scalar(inputs[0])
    return each(lambda x: mix(factor, x, 1.0 - x), inputs[1])


_NUMBERS = {NodeKind.MATH, NodeKind.SEPARATE, NodeKind.GREY, NodeKind.CLAMP, NodeKind.ALPHA}
_MEASURES = {VectorOperation.DOT_PRODUCT, VectorOperation.DISTANCE, VectorOperation.LENGTH}


def gives_number(node):
    """Whether a node's result is one number and not three."""
    return node.kind in _NUMBERS or node.kind == NodeKind.VECTOR_MATH and node.option in _MEASURES


FOLD = {
    NodeKind.MATH: _fold_math,
    NodeKind.VECTOR_MATH: _fold_vector_math,
    NodeKind.MIX: fold_mix,
    NodeKind.SEPARATE: lambda node, inputs: triple(inputs[0])[node.option],
    NodeKind.COMBINE: lambda node, inputs: tuple(map(scalar, inputs)),
    NodeKind.GREY: lambda node, inputs: dot(node.matrix[:3], triple(inputs[0])),
    NodeKind.CLAMP: _fold_clamp,
    NodeKind.GAMMA: _fold_gamma,
    NodeKind.INVERT: _fold_invert,
    NodeKind.MAPPING: _fold_mapping,
    NodeKind.ALPHA: lambda node, inputs: 1.0,
}
