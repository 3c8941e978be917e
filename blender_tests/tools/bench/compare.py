"""Whether two renderers show the same picture: block means, so that noise counts little and what is shown counts all."""

import numpy as np

BLOCK = 8


def block_means(picture, size=BLOCK):
    """Means of squares of pixels; a rest at the upper and right edge is left out."""
    height, width = (length // size * size for length in picture.shape[:2])
    blocks = np.asarray(picture, np.float64)[:height, :width, :3].reshape(height // size, size, width // size, size, 3)
    return blocks.mean(axis=(1, 3))


def difference(ours, theirs):
    """Shares of the picture's mean level: the median of the blocks' differences, the 90th percentile, and the level's own."""
    a, b = block_means(ours), block_means(theirs)
    level = float(a.mean())
    distances = np.abs(a - b).mean(axis=2) / max(level, 1e-30)
    return {
        "median": float(np.median(distances)),
        "p90": float(np.percentile(distances, 90)),
        "level": float(b.mean()) / max(level, 1e-30) - 1.0,
    }


def is_same(figures, tolerance):
    """A tenth of the blocks may lie four times as far apart, where highlights, edges and noise gather."""
    return bool(figures["median"] <= tolerance and figures["p90"] <= 4.0 * tolerance)
