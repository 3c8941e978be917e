"""Texels that are not finite, with the values of the running Blender's Cycles."""

import struct

import bpy
import numpy as np

# Since 5.2 Cycles clears each such texel; before, only every fourth texel is tested.
_CLEARS_ALL = bpy.app.version >= (5, 2)
# Before 5.2 Cycles reads half floats with the largest exponent as numbers.
_HALF_INFINITY, _HALF_NAN = 65536.0, 98304.0
_MAGIC, _BEGIN, _HALF = b"v/1\x01", 8, 1
_LARGEST_HEADER = 1 << 16


def mended(values, path, packed):
    """Return (values, whether all are finite) of float texels (height, width, channels).

    path: the file of the values; "" if Blender keeps them in memory. packed: the content of a packed file.
    """
    gaps = ~np.isfinite(values).all(axis=2)
    values = values.copy()
    types = _channel_types(_beginning(path) if path else packed[:_LARGEST_HEADER])
    if not _CLEARS_ALL and path and _HALF in types:
        infinite = np.isinf(values)
        values[infinite] = np.copysign(_HALF_INFINITY, values[infinite])
        values[np.isnan(values)] = _HALF_NAN
        return values, True
    if _CLEARS_ALL or len(types) == 1:
        cleared = gaps
    else:
        cleared = gaps & (np.arange(gaps.size).reshape(gaps.shape) % 4 == 0)
    values[cleared] = 0.0
    return values, bool((gaps == cleared).all())


def _beginning(path):
    try:
        with open(path, "rb") as file:
            return file.read(_LARGEST_HEADER)
    except OSError:
        return b""


def _channel_types(header):
    """Return the types of the channels of an OpenEXR file; an empty list for other formats."""
    at = _BEGIN if header[:4] == _MAGIC else len(header)
    try:
        while header[at : at + 1] not in (b"", b"\0"):
            name, kind, rest = header[at:].split(b"\0", 2)
            (size,) = struct.unpack_from("<i", rest)
            if name == b"channels":
                return _types(rest[4 : 4 + size])
            at += len(name) + len(kind) + 2 + 4 + size
    except (ValueError, struct.error):
        # The header is damaged or ends before the channels.
        pass
    return []


def _types(channels):
    found = []
    while channels[:1] not in (b"", b"\0"):
        _, channels = channels.split(b"\0", 1)
        found.append(struct.unpack_from("<i", channels)[0])
        channels = channels[16:]
    return found
