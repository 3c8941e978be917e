"""Movies without compression: AVI files of bytes, which every Blender reads without loss."""

import struct

import numpy as np


def encode(frames, rate=24):
    """Returns an AVI of display values in [0, 1], (height, width, 3) each; row 0 is the lowest."""
    height, width, _ = frames[0].shape
    rows = [_rows(frame) for frame in frames]
    size = len(rows[0])
    header = struct.pack("<14I", 1_000_000 // rate, size * rate, 0, 16, len(rows), 0, 1, size, width, height, 0, 0, 0, 0)
    stream = struct.pack("<4s16x7I4H", b"vids", 1, rate, 0, len(rows), size, 0xFFFFFFFF, 0, 0, 0, width, height)
    bitmap = struct.pack("<IiiHHIIiiII", 40, width, height, 1, 24, 0, size, 0, 0, 0, 0)
    described = _list(b"strl", _chunk(b"strh", stream), _chunk(b"strf", bitmap))
    # Each frame is a chunk of 8 bytes and its rows, after the 4 bytes that name the list.
    places = (struct.pack("<4sIII", b"00db", 16, 4 + number * (8 + size), size) for number in range(len(rows)))
    body = (
        _list(b"hdrl", _chunk(b"avih", header), described),
        _list(b"movi", *(_chunk(b"00db", row) for row in rows)),
        _chunk(b"idx1", b"".join(places)),
    )
    return _chunk(b"RIFF", b"AVI " + b"".join(body))


def _rows(frame):
    """The bytes of a frame: blue first, the lowest row first, each row filled up to four bytes."""
    values = (np.clip(frame, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)[:, :, ::-1]
    flat = values.reshape(len(values), -1)
    return np.pad(flat, ((0, 0), (0, -flat.shape[1] % 4))).tobytes()


def _chunk(name, data):
    return name + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)


def _list(name, *chunks):
    return _chunk(b"LIST", name + b"".join(chunks))
