"""The texel with which Cycles replaces a picture that it cannot read."""

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.enums import AlphaMode, Transfer
from .colorspace import IDENTITY, conversion

MAGENTA = (1.0, 0.0, 1.0)
# Before 5.2 Cycles interpolates, clips and decodes the texel as any other.
HAS_TEXEL = bpy.app.version < (5, 2)
# Cycles writes 1 and 0 as the bits of half floats, and reads exponents of 0 as those of normal numbers.
_ONE, _ZERO = 2.0**-15 * (1.0 + 2.0**-10), 2.0**-15


def is_black(image):
    """Whether the texel in place of an image is nearly black: Cycles keeps such colour spaces as half floats."""
    return HAS_TEXEL and _transfer(image) is None


def missing(image=None, tile=0):
    """Return the texel in place of an image's picture, or of one of its tiles."""
    if image is not None and is_black(image):
        texel = np.array((((_ONE, _ZERO, _ONE, _ONE),),), np.float32)
        return snapshot.Image("missing", texel, transfer=Transfer.LINEAR, alpha=AlphaMode.ASSOCIATED, tile=tile)
    texel = np.array(((MAGENTA,),), np.float32)
    transfer = Transfer.LINEAR if image is None else _transfer(image) or Transfer.LINEAR
    return snapshot.Image("missing", texel, transfer=transfer, alpha=AlphaMode.STRAIGHT, tile=tile)


def _transfer(image):
    """Return the curve of an image's colour space; None if colours of that space have to be converted."""
    space = image.colorspace_settings
    # Blender has no name of the colour space for files that are no pictures.
    if space.is_data or not space.name:
        return Transfer.LINEAR
    transfer, matrix = conversion(space.name) or (None, None)
    return transfer if matrix == IDENTITY else None
