"""The truth of error estimates: the pixels inside their error bars, and biases. Functions of arrays that return numbers.

The noise of the reference is added to the error bars.
"""

import numpy as np

from tools.harness.errors import ROUNDING, level_of

BAR = 1.96
BLOCK = 16


def inside(picture, bars, reference):
    """Return which pixels lie within 1.96 standard errors of the truth."""
    reach = BAR * np.sqrt(np.asarray(bars, np.float64) ** 2 + reference.variance)
    return np.abs(picture - reference.mean) <= reach + ROUNDING * np.abs(reference.mean)


def scores(pictures, reference):
    """Return the difference of two means of independent pictures, (count, ...) each, in standard errors of a Gaussian.

    The spread of few pictures is uncertain: Welch's t is converted to the Gaussian number of equal probability (Wallace,
    "Bounds on normal approximations to Student's and the chi-square distributions", 1959).
    """
    a, b = pictures.var(axis=0, ddof=1) / len(pictures), reference.var(axis=0, ddof=1) / len(reference)
    difference = pictures.mean(axis=0) - reference.mean(axis=0)
    clean = np.abs(difference) <= ROUNDING * np.abs(reference.mean(axis=0))
    with np.errstate(divide="ignore", invalid="ignore"):
        t = difference / np.sqrt(a + b)
        freedom = (a + b) ** 2 / (a**2 / (len(pictures) - 1) + b**2 / (len(reference) - 1))
        z = np.sign(t) * (8 * freedom + 1) / (8 * freedom + 3) * np.sqrt(freedom * np.log1p(t * t / freedom))
    return np.where(clean, 0.0, np.where(np.isnan(z), np.inf, z))


def blocks(pictures):
    """Return the means of blocks of 16 x 16, (count, rows, columns); blocks at the edges include the remaining pixels."""
    height, width = pictures.shape[1:]
    rows, columns = (np.arange(max(1, size // BLOCK)) * BLOCK for size in (height, width))
    sums = np.add.reduceat(np.add.reduceat(pictures, rows, axis=1), columns, axis=2)
    return sums / np.outer(np.diff([*rows, height]), np.diff([*columns, width]))


def bias(pictures, reference):
    """Return z of the whole picture and of its blocks, and the bias of the mean of all pictures with its standard error.

    off: the bias of each block, relative like errors: to its luminance plus 1 % of the picture's mean.
    """
    whole = scores(pictures.mean(axis=(1, 2)), reference.parts.mean(axis=(1, 2)))
    of_blocks, true_blocks = blocks(pictures), blocks(reference.parts)
    parts = scores(of_blocks, true_blocks)
    off = (of_blocks.mean(axis=0) - true_blocks.mean(axis=0)) / level_of(true_blocks.mean(axis=0))
    truth = reference.mean.mean()
    of_pictures, of_parts = (a.mean(axis=(1, 2)) for a in (pictures, reference.parts))
    spread = np.sqrt(of_pictures.var(ddof=1) / len(pictures) + of_parts.var(ddof=1) / len(of_parts))
    return {
        "whole": float(whole),
        "relative": float(of_pictures.mean() / truth - 1.0),
        "relative_error": float(spread / truth),
        "blocks": [float(z) for z in parts.ravel()],
        "off": [float(share) for share in off.ravel()],
    }
