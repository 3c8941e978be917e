"""Trees of registered dataclasses to and from one .npz without pickle: the arrays as they are, the rest as JSON beside them.

A file may come from anywhere: whatever is in it, load_npz gives records whose fields have the types that their classes name, or
raises SnapshotError. A file that cannot be opened is an OSError, as everywhere.
"""

import dataclasses
import functools
import json
import os
import sys
import typing

import numpy as np

_TYPES = {}
_TREE = "tree"
# The library's numbers have 32 bits; what is larger would come out as another number there.
_LARGEST = 2**32 - 1


class SnapshotError(ValueError):
    """A file that holds no snapshot, or a broken one; says which file, and what is wrong with it."""


def register(cls):
    """Class decorator: this dataclass may be saved and loaded."""
    _TYPES[cls.__name__] = cls
    return cls


def save_npz(record, path):
    arrays = {}

    def encode(value):
        if isinstance(value, np.ndarray):
            key = f"array_{len(arrays)}"
            arrays[key] = value
            return {"array": key}
        if dataclasses.is_dataclass(value):
            fields = {f.name: encode(getattr(value, f.name)) for f in dataclasses.fields(value)}
            return {"type": type(value).__name__, "fields": fields}
        if isinstance(value, tuple):
            return [encode(item) for item in value]
        if isinstance(value, np.generic):
            return value.item()
        return value

    tree = json.dumps(encode(record)).encode("utf-8")
    with open(os.fspath(path), "wb") as file:
        np.savez(file, **{_TREE: np.frombuffer(tree, np.uint8)}, **arrays)


def load_npz(path):
    path = os.fspath(path)
    with open(path, "rb") as file:
        try:
            return _read(file)
        except Exception as error:
            # A damaged file can fail anywhere: in the archive, in an array's header, in the tree, in a record.
            reason = "it holds no tree of records" if isinstance(error, _NoTree) else f"{type(error).__name__}: {error}"
            raise SnapshotError(f"{path} holds no scene snapshot: {reason}") from error


class _NoTree(Exception):
    pass


def _read(file):
    with np.load(file, allow_pickle=False) as archive:
        if _TREE not in archive:
            raise _NoTree

        def decode(value):
            if isinstance(value, list):
                return tuple(decode(item) for item in value)
            if isinstance(value, dict):
                if "array" in value:
                    return archive[value["array"]]
                return _record(_TYPES[value["type"]], {name: decode(item) for name, item in value["fields"].items()})
            return value

        return decode(json.loads(archive[_TREE].tobytes().decode("utf-8")))


def _record(cls, fields):
    types = _types_of(cls)
    for name, value in fields.items():
        if name in types and not _fits(value, types[name]):
            raise TypeError(f"{cls.__name__}.{name} is {_short(value)}")
    return cls(**fields)


@functools.cache
def _types_of(cls):
    return typing.get_type_hints(cls)


def _fits(value, kind):
    """Whether a loaded value may stand in a field of that type; a parameter is numbers, or what says where they come from."""
    options = typing.get_args(kind)
    if typing.get_origin(kind) is tuple:
        return isinstance(value, tuple) and all(_fits(item, options[0]) for item in value)
    if options:
        return any(_fits(value, option) for option in options)
    if kind in (int, bool):
        return isinstance(value, int) and 0 <= value <= _LARGEST
    if kind is float:
        # A file's integers have any number of digits.
        return isinstance(value, float) or isinstance(value, int) and abs(value) <= sys.float_info.max
    if kind is object:
        return (
            _fits(value, float) or isinstance(value, _TYPES["NodeRef"]) or _fits(value, tuple[float, ...]) and len(value) == 3
        )
    return isinstance(value, kind)


def _short(value):
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
