"""Simplify's limits of the size of images, as in Cycles: the mean of squares of texels in the image's own values."""

import numpy as np

from ..bindings.enums import AlphaMode

NO_LIMIT = 0, 1.0
_OFF = "OFF"


def size_limit(scene, in_view):
    """Return (the most texels along a side, 0 = any; the share of the size that is shown) of a scene."""
    cycles = getattr(scene, "cycles", None)
    if cycles is None or not scene.render.use_simplify:
        return NO_LIMIT
    end = "" if in_view else "_render"
    most = getattr(cycles, f"texture_limit{end}", _OFF)
    share = getattr(cycles, f"texture_resolution{end}", 100.0)
    return 0 if most == _OFF else int(most), 0.01 * share


def smaller(picture, limit):
    """Return a snapshot.Image as the limit allows."""
    most, share = limit
    height, width = picture.texels.shape[:2]
    longest = max(height, width)
    step = 1
    while most and longest > most * step or share * step < 1.0 and step < longest:
        step *= 2
    if step == 1:
        return picture
    return picture.replaced(texels=_means(np.asarray(picture.texels), step, picture.alpha == AlphaMode.STRAIGHT))


def _means(texels, step, is_straight):
    """Return the means of squares of step x step texels; colours weigh by their alpha if they are not multiplied by it."""
    height, width, channels = texels.shape
    rows, columns = max(1, height // step), max(1, width // step)
    part = texels[: rows * step, : columns * step].astype(np.float32)
    weighs = is_straight and channels == 4
    if weighs:
        part[..., :3] *= part[..., 3:]
    means = part.reshape(rows, part.shape[0] // rows, columns, part.shape[1] // columns, channels).mean(axis=(1, 3))
    if weighs:
        means[..., :3] /= np.where(means[..., 3:] > 0.0, means[..., 3:], 1.0)
    return means if texels.dtype.kind == "f" else np.rint(means).astype(texels.dtype)
