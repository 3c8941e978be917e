"""Base of the records of a snapshot: checked arrays and equality."""

import dataclasses
import math

import numpy as np

from .blocks import Blocks


def array(value, dtype, shape, what):
    """Return value as a read-only C-contiguous array; raise ValueError for another shape. None in shape is any length."""
    array = np.ascontiguousarray(value, dtype).view()
    got = array.shape
    # A scene may have a hundred thousand arrays.
    if got != shape and (
        len(got) != len(shape) or any(want not in (None, size) for want, size in zip(shape, got, strict=True))
    ):
        raise ValueError(f"{what} has shape {array.shape}, expected {shape}")
    array.setflags(write=False)
    return array


def same(a, b):
    if a is b:
        return True
    if isinstance(a, Blocks) and isinstance(b, Blocks):
        return a.equals(b)
    a, b = (np.asarray(value) if isinstance(value, Blocks) else value for value in (a, b))
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        if not (isinstance(a, np.ndarray) and isinstance(b, np.ndarray)):
            return False
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, float) and isinstance(b, float) and math.isnan(a):
        return math.isnan(b)
    return a == b


def bytes_of(*values):
    """Return the bytes of all arrays inside records, tuples and lists, each array counted once; without those in files."""
    return sum({id(array): array.nbytes for array in _arrays(values)}.values())


def _arrays(value):
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, (tuple, list)):
        for item in value:
            yield from _arrays(item)
    elif hasattr(value, "__dataclass_fields__"):
        yield from _arrays(tuple(vars(value).values()))


class Sets(int):
    """The type of fields that hold 64 bits; other whole numbers have 32."""


class Record:
    """A dataclass with equality of arrays by value."""

    __hash__ = None

    def __eq__(self, other):
        if type(self) is not type(other):
            return NotImplemented
        return all(same(getattr(self, f.name), getattr(other, f.name)) for f in dataclasses.fields(self))

    def replaced(self, **values):
        """Return a copy with other values, without checks: values must have the form that __post_init__ gives them."""
        copy = object.__new__(type(self))
        copy.__dict__.update(vars(self) | values)
        return copy

    def set(self, name, value):
        object.__setattr__(self, name, value)

    def vectors(self, **lengths):
        for name, length in lengths.items():
            value = tuple(float(x) for x in getattr(self, name))
            if len(value) != length:
                raise ValueError(f"{type(self).__name__}.{name} has {len(value)} values, expected {length}")
            self.set(name, value)
