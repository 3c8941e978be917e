"""How far pictures are from a reference: RMS over pixels of the difference of luminance, each relative to the reference's own
luminance plus 1 % of its mean; and what of it is noise, what bias.
"""

import math
import statistics

import numpy as np

_BT709 = (0.2126, 0.7152, 0.0722)
_FLOOR = 0.01


def luminance(picture):
    return np.asarray(picture, np.float64)[..., :3] @ _BT709


class Reference:
    """The mean of two independent halves; their difference tells its own error."""

    def __init__(self, first, second):
        first, second = luminance(first), luminance(second)
        self.picture = 0.5 * (first + second)
        self.scale = self.picture + _FLOOR * self.picture.mean()
        # The mean of two has half the variance of one, and their difference twice that of one.
        self.square = self._mean_square(0.5 * (first - second))
        self.error = math.sqrt(self.square)

    def _mean_square(self, difference):
        return float(np.mean((difference / self.scale) ** 2))

    def distance(self, picture):
        """Of one picture, less what the reference's own noise adds."""
        return math.sqrt(max(0.0, self._mean_square(luminance(picture) - self.picture) - self.square))

    def split(self, pictures):
        """(noise, bias) of one picture, from several independent ones.

        Their mean is as far from the reference as the bias, a share of their noise and the reference's own noise make it.
        """
        pictures = [luminance(picture) for picture in pictures]
        mean = sum(pictures) / len(pictures)
        noise = sum(self._mean_square(picture - mean) for picture in pictures) / (len(pictures) - 1)
        bias = self._mean_square(mean - self.picture) - noise / len(pictures) - self.square
        return math.sqrt(noise), math.sqrt(max(0.0, bias))


def middle(points):
    """[(seconds, error, least error, greatest error)] of several seeds' points, [(seconds, error)] each."""
    result = []
    for of_seeds in zip(*points, strict=True):
        seconds, errors = zip(*of_seeds, strict=True)
        result.append((statistics.median(seconds), statistics.median(errors), min(errors), max(errors)))
    return result


def seconds_to(points, error):
    """Seconds until a curve of (seconds, error, ...) comes to that error, between points by their logarithms; else None."""
    for (t0, e0, *_), (t1, e1, *_) in zip(points[:-1], points[1:], strict=True):
        if e0 >= error >= e1 and e0 > e1:
            share = math.log(e0 / error) / math.log(e0 / e1)
            return t0 * (t1 / t0) ** share
    return None


def slope(points):
    """p of error = constant * seconds^-p, by least squares of logarithms."""
    x, y = np.log([point[0] for point in points]), np.log([point[1] for point in points])
    return -float(np.polyfit(x, y, 1)[0])
