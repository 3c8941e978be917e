"""Texels of images as the core takes them: in their own bit depth where that keeps their values, else as floats."""

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.enums import AlphaMode, Transfer
from .colorspace import IDENTITY, conversion, convert, floats
from .decoded import Decoded
from .gaps import mended

_VALUES_AT_ONCE = 1 << 18  # converted in one pass, small enough for the processor's cache
_WHITE = 65535.0
_LARGEST_BYTE = 255.0
_ASSOCIATED_FORMATS = ("OPEN_EXR", "OPEN_EXR_MULTILAYER", "HDR")  # formats that store colour multiplied by alpha


def read_texels(image, source, tell, space, tile=0, path="", columns=()):
    """Return a list with the image of source under the settings of image; empty if it has no pixels.

    path: the file that source reads with its stored values; its floating point values are in the image's colour space, as bytes
    always are. Without a path they are in the working space. columns: the channels of source to read; empty means all.
    """
    is_stored = bool(path)
    if min(source.size) < 1 or source.channels < 1:
        return []
    values = _values(source)
    if columns:
        values = np.ascontiguousarray(values[:, :, columns])
    if source.is_float and not np.isfinite(values).all():
        values = _mended(image, values, tell, path)
    name, is_data = space
    alpha = _alpha_mode(image, source, is_data, is_stored)
    if values.shape[2] == 2:
        values = values[:, :, [0, 0, 0, 1]]
    if values.shape[2] == 4 and (alpha == AlphaMode.NONE or _is_opaque(values[:, :, 3])):
        # Keep the alpha mode: it decides the colour outside the image with extension Clip.
        values = _colors(values)
    transfer, matrix = Transfer.LINEAR, IDENTITY
    # Without the name of a colour space Cycles uses the values unchanged.
    if name and not is_data and (is_stored or not source.is_float):
        found = conversion(name)
        # Cycles decodes after interpolation only if the sRGB curve alone suffices; else it converts before interpolation.
        if found is None or (found[0] == Transfer.SRGB and found[1] != IDENTITY):
            values, alpha = _converted(values, name, alpha)
            return [_picture(image, values, transfer, alpha, tile, matrix)]
        transfer, matrix = found
    # The texels of a Decoded belong to Blender.
    texels = _floating(values) if source.is_float else values if values.flags.owndata else values.copy()
    return [_picture(image, texels, transfer, alpha, tile, matrix)]


def _values(source):
    """Return the pixels of a Blender image or a Decoded: floating point as float32, others as bytes."""
    if isinstance(source, Decoded):
        return source.texels
    values = floats(source)
    return values if source.is_float else _quantised(values, _LARGEST_BYTE, np.uint8)


def _is_opaque(alpha):
    return alpha.min() == _LARGEST_BYTE if alpha.dtype == np.uint8 else bool((alpha == 1.0).all())


def _colors(values):
    """Return a copy without alpha. Copied by channels, parts that fit the cache take half the time of texels one by one."""
    colors = np.empty((*values.shape[:2], 3), values.dtype)
    rows = max(1, _VALUES_AT_ONCE // values[0].size)
    for first in range(0, len(values), rows):
        for channel in range(3):
            colors[first : first + rows, :, channel] = values[first : first + rows, :, channel]
    return colors


def mid_grey(image, tile):
    """Return the picture in place of pixels that cannot be read."""
    return _picture(image, np.full((1, 1, 3), 0.5, np.float32), Transfer.LINEAR, AlphaMode.NONE, tile, IDENTITY)


def _mended(image, values, tell, path):
    count = int((~np.isfinite(values).all(axis=2)).sum())
    packed = image.packed_file.data if image.packed_file is not None else b""
    values, is_finite = mended(values, path, packed)
    # The core reports the texels that are left.
    if is_finite:
        tell(f"image '{image.name}': {count} texels are not finite and are read as in Cycles", "")
    return values


def _picture(image, texels, transfer, alpha, tile, matrix):
    return snapshot.Image(name=image.name, texels=texels, transfer=transfer, alpha=alpha, tile=tile, matrix=matrix)


def _alpha_mode(image, source, is_data, is_stored):
    """Return the AlphaMode of the pixels of source, as each version of Cycles chooses it."""
    if image.alpha_mode == "NONE":
        return AlphaMode.NONE
    if is_data or image.alpha_mode == "CHANNEL_PACKED":
        return AlphaMode.CHANNEL_PACKED
    if bpy.app.version >= (5, 1):
        # Cycles follows the image's setting, even for pixels that Blender has already multiplied or divided.
        associated = image.alpha_mode == "PREMUL"
    elif is_stored:
        associated = source.file_format in _ASSOCIATED_FORMATS
    else:
        # In memory Blender keeps floating point associated and bytes straight.
        associated = source.is_float
    return AlphaMode.ASSOCIATED if associated else AlphaMode.STRAIGHT


def _converted(values, name, alpha):
    """Return (values, alpha mode) converted to floating point in the working space.

    Colour is divided by alpha before the conversion and multiplied after it, so that interpolation sees associated alpha.
    """
    if values.dtype == np.uint8:
        # The factor that Blender uses, for equal bits.
        values = values * np.float32(1.0 / _LARGEST_BYTE)
    full = np.ones((*values.shape[:2], 4), np.float32)
    full[:, :, : values.shape[2]] = values
    if values.shape[2] == 1:
        full[:, :, :3] = values
    if values.shape[2] < 4:
        return np.ascontiguousarray(convert(full, name)[:, :, :3]), alpha
    if alpha == AlphaMode.ASSOCIATED:
        _divide(full)
    full = convert(full, name)
    if alpha in (AlphaMode.ASSOCIATED, AlphaMode.STRAIGHT):
        full[:, :, :3] *= full[:, :, 3:]
        alpha = AlphaMode.ASSOCIATED
    return full, alpha


def _divide(values):
    """Divide colour by alpha in place where alpha is positive."""
    np.divide(values[:, :, :3], values[:, :, 3:], out=values[:, :, :3], where=values[:, :, 3:] > 0.0)


def _floating(values):
    """Return texels as float32, or as uint16 if all are multiples of 1/65535, as those of 16-bit files are."""
    values = np.ascontiguousarray(values)
    sample = values.reshape(-1)[:: max(1, values.size // 4096)]
    if _is_stepped(sample) and _is_stepped(values):
        return _quantised(values, _WHITE, np.uint16)
    return values


def _is_stepped(values):
    """Whether all values are multiples of 1/65535 up to the rounding of single precision, which is 2^-9 of a step."""
    # Inverted: values that are not finite are no multiples.
    if not (values.min() >= 0.0 and values.max() <= 1.0):
        return False
    steps = values * _WHITE
    return bool((np.abs(steps - np.rint(steps)) <= 2.0**-8).all())


def _quantised(values, scale, dtype):
    """Return values between 0 and 1 rounded to integers of dtype, in blocks of rows to limit peak memory."""
    texels = np.empty(values.shape, dtype)
    rows = max(1, _VALUES_AT_ONCE // (values.shape[1] * values.shape[2]))
    for first in range(0, len(values), rows):
        part = slice(first, first + rows)
        texels[part] = values[part] * np.float32(scale) + np.float32(0.5)
    return texels
