"""Denoising of shadow catchers: their pass, and the picture in which they leave only their shadows."""

import dataclasses

import numpy as np

from ..bindings import shadowed
from . import denoiser


def denoise_parts(parts, albedo, normal, **options):
    """Return the Denoised of shadowed.Parts. As in Cycles, matte and factor are denoised, then composed.

    The guides are those of the matte. options: of denoiser.denoise.
    """
    matte = denoiser.denoise(parts.matte, albedo, normal, **options)
    # A factor of shadows has no surface of its own that would guide the network.
    catcher = denoiser.denoise(np.maximum(parts.catcher, 0.0), **options)
    image = shadowed.compose(parts._replace(matte=matte.image, catcher=catcher.image))
    return dataclasses.replace(matte, image=image, catcher=catcher.image, seconds=matte.seconds + catcher.seconds)
