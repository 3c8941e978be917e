"""Errors of pictures against a converged one.

The error of a picture is the root mean square over its pixels of (luminance - truth) / (truth + 1 % of the mean truth), like
the library's estimate: lancer_error of lancer.h. The truth is a reference whose own noise is estimated from its parts, and
subtracted from errors, in squares.
"""

from dataclasses import dataclass

import numpy as np

_BT709 = np.array([0.2126, 0.7152, 0.0722])
_FLOOR = 0.01
# A pixel's three channels and its bar are floats: four roundings of 2^-24, and one bit to spare.
ROUNDING = 2.0**-21


def luminance(picture):
    """Return the luminances, (height, width) in double precision."""
    return np.asarray(picture, np.float64)[..., :3] @ _BT709


def level_of(mean):
    """Return the level that errors are relative to."""
    return mean + _FLOOR * mean.mean()


def root_mean_square(values):
    return float(np.sqrt(np.mean(np.square(np.asarray(values, np.float64)))))


@dataclass(frozen=True)
class Reference:
    """Luminances of independent pictures of equal weight, (parts, height, width)."""

    parts: np.ndarray

    @classmethod
    def of(cls, pictures):
        return cls(np.stack([luminance(picture) for picture in pictures]))

    @property
    def mean(self):
        return self.parts.mean(axis=0)

    @property
    def variance(self):
        """Return the variance of the mean."""
        return self.parts.var(axis=0, ddof=1) / len(self.parts)

    @property
    def level(self):
        return level_of(self.mean)

    @property
    def error(self):
        """Return the error of the reference itself."""
        return float(np.sqrt(self._own_square()))

    def _own_square(self):
        return np.mean(self.variance / self.level**2)

    @property
    def noisy(self):
        """Return which pixels have noise; the others are exact at the first sample."""
        return np.ptp(self.parts, axis=0) > ROUNDING * np.abs(self.mean)

    def distance(self, picture):
        """Return the error of a picture's luminances, less the reference's own noise."""
        square = np.mean(((picture - self.mean) / self.level) ** 2) - self._own_square()
        return float(np.sqrt(max(0.0, square)))

    def split(self, pictures):
        """Return (noise, bias) of one picture, from the luminances of several independent ones.

        The squared distance of their mean from the reference is that of the bias, plus a share of their noise, plus the
        reference's own noise.
        """
        mean, level = sum(pictures) / len(pictures), self.level
        noise = sum(np.mean(((picture - mean) / level) ** 2) for picture in pictures) / (len(pictures) - 1)
        bias = np.mean(((mean - self.mean) / level) ** 2) - noise / len(pictures) - self._own_square()
        return float(np.sqrt(noise)), float(np.sqrt(max(0.0, bias)))
