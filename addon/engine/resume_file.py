"""The file from which a render continues: facts about the render, the ranges that are left of its round, and its samples."""

import contextlib
import json
import os
import struct
import zlib
from pathlib import Path

import numpy as np

from ..bindings.abi import LancerError
from ..bindings.parts import RANGE

ENDING = ".lancer"
_MAGIC = b"LANCERRS"
_FORMAT = 1
# Magic, format, bytes of the facts as JSON, number of ranges, CRC-32 of facts and ranges. A part has a checksum of its own.
_HEAD = struct.Struct("<8sIIII")
# Facts of a render with their types.
_FACTS = {"samples": int, "next": int, "looks": int, "refining": bool, "seconds": float, "mean": float}


def write(path, facts, ranges, part):
    """Replace the file at once, so that it is whole at any time; OSError if that fails."""
    text, rows = json.dumps(facts).encode(), ranges.astype(RANGE).tobytes()
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(path.name + ".new")
    try:
        with open(new, "wb") as file:
            file.write(_HEAD.pack(_MAGIC, _FORMAT, len(text), len(ranges), zlib.crc32(text + rows)))
            file.write(text + rows)
            file.write(part)
            file.flush()
            os.fsync(file.fileno())
        os.replace(new, path)
    except OSError:
        with contextlib.suppress(OSError):
            new.unlink()
        raise


def read(path):
    """Return (facts, ranges, part) of a file; None without one. Raise LancerError for another file, OSError as open() does."""
    try:
        data = Path(path).read_bytes()
    except (FileNotFoundError, NotADirectoryError):
        return None
    facts, at, count = _facts(data)
    ranges = np.frombuffer(data, RANGE, count, at)
    return facts, ranges, memoryview(data)[at + ranges.nbytes :]


def look(path):
    """Return (facts, bytes) of a file without reading its samples; None if it holds no render."""
    try:
        with open(path, "rb") as file:
            head = file.read(_HEAD.size)
            _, _, length, count, _ = _HEAD.unpack(head)
            # A wrong head may tell any length.
            size = os.fstat(file.fileno()).st_size
            return _facts(head + file.read(min(size, length + count * RANGE.itemsize)))[0], size
    except (OSError, LancerError, struct.error):
        return None


def _facts(data):
    """Return (facts, offset of the ranges, their number)."""
    if len(data) < _HEAD.size or not data.startswith(_MAGIC):
        raise LancerError("it holds no render")
    _, version, length, count, check = _HEAD.unpack_from(data)
    if version != _FORMAT:
        raise LancerError("it is of another version of Lancer")
    at = _HEAD.size + length
    told = data[_HEAD.size : at + count * RANGE.itemsize]
    if len(told) != length + count * RANGE.itemsize or zlib.crc32(told) != check:
        raise LancerError("it is damaged")
    facts = json.loads(told[:length])
    if {name: type(value) for name, value in facts.items()} != _FACTS:
        raise LancerError("it is damaged")
    return facts, at, count
