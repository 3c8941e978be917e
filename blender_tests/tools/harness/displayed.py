"""Errors of pictures against a converged one of the same engine: as a screen shows them, squared error and FLIP; relative."""

from dataclasses import dataclass

import numpy as np

from .errors import level_of, luminance


def displayed(picture):
    """Return the values of sRGB, from 0 to 1, of linear colours."""
    linear = np.clip(np.asarray(picture, np.float64)[..., :3], 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)


@dataclass(frozen=True)
class Displayed:
    """Two independent converged pictures of equal weight, as displayed, and their luminances."""

    first: np.ndarray
    second: np.ndarray
    luminances: tuple

    @classmethod
    def of(cls, halves):
        first, second = halves
        return cls(displayed(first), displayed(second), (luminance(first), luminance(second)))

    def relative(self, picture):
        """Return the error in the unit of lancer_error, in which Lancer tells it."""
        first, second = self.luminances
        shown = luminance(picture)
        square = np.mean((shown - first) * (shown - second) / level_of(0.5 * (first + second)) ** 2)
        return float(np.sqrt(max(0.0, square)))

    def square(self, picture):
        """Return the mean squared error; the noise of the two references is independent, so their own error cancels."""
        shown = displayed(picture)
        return max(0.0, float(np.mean((shown - self.first) * (shown - self.second))))

    def flip(self, picture):
        """Return the mean of FLIP (Andersson et al., "FLIP: a difference evaluator for alternating images", 2020)."""
        import flip_evaluator

        reference, test = (
            np.ascontiguousarray(image[::-1], np.float32) for image in (0.5 * (self.first + self.second), displayed(picture))
        )
        return float(flip_evaluator.evaluate(reference, test, "LDR", applyMagma=False)[1])
