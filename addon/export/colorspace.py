"""Conversions from Blender's colour spaces to the working space, as curves and matrices that the core applies."""

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
# OpenColorIO works in single precision and its curves have errors of up to 2.4e-5: a matrix or curve within this distance
# counts as equal. It is a sixteenth of an 8-bit step.
_NEAR = 2.0**-12
_TEXELS_AT_ONCE = 1 << 18  # converted in one call; Blender responds between calls


def _working_space():
    """Return a key of the working space for caches."""
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
    """Return (transfer, matrix) from a colour space to the working space; None if a curve and a matrix do not suffice."""
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
    """Return pixels, (height, width, 4), converted from a colour space to the working space."""
    rows = max(1, _TEXELS_AT_ONCE // pixels.shape[1])
    converted = [_convert(pixels[first : first + rows], name) for first in range(0, len(pixels), rows)]
    return np.concatenate(converted)


def _convert(pixels, name):
    """Write pixels to a file unchanged and load the file with the colour space set, so that Blender converts them."""
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
def loaded(path, name, alpha_mode, frame=None):
    """Yield a file as a temporary Blender image outside the user's data.

    name: the colour space; "" lets Blender choose by the file, None is for data, whose values stay unchanged.
    frame: the number of a movie's frame.
    """
    with in_own_data(lambda data: _load(data, path, name, alpha_mode, frame)) as (image, texture):
        if texture is not None:
            # Scripts read the pixels of the frame that was decoded last, for whatever reader.
            texture.evaluate((0.0, 0.0, 0.0))
        yield image


def stored(path):
    """Yield the image with the values that the file stores: not decoded, neither multiplied nor divided by alpha."""
    return loaded(path, None, "CHANNEL_PACKED")


def _load(data, path, name, alpha_mode, frame=None):
    """Return (image, texture). Blender reads the image's pixels on first access. texture: one that shows the frame, or None."""
    image = data.images.load(path, check_existing=False)
    if name is None:
        image.colorspace_settings.is_data = True
    elif name:
        image.colorspace_settings.name = name
    image.alpha_mode = alpha_mode
    if frame is None:
        return image, None
    texture = data.textures.new("Lancer", "IMAGE")
    texture.image = image
    texture.image_user.frame_current = frame
    return image, texture


@contextlib.contextmanager
def in_own_data(make):
    """Yield make(data), called in the main thread with a BlendData apart from the user's, which is freed on exit."""
    main_thread.look()
    made, held = main_thread.run(lambda: _hold(make))
    try:
        yield made
    finally:
        main_thread.post(held.close)


def _hold(make):
    """Return (make(data), the ExitStack that frees the data)."""
    with contextlib.ExitStack() as stack:
        return make(stack.enter_context(_own_data())), stack.pop_all()


@contextlib.contextmanager
def _own_data():
    """Yield a BlendData apart from the user's, freed on exit."""
    with bpy.data.temp_data() as data:
        # Blender keeps two references to this object but counts one; with the name and the argument there should be three.
        if sys.getrefcount(data) < 3:
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(data))
        yield data


def floats(image):
    """Return (height, width, channels) in Blender's representation: bytes over 255, floating point in the working space."""
    width, height = image.size
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, image.channels)
