"""Small PNG files, for the page and for the scenes' textures."""

import struct
import zlib

import numpy as np


def encode(picture, depth=8):
    """Returns a PNG of display values in [0, 1], (height, width, 3 or 4) with 8 or 16 bits; row 0 is the top row."""
    values = (np.clip(np.nan_to_num(picture), 0.0, 1.0) * (2**depth - 1) + 0.5).astype(f">u{depth // 8}")
    height, width, channels = values.shape
    rows = b"".join(b"\0" + row.tobytes() for row in values)
    parts = [
        (b"IHDR", struct.pack(">IIBBBBB", width, height, depth, {3: 2, 4: 6}[channels], 0, 0, 0)),
        (b"IDAT", zlib.compress(rows, 9)),
        (b"IEND", b""),
    ]
    chunks = (struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in parts)
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def display(picture, exposure=1.0):
    """Returns three channels through the sRGB curve; a single channel is repeated, channels beyond three are dropped."""
    picture = np.asarray(picture, np.float64)[..., :3]
    if picture.shape[-1] < 3:
        picture = np.repeat(picture[..., :1], 3, axis=-1)
    linear = np.clip(np.nan_to_num(picture) * exposure, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
