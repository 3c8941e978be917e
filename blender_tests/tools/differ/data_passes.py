"""Data at the centres of pixels: whether two pictures differ by more than the place of a sample within its pixel explains.

Cycles keeps one sample, up to 0.005 pixels off the middle. On a smooth surface that moves a value by as much of its change from
pixel to pixel; beside an outline, an edge or the border of a texel it may show the neighbour.
"""

import numpy as np

from scenes.parity import figures

# Single precision and the narrow filter of the other engine, as a share of the picture's level.
_SHARE = 2e-3
# Twice the distance of a sample from the middle, as a share of the difference between neighbours.
_BESIDE = 0.02
# A middle lies within 0.005 pixels of a given edge in one of a hundred pixels that the edge crosses; a pixel of fine texture is
# crossed by several. Few pixels need room for chance.
_FLIPPED, _CHANCE = 0.03, 3
# As in figures.judge, one of a hundred pixels may be anything.
_ODD = 0.01


def differs(ours, theirs, camera=None, least=0.0):
    """Return "" or how two pictures of one pass, each two halves, differ.

    camera: its place, for a pass of positions. least: the least level.
    """
    if figures.measure(ours, theirs, figures.KINDS["PIXELS"]).mean == np.inf:
        return "one of them shows a surface where the other shows none"
    ours, theirs = ((one + other) / 2 for one, other in (ours, theirs))
    shown = [np.where(np.abs(picture) < 1e9, picture, 0.0) for picture in (ours, theirs)]
    seen = np.any(shown[0] != 0.0, axis=-1) & np.any(shown[1] != 0.0, axis=-1)
    if not seen.any():
        return ""
    level = np.abs(shown[1][seen]).mean() if camera is None else np.linalg.norm(shown[1][seen] - camera, axis=-1).mean()
    level = max(level, least)
    low, high = _neighbours(shown[1])
    limit = _SHARE * level + _BESIDE * (high - low)
    far = np.any(np.abs(shown[0] - shown[1]) > limit, axis=-1) & seen
    outside = np.any((shown[0] < low - limit) | (shown[0] > high + limit), axis=-1) & far
    count, flips, odd = int(seen.sum()), int((far & ~outside).sum()), int(outside.sum())
    if flips > _FLIPPED * count + _CHANCE or odd > _ODD * count + _CHANCE:
        worst = float(np.abs(shown[0] - shown[1])[seen].max() / level)
        return f"{flips} of {count} pixels show a neighbour, {odd} something else; the largest difference is {worst:.3%}"
    return ""


def _neighbours(picture):
    """Return the least and the largest value of each pixel and its eight neighbours."""
    around = np.pad(picture, ((1, 1), (1, 1), (0, 0)), mode="edge")
    rows, columns = picture.shape[:2]
    near = np.stack([around[y : y + rows, x : x + columns] for y in range(3) for x in range(3)])
    return near.min(axis=0), near.max(axis=0)
