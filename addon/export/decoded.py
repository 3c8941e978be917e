"""Files of images with 8 bits as bytes, which scripts can read since Blender 5.2: floats need four times the memory."""

import contextlib
from typing import NamedTuple

import imbuf
import numpy as np

from ..host import main_thread

READS_BYTES = hasattr(imbuf.types.ImBuf, "with_buffer")
_START = 25  # bytes of a file that tell its kind
_PNG, _DEPTH_OF_PNG, _EIGHT_BITS = b"\x89PNG\r\n\x1a\n", 24, 8
_JPEG, _BMP, _RIFF, _WEBP = b"\xff\xd8\xff", b"BM", b"RIFF", b"WEBP"


class Decoded(NamedTuple):
    """The pixels of a file, with the names of those of a Blender image."""

    texels: object  # (height, width, channels) of uint8, the lowest row first, neither multiplied nor divided by alpha
    is_float = False

    @property
    def size(self):
        return self.texels.shape[1], self.texels.shape[0]

    @property
    def channels(self):
        return self.texels.shape[2]


def decoded_file(path):
    """Yield the Decoded of a file, whose texels are freed on exit; None if this Blender or the file gives no bytes."""
    with open(path, "rb") as file:
        return _decoded(file.read(_START), lambda: imbuf.load(path))


def decoded_bytes(data):
    """Yield the Decoded of a file's content, as decoded_file does."""
    return _decoded(data[:_START], lambda: imbuf.load_from_buffer(data))


@contextlib.contextmanager
def _decoded(start, load):
    # Decoding takes a moment for a large image, and a set of tiles has many.
    main_thread.look()
    buffer = _loaded(load) if READS_BYTES and _has_bytes(start) else None
    try:
        if buffer is None or buffer.buffer_type != "BYTE":
            yield None
            return
        with buffer.with_buffer() as pixels:
            yield Decoded(np.asarray(pixels))
    finally:
        if buffer is not None:
            buffer.free()


def _loaded(load):
    try:
        return load()
    except (OSError, ValueError):
        return None


def _has_bytes(start):
    """Whether a file that begins so is read as bytes; another one would be decoded in vain."""
    if start.startswith(_PNG):
        return start[_DEPTH_OF_PNG:] == bytes((_EIGHT_BITS,))
    return start.startswith((_JPEG, _BMP)) or start.startswith(_RIFF) and start[8:12] == _WEBP
