"""Levels of images, made by the library for rows, and by hand for blocks that lie in a file."""

import numpy as np
import pytest

from addon.bindings.enums import AlphaMode, Transfer
from addon.bindings.mipmaps import smaller_levels
from addon.bindings.snapshot import Image


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_levels_halve_until_they_fit_a_block(dtype):
    texels = np.full((130, 300, 3), 7, dtype)
    levels = smaller_levels(Image(texels=texels, mipmaps=1))
    assert [level.shape for level in levels] == [(65, 150, 3), (32, 75, 3), (16, 37, 3)]
    # Weights along odd sides are rounded, a few times for each level.
    assert all(level.dtype == dtype and np.allclose(level, 7, rtol=1e-6, atol=0) for level in levels)
    assert smaller_levels(Image(texels=texels[:64, :64], mipmaps=1)) == []


def test_colour_is_multiplied_by_alpha():
    texels = np.zeros((128, 128, 4), np.uint8)
    texels[:, ::2] = (255, 0, 0, 255)
    texels[:, 1::2] = (0, 255, 0, 0)
    (level,) = smaller_levels(Image(texels=texels, alpha=AlphaMode.STRAIGHT, transfer=Transfer.LINEAR, mipmaps=1))
    assert (level == (128, 0, 0, 128)).all()
