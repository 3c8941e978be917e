"""The texels that Blender asks for, in the result of a bake; and their values, which it reads there."""

import bpy
import numpy as np

from ..bindings.texels import DTYPE

_BY_ROWS = bpy.app.version < (4, 0)


def read_texels(layer, width, height):
    """Return the rows of Texels of a layer with Blender's passes BakePrimitive and BakeDifferential."""
    primitive, differential = _read(layer, "BakePrimitive"), _read(layer, "BakeDifferential")
    # Before 4.2 the first channel is a seed, and the weights are the last two.
    numbers, weights = (primitive[:, 1], primitive[:, 2:4]) if primitive.shape[1] == 4 else (primitive[:, 2], primitive[:, :2])
    rows = np.zeros(width * height, DTYPE)
    # Blender's -1 of a texel without a surface has the bits of EMPTY.
    rows["triangle"] = np.ascontiguousarray(numbers).view(np.uint32)
    rows["weights"] = np.clip(weights, 0.0, 1.0)
    # du/dx, du/dy, dv/dx, dv/dy.
    rows["dx"], rows["dy"] = differential[:, 0::2], differential[:, 1::2]
    return rows.reshape(height, width)


def write_picture(layer, picture):
    """Fill Combined, which Blender copies into the image."""
    target = layer.passes["Combined"]
    rows = np.ascontiguousarray(picture, np.float32).reshape(-1, picture.shape[2])
    target.rect.foreach_set(rows if _BY_ROWS else rows.ravel())


def _read(layer, name):
    source = layer.passes[name]
    rows = np.empty((len(source.rect), source.channels), np.float32)
    # Before 4.0 foreach_get compares the length with the number of pixels and then copies the whole buffer.
    source.rect.foreach_get(rows if _BY_ROWS else rows.ravel())
    return rows
