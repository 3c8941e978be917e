"""Trees of registered dataclasses, saved to and loaded from one .npz without pickle: arrays as such, all else as JSON.

A file may come from any source: load_npz returns records whose fields have the types that their classes declare, or raises
SnapshotError. A file that cannot be opened raises OSError.
"""

import contextlib
import dataclasses
import functools
import json
import os
import sys
import typing

import numpy as np

from .blocks import Blocks
from .record import Sets

_TYPES = {}
_TREE = "tree"
# The library's integers have 32 bits; ctypes would truncate larger ones.
_LARGEST = 2**32 - 1


class SnapshotError(ValueError):
    """A file without a valid snapshot; the text names the file and its fault."""


def register(cls):
    """Class decorator: allow this dataclass to be saved and loaded."""
    _TYPES[cls.__name__] = cls
    return cls


def save_npz(record, path):
    """Write a record to a path or an open binary file."""
    arrays = {}
    tree = json.dumps(_encoded(record, arrays)).encode("utf-8")
    with _opened(path, "wb") as file:
        np.savez(file, **{_TREE: np.frombuffer(tree, np.uint8)}, **arrays)


def _encoded(value, arrays):
    """Return a value as JSON holds it; its arrays go into a dict."""
    # numpy makes rows of blocks when it writes them, an image at a time.
    if isinstance(value, (np.ndarray, Blocks)):
        key = f"array_{len(arrays)}"
        arrays[key] = value
        return {"array": key}
    if dataclasses.is_dataclass(value):
        fields = {f.name: _encoded(getattr(value, f.name), arrays) for f in dataclasses.fields(value)}
        return {"type": type(value).__name__, "fields": fields}
    if isinstance(value, tuple):
        return [_encoded(item, arrays) for item in value]
    if isinstance(value, np.generic):
        return value.item()
    return value


def load_npz(path):
    """Return the record in a path or an open binary file."""
    with _opened(path, "rb") as file:
        try:
            return _read(file)
        except Exception as error:
            # A damaged file can raise any exception: in the archive, an array's header, the tree or a record.
            reason = "it holds no tree of records" if isinstance(error, _NoTree) else f"{type(error).__name__}: {error}"
            raise SnapshotError(f"{getattr(file, 'name', 'the file')} holds no scene snapshot: {reason}") from error


def _opened(path, mode):
    """Return a context of the file at a path; an open file stays open."""
    return contextlib.nullcontext(path) if hasattr(path, "read") else open(os.fspath(path), mode)


class _NoTree(Exception):
    pass


def _read(file):
    with np.load(file, allow_pickle=False) as archive:
        if _TREE not in archive:
            raise _NoTree
        return _decoded(json.loads(archive[_TREE].tobytes().decode("utf-8")), archive)


def _decoded(value, archive):
    """Return the value that _encoded() has made JSON of; its arrays come from an archive."""
    if isinstance(value, list):
        return tuple(_decoded(item, archive) for item in value)
    if isinstance(value, dict):
        if "array" in value:
            return archive[value["array"]]
        return _record(_TYPES[value["type"]], {name: _decoded(item, archive) for name, item in value["fields"].items()})
    return value


def _record(cls, fields):
    types = _types_of(cls)
    for name, value in fields.items():
        if name in types and not _fits(value, types[name]):
            raise TypeError(f"{cls.__name__}.{name} is {_short(value)}")
    # numpy takes no truth value as a size.
    numbers = {name: int(value) for name, value in fields.items() if isinstance(value, bool) and types.get(name) is not bool}
    return cls(**fields | numbers)


@functools.cache
def _types_of(cls):
    return typing.get_type_hints(cls)


def _fits(value, kind):
    """Whether a loaded value is valid for a field of that type. A field of type object is a parameter: numbers or a NodeRef."""
    options = typing.get_args(kind)
    if typing.get_origin(kind) is tuple:
        return isinstance(value, tuple) and all(_fits(item, options[0]) for item in value)
    if options:
        return any(_fits(value, option) for option in options)
    if kind is Sets:
        return isinstance(value, int) and 0 <= value < 2**64
    if kind in (int, bool):
        return isinstance(value, int) and 0 <= value <= _LARGEST
    if kind is float:
        # JSON integers can exceed the range of float.
        return isinstance(value, float) or isinstance(value, int) and abs(value) <= sys.float_info.max
    if kind is object:
        return (
            _fits(value, float) or isinstance(value, _TYPES["NodeRef"]) or _fits(value, tuple[float, ...]) and len(value) == 3
        )
    return isinstance(value, kind)


def _short(value):
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
