"""How true a told error is: what lies inside its bar, what an interval holds, what is biased. Arrays in, numbers out.

The error of a picture is the root mean square over its pixels of (luminance - truth) / (truth + 1 % of the mean truth). The
truth is a reference with noise of its own, known from its parts: that noise is added to bars and taken off errors.
"""

from dataclasses import dataclass

import numpy as np

BAR = 1.96
_BT709 = np.array([0.2126, 0.7152, 0.0722])
_FLOOR = 0.01
# A pixel's three channels and its bar are floats: four roundings of 2^-24, and one bit to spare.
_ROUNDING = 2.0**-21
BLOCK = 16


def luminance(picture):
    """(height, width) in double."""
    return np.asarray(picture, np.float64)[..., :3] @ _BT709


@dataclass(frozen=True)
class Reference:
    """Luminances of independent pictures of equal weight, (parts, height, width)."""

    parts: np.ndarray

    @property
    def mean(self):
        return self.parts.mean(axis=0)

    @property
    def variance(self):
        """Of the mean."""
        return self.parts.var(axis=0, ddof=1) / len(self.parts)

    @property
    def level(self):
        """What errors are relative to."""
        mean = self.mean
        return mean + _FLOOR * mean.mean()

    @property
    def error(self):
        """Of the reference itself."""
        return float(np.sqrt(np.mean(self.variance / self.level**2)))

    @property
    def noisy(self):
        """Which pixels have any noise; the others are right at the first sample."""
        return np.ptp(self.parts, axis=0) > _ROUNDING * np.abs(self.mean)


def real_error(picture, reference):
    """Of a picture's luminances, less what the reference's own noise adds."""
    level = reference.level
    squares = np.mean(((picture - reference.mean) / level) ** 2) - np.mean(reference.variance / level**2)
    return float(np.sqrt(max(0.0, squares)))


def inside(picture, bars, reference):
    """Which pixels lie within 1.96 standard errors of the truth."""
    reach = BAR * np.sqrt(np.asarray(bars, np.float64) ** 2 + reference.variance)
    return np.abs(picture - reference.mean) <= reach + _ROUNDING * np.abs(reference.mean)


def scores(pictures, reference):
    """Difference of two means of independent pictures, (count, ...) each, in standard errors of a Gaussian.

    Few pictures know their spread badly: Welch's t is turned into the Gaussian number of equal chance (Wallace, "Bounds on
    normal approximations to Student's and the chi-square distributions", 1959).
    """
    a, b = pictures.var(axis=0, ddof=1) / len(pictures), reference.var(axis=0, ddof=1) / len(reference)
    difference = pictures.mean(axis=0) - reference.mean(axis=0)
    clean = np.abs(difference) <= _ROUNDING * np.abs(reference.mean(axis=0))
    with np.errstate(divide="ignore", invalid="ignore"):
        t = difference / np.sqrt(a + b)
        freedom = (a + b) ** 2 / (a**2 / (len(pictures) - 1) + b**2 / (len(reference) - 1))
        z = np.sign(t) * (8 * freedom + 1) / (8 * freedom + 3) * np.sqrt(freedom * np.log1p(t * t / freedom))
    return np.where(clean, 0.0, np.where(np.isnan(z), np.inf, z))


def blocks(pictures):
    """Means over squares of 16 x 16, what is left over at the edges counted with their neighbours: (count, rows, columns)."""
    height, width = pictures.shape[1:]
    rows, columns = (np.arange(max(1, size // BLOCK)) * BLOCK for size in (height, width))
    sums = np.add.reduceat(np.add.reduceat(pictures, rows, axis=1), columns, axis=2)
    return sums / np.outer(np.diff([*rows, height]), np.diff([*columns, width]))


def bias(pictures, reference):
    """z of the whole picture and of its blocks; and how much the mean of all pictures is off, with its standard error."""
    whole = scores(pictures.mean(axis=(1, 2)), reference.parts.mean(axis=(1, 2)))
    parts = scores(blocks(pictures), blocks(reference.parts))
    truth = reference.mean.mean()
    of_pictures, of_parts = (a.mean(axis=(1, 2)) for a in (pictures, reference.parts))
    spread = np.sqrt(of_pictures.var(ddof=1) / len(pictures) + of_parts.var(ddof=1) / len(of_parts))
    return {
        "whole": float(whole),
        "relative": float(of_pictures.mean() / truth - 1.0),
        "relative_error": float(spread / truth),
        "blocks": [float(z) for z in parts.ravel()],
    }


def root_mean_square(values):
    return float(np.sqrt(np.mean(np.square(np.asarray(values, np.float64)))))
