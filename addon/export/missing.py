"""The texel with which Cycles replaces a picture that it cannot read."""

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.enums import AlphaMode, Transfer
from .colorspace import IDENTITY, conversion

MAGENTA = (1.0, 0.0, 1.0)
# Before 5.2 Cycles interpolates, clips and decodes the texel as any other.
HAS_TEXEL = bpy.app.version < (5, 2)


def missing(image=None, tile=0):
    """Return the texel in place of an image's picture, or of one of its tiles."""
    space = None if image is None else image.colorspace_settings
    # Blender has no name of the colour space for files that are no pictures.
    is_decoded = space is not None and space.name and not space.is_data and conversion(space.name) == (Transfer.SRGB, IDENTITY)
    return snapshot.Image(
        "missing",
        np.array(((MAGENTA,),), np.float32),
        transfer=Transfer.SRGB if is_decoded else Transfer.LINEAR,
        alpha=AlphaMode.STRAIGHT,
        tile=tile,
    )
