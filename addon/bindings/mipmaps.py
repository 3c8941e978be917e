"""The levels of an image with mipmaps, made by the core."""

import ctypes

import numpy as np

from . import marshal
from .abi import check, load_library
from .blocks import SIDE


def smaller_levels(picture):
    """Return level 1 and all smaller ones of a shading.Image with rows of texels; their colour is multiplied by alpha."""
    height, width, channels = picture.texels.shape
    shapes = []
    while max(height, width) > SIDE:
        height, width = max(height // 2, 1), max(width // 2, 1)
        shapes.append((height, width, channels))
    numbers = np.empty(sum(int(np.prod(shape)) for shape in shapes), picture.texels.dtype)
    if shapes:
        library = load_library()
        check(library.lancer_make_mipmaps(ctypes.byref(marshal.image(picture)), numbers.ctypes.data), library)
    ends = np.cumsum([np.prod(shape) for shape in shapes], dtype=int)
    return [part.reshape(shape) for part, shape in zip(np.split(numbers, ends[:-1]), shapes, strict=True)] if shapes else []
