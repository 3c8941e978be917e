"""The digest of a scene: SHA-256 of all records that decide what a camera sees, equal on every machine."""

import dataclasses
import hashlib

import numpy as np

from .blocks import Blocks

_PARTS = ("meshes", "instances", "materials", "lights", "images", "world", "motion")


def scene_digest(snapshot):
    """Return 32 bytes that name the snapshot's scene with its motion, without camera and settings."""
    digest = hashlib.sha256()
    for name in _PARTS:
        _add(digest, getattr(snapshot, name))
    return digest.digest()


def _add(digest, value):
    """Add a value with its kind and length, so that no two values give the same bytes."""
    if isinstance(value, Blocks):
        value = np.asarray(value)
    if isinstance(value, np.ndarray):
        data = np.ascontiguousarray(value, value.dtype.newbyteorder("<"))
        digest.update(f"array {data.dtype.str} {data.shape};".encode())
        digest.update(data.reshape(-1).view(np.uint8).data)
    elif dataclasses.is_dataclass(value):
        digest.update(f"record {type(value).__name__};".encode())
        for field in dataclasses.fields(value):
            digest.update(f"field {field.name};".encode())
            _add(digest, getattr(value, field.name))
    elif isinstance(value, (tuple, list)):
        digest.update(f"list {len(value)};".encode())
        for item in value:
            _add(digest, item)
    elif isinstance(value, str):
        text = value.encode("utf-8", "surrogatepass")
        digest.update(b"text %d;" % len(text) + text)
    else:
        # The shortest text of a number is the same in every Python; enums and numpy's numbers count as plain ones.
        plain = value if value is None else bool(value) if isinstance(value, (bool, np.bool_)) else float(value)
        digest.update(f"value {plain!r};".encode())
