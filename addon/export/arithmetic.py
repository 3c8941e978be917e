"""Arithmetic on scalars and triples: a scalar is a float, a colour or vector a tuple of three."""

import math

from ..bindings.shading import NodeRef

THIRDS = (1.0 / 3.0,) * 3  # the mean of three numbers is their dot product with these
_LARGEST = (2.0 - 2.0**-23) * 2.0**127


def triple(value):
    return value if isinstance(value, tuple) else (value,) * 3


def each(function, *values):
    return tuple(map(function, *map(triple, values)))


def single(value):
    """Clamp a constant to the range of the core's single precision; NaN becomes 0."""
    if isinstance(value, NodeRef):
        return value
    if isinstance(value, tuple):
        return tuple(map(single, value))
    return 0.0 if math.isnan(value) else min(max(value, -_LARGEST), _LARGEST)


def divide(a, b):
    return a / b if b != 0.0 else 0.0


def clamp(value, low=0.0, high=1.0):
    return min(max(value, low), high)


def mix(factor, a, b):
    return a + factor * (b - a)


def is_constant(value, number):
    """Whether a value is constant and equal to number in all channels."""
    return not isinstance(value, NodeRef) and all(x == number for x in triple(value))
