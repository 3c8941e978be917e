"""Image files, as scanners, sculptors and photographers save them."""

import os
import struct

import bpy
import numpy as np

from . import png
from .images import image

# Endings of the formats that Blender writes.
_ENDINGS = {"OPEN_EXR": ".exr", "HDR": ".hdr", "JPEG": ".jpg", "WEBP": ".webp", "BMP": ".bmp", "TARGA": ".tga"}


def load(path, colorspace):
    result = bpy.data.images.load(path)
    result.colorspace_settings.name = colorspace
    return result


def from_file(kind, pixels, colorspace="sRGB", name="Picture"):
    """Stores pixels, row 0 the lowest, as a 16-bit PNG or TIFF, EXR or HDR file, and returns the image of that file."""
    return load(write(kind, os.path.join(bpy.app.tempdir, name), pixels), colorspace)


def write(kind, stem, pixels):
    """Writes such a file and returns its path: stem with the ending of the format."""
    encode, ending = {
        "PNG": (_png, ".png"),
        "TIFF": (_tiff, ".tif"),
        "EXR 16": (_exr_16, ".exr"),
        "EXR 32": (_exr_32, ".exr"),
    }.get(kind, (None, ""))
    if encode is None:
        return _by_blender(kind, stem, pixels)
    with open(stem + ending, "wb") as file:
        file.write(encode(pixels[::-1]))
    return stem + ending


def _png(rows):
    return png.encode(rows, depth=16)


def _tiff(rows):
    """Returns a TIFF of one strip without compression; a fourth channel is straight alpha."""
    height, width, channels = rows.shape
    data = (np.clip(rows, 0.0, 1.0) * 65535.0 + 0.5).astype("<u2").tobytes()
    short, long = 3, 4
    fields = [
        (256, long, 1, width),
        (257, long, 1, height),
        (258, short, channels, None),
        (259, short, 1, 1),
        (262, short, 1, 2 if channels > 1 else 1),
        (273, long, 1, None),
        (277, short, 1, channels),
        (278, long, 1, height),
        (279, long, 1, len(data)),
        (284, short, 1, 1),
    ] + [(338, short, 1, 2)] * (channels == 4)
    bits_at = 8 + 2 + 12 * len(fields) + 4
    values = {258: bits_at if channels > 2 else 16, 273: bits_at + 2 * channels}
    entries = b"".join(struct.pack("<HHII", tag, kind, count, values.get(tag, value)) for tag, kind, count, value in fields)
    head = struct.pack("<2sHIH", b"II", 42, 8, len(fields))
    return head + entries + struct.pack("<I", 0) + struct.pack("<H", 16) * channels + data


def _exr_16(rows):
    return _exr(rows, "<f2", 1)


def _exr_32(rows):
    return _exr(rows, "<f4", 2)


def write_layers(stem, planes):
    """Writes a file of layers and returns its path. planes: {name of a channel, as "Layer.Pass.R": (height, width)}."""
    with open(stem + ".exr", "wb") as file:
        file.write(_exr_of({name: plane[::-1] for name, plane in planes.items()}, "<f4", 2))
    return stem + ".exr"


def _exr(rows, dtype, number):
    """Rows without compression, of any numbers; number: of the type of its channels."""
    names = {1: "Y", 3: "RGB", 4: "RGBA"}[rows.shape[2]]
    return _exr_of({name: rows[:, :, channel] for channel, name in enumerate(names)}, dtype, number)


def _exr_of(planes, dtype, number):
    """The channels {name: rows}, which the file sorts by name."""
    names = sorted(planes)
    height, width = planes[names[0]].shape
    listed = b"".join(name.encode() + struct.pack("<xiiii", number, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    fields = (
        (b"channels", b"chlist", listed),
        (b"compression", b"compression", b"\0"),
        (b"dataWindow", b"box2i", window),
        (b"displayWindow", b"box2i", window),
        (b"lineOrder", b"lineOrder", b"\0"),
        (b"pixelAspectRatio", b"float", struct.pack("<f", 1.0)),
        (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0.0, 0.0)),
        (b"screenWindowWidth", b"float", struct.pack("<f", 1.0)),
    )
    head = struct.pack("<ii", 20000630, 2)
    head += b"".join(name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data for name, kind, data in fields) + b"\0"
    # Channels of a row follow one another.
    lines = np.stack([planes[name] for name in names], axis=1).astype(dtype)
    size = lines[0].nbytes
    places = struct.pack(f"<{height}q", *(len(head) + 8 * height + y * (8 + size) for y in range(height)))
    return head + places + b"".join(struct.pack("<ii", y, size) + line.tobytes() for y, line in enumerate(lines))


def _by_blender(kind, stem, pixels):
    """Writes the values unchanged: data have no colour space, and colour with alpha counts as premultiplied."""
    full = np.ones((*pixels.shape[:2], 4))
    full[..., : pixels.shape[2]] = pixels
    source = image("Written", full, "Non-Color", is_float=True, pack=False)
    path = stem + _ENDINGS[kind]
    source.filepath_raw, source.file_format = path, kind
    source.save()
    bpy.data.images.remove(source)
    return path
