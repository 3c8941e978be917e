"""Computed images, packed: an evening sky, a painted cloth, a grain, wear, a weave, a leaf with a cut-out outline."""

import bpy
import numpy as np

_LINEAR = "Linear Rec.709" if bpy.app.version >= (4, 0) else "Linear"


def make_image(name, pixels, linear=False):
    """Returns an image of (height, width, 4) values as stored, row 0 the lowest; linear images are stored as floats."""
    height, width = pixels.shape[:2]
    result = bpy.data.images.new(name, width, height, alpha=True, float_buffer=linear)
    if linear:
        result.colorspace_settings.name = _LINEAR
    result.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    result.update()
    result.pack()
    return result


def _grid(width, height):
    return np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)


def sky(width=512, height=256):
    """An equirectangular sky: blue above, warm at the horizon, dim ground, and a soft sun of a few degrees."""
    x, y = _grid(width, height)
    up = np.sin((y - 0.5) * np.pi)
    pixels = np.ones((height, width, 4))
    share = np.clip(up, 0.0, 1.0)[..., None] ** 0.5
    above = (1.0 - share) * np.array([0.9, 0.7, 0.5]) + share * np.array([0.15, 0.3, 0.7])
    pixels[..., :3] = np.where(up[..., None] > 0.0, 0.6 * above, np.array([0.12, 0.1, 0.08]))
    longitude, latitude = (x - 0.3) * 2 * np.pi, (y - 0.72) * np.pi
    distance2 = (np.cos(0.22 * np.pi) * longitude) ** 2 + latitude**2
    pixels[..., :3] += 60.0 * np.exp(-distance2 / 0.05**2)[..., None] * np.array([1.0, 0.85, 0.6])
    return make_image("Evening sky", pixels, linear=True)


def cloth(name="Cloth", size=256, cells=12):
    """Checks of two hues with a gradient of colour, so that no two places have the same colour."""
    x, y = _grid(size, size)
    check = ((np.floor(x * cells) + np.floor(y * cells)) % 2)[..., None]
    warm = np.stack([0.85 - 0.3 * y, 0.45 + 0.3 * x, 0.25 + 0 * x], axis=-1)
    cool = np.stack([0.2 + 0.2 * x, 0.35 + 0.2 * y, 0.6 + 0 * x], axis=-1)
    pixels = np.ones((size, size, 4))
    pixels[..., :3] = check * warm + (1 - check) * cool
    return make_image(name, pixels)


def grain(name, color, size=256, waves=9):
    """One hue, lighter and darker in crossed waves."""
    x, y = _grid(size, size)
    shade = np.sin(2 * np.pi * waves * (x + 0.3 * np.sin(4 * np.pi * y))) * np.cos(2 * np.pi * (waves + 2) * y)
    pixels = np.ones((size, size, 4))
    pixels[..., :3] = np.array(color) * (1.0 + 0.25 * shade[..., None])
    return make_image(name, pixels)


def _data(name, pixels):
    """Returns an image of non-colour data."""
    image = make_image(name, pixels)
    image.colorspace_settings.name = "Non-Color"
    image.pack()
    return image


def wear(name="Wear", size=256, cells=12):
    """Roughness between 0.15 and 0.75, a soft blotch in each cell."""
    x, y = _grid(size, size)
    pixels = np.ones((size, size, 4))
    blotch = 0.5 + 0.5 * np.sin(2 * np.pi * cells * x) * np.sin(2 * np.pi * cells * y)
    pixels[..., :3] = (0.15 + 0.6 * blotch)[..., None]
    return _data(name, pixels)


def weave(name="Weave", size=256, cells=24):
    """A tangent-space normal map of round bumps."""
    x, y = _grid(size, size)
    slope = np.stack([np.cos(2 * np.pi * cells * x), np.cos(2 * np.pi * cells * y), np.full_like(x, 2.5)], axis=-1)
    pixels = np.ones((size, size, 4))
    pixels[..., :3] = 0.5 + 0.5 * slope / np.linalg.norm(slope, axis=-1, keepdims=True)
    return _data(name, pixels)


def leaf(size=128):
    """A toothed oval leaf with veins; alpha 0 around it."""
    x, y = _grid(size, size)
    along, across = y, np.abs(x - 0.5)
    half_width = 0.32 * np.sin(np.pi * np.clip(along, 0.0, 1.0)) ** 0.8 * (1.0 + 0.12 * np.cos(40 * along))
    vein = np.minimum(across, np.abs(np.mod(along * 8 - across * 8, 1.0) - 0.5) / 8) < 0.012
    pixels = np.zeros((size, size, 4))
    pixels[..., :3] = np.where(vein[..., None], np.array([0.55, 0.62, 0.25]), np.array([0.16, 0.42, 0.1]))
    pixels[..., 3] = across < half_width
    return make_image("Leaf", pixels)
