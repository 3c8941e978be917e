"""Compare pictures of two renderers by the means of blocks, which have little noise; and write pictures to files."""

import os

import numpy as np

from scenes.parity import png

BLOCK = 8


def block_means(picture, size=BLOCK):
    """Return the means of squares of pixels; remaining pixels at the upper and right edge are left out."""
    height, width = (length // size * size for length in picture.shape[:2])
    blocks = np.asarray(picture, np.float64)[:height, :width, :3].reshape(height // size, size, width // size, size, 3)
    return blocks.mean(axis=(1, 3))


def difference(ours, theirs):
    """Return median and 90th percentile of the blocks' differences, and the levels' difference, as shares of the level."""
    a, b = block_means(ours), block_means(theirs)
    level = float(a.mean())
    distances = np.abs(a - b).mean(axis=2) / max(level, 1e-30)
    return {
        "median": float(np.median(distances)),
        "p90": float(np.percentile(distances, 90)),
        "level": float(b.mean()) / max(level, 1e-30) - 1.0,
    }


def is_same(figures, tolerance):
    """Return whether pictures agree. A tenth of the blocks, with highlights, edges and noise, may differ 4 times as much."""
    return bool(figures["median"] <= tolerance and figures["p90"] <= 4.0 * tolerance)


def write_picture(path, picture, white):
    """Write linear values, row 0 at the bottom, through the sRGB curve; the value white becomes 1."""
    path.write_bytes(png.encode(png.display(picture[::-1, :, :3], 1.0 / white)))


def write_pair(folder, name, ours, theirs):
    """Write ours, theirs and their difference x 8, row 0 at the top, scaled by the brightness of theirs. Return the names."""
    # Show the brightest hundredth as white, so that dark passes are visible, too.
    brightest = float(np.percentile(np.abs(np.nan_to_num(theirs)), 99))
    exposure = 1.0 / brightest if brightest > 0.0 else 1.0
    difference = 8.0 * np.abs(ours - theirs)
    names = []
    for suffix, picture in (("lancer", ours), ("cycles", theirs), ("difference", difference)):
        names.append(f"{name}-{suffix}.png")
        with open(os.path.join(folder, names[-1]), "wb") as file:
            file.write(png.encode(png.display(picture, exposure)))
    return names
