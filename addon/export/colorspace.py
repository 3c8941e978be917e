"""Blender's own conversions to the scene's working space, as curves and matrices that the core applies."""

import contextlib
import ctypes
import functools
import os
import sys
import tempfile

import bpy
import numpy as np
from mathutils import Color

from ..bindings.enums import Transfer
from ..host import main_thread

IDENTITY = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
# OpenColorIO works in single precision, with curves that are off by 2.4e-5: a matrix or curve this near is that one. An eighth
# of it is what one step of 8 bits is worth at most to a colour between 0 and 1.
_NEAR = 2.0**-12
_TEXELS_AT_ONCE = 1 << 18  # converted in one piece, between which Blender answers


def _working_space():
    """Something that differs where the working space does."""
    settings = getattr(bpy.data, "colorspace", None)
    return getattr(settings, "working_space", "")


def luminance_weights():
    return _luminance_weights(_working_space())


@functools.lru_cache(maxsize=16)
def _luminance_weights(working_space):
    return tuple(Color(row).from_scene_linear_to_xyz_d65()[1] for row in np.eye(3))


def srgb_to_linear(values):
    return np.where(values <= 0.04045, values / 12.92, ((np.maximum(values, 0.0) + 0.055) / 1.055) ** 2.4)


def conversion(name):
    """(transfer, matrix) from a colour space to the working space; None where it takes more than a curve and a matrix."""
    return _conversion(name, _working_space())


@functools.lru_cache(maxsize=64)
def _conversion(name, working_space):
    samples = np.vstack([np.eye(3), np.random.default_rng(1).random((61, 3))])
    pixels = np.ones((1, len(samples), 4), np.float32)
    pixels[0, :, :3] = samples
    wanted = convert(pixels, name)[0, :, :3].astype(float)
    matrix = wanted[:3].T
    for transfer, decoded in ((Transfer.LINEAR, samples), (Transfer.SRGB, srgb_to_linear(samples))):
        if np.abs(decoded @ matrix.T - wanted).max() < _NEAR:
            plain = np.abs(matrix - np.eye(3)).max() < _NEAR
            return transfer, IDENTITY if plain else tuple(matrix.ravel().tolist())
    return None


def convert(pixels, name):
    """(height, width, 4) in a colour space to the working space."""
    rows = max(1, _TEXELS_AT_ONCE // pixels.shape[1])
    converted = [_convert(pixels[first : first + rows], name) for first in range(0, len(pixels), rows)]
    return np.concatenate(converted)


def _convert(pixels, name):
    """Writes pixels to a file as they are and reads them as those of a colour space."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "pixels.exr")
        main_thread.run(lambda: _write(pixels, path))
        with loaded(path, name, "CHANNEL_PACKED") as read:
            return floats(read)


def _write(pixels, path):
    height, width = pixels.shape[:2]
    with _own_data() as data:
        image = data.images.new("Lancer", width, height, alpha=True, float_buffer=True, is_data=True)
        image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
        image.filepath_raw, image.file_format = path, "OPEN_EXR"
        image.save()


@contextlib.contextmanager
def loaded(path, name, alpha_mode):
    """A file as an image of Blender's, beside the user's data, for as long as it is looked at.

    name: of the colour space; "" lets Blender choose by the file, None is data, whose values stay as they are.
    """
    main_thread.look()
    image, held = main_thread.run(lambda: _load(path, name, alpha_mode))
    try:
        yield image
    finally:
        main_thread.post(held.close)


def stored(path):
    """The same with values as the file stores them: not decoded, neither multiplied nor divided by alpha."""
    return loaded(path, None, "CHANNEL_PACKED")


def _load(path, name, alpha_mode):
    """The image, whose pixels are read when they are asked for, and what to close for it to go."""
    with contextlib.ExitStack() as stack:
        image = stack.enter_context(_own_data()).images.load(path, check_existing=False)
        if name is None:
            image.colorspace_settings.is_data = True
        elif name:
            image.colorspace_settings.name = name
        image.alpha_mode = alpha_mode
        return image, stack.pop_all()


@contextlib.contextmanager
def _own_data():
    """Data beside the user's, freed in the end."""
    with bpy.data.temp_data() as data:
        # Blender holds this object twice and counts one: the name, this call's argument and the holder would be three.
        if sys.getrefcount(data) < 3:
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(data))
        yield data


def floats(image):
    """(height, width, channels) as Blender holds it: bytes over 255, floating point in the working space."""
    width, height = image.size
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, image.channels)
