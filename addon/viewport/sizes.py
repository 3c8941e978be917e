"""Pixel sizes of a view's pictures: coarse pixels first, so that a picture appears at once."""

import math

# Longest seconds of the first picture after a change, and of each finer one before the finest.
_FIRST, _NEXT = 0.03, 0.25
# Weight of the last measured speed in the running mean: views differ in speed.
_NEWEST = 0.5


class PixelSizes:
    """The sequence of pixel sizes, in pixels of the region: powers of two times the finest."""

    def __init__(self):
        self._rate = 0.0  # pixels a second

    def learn(self, pixels, seconds):
        """Update the speed from a picture with one sample per pixel and the seconds of its rays."""
        rate = pixels / max(seconds, 1e-6)
        self._rate = rate if self._rate == 0.0 else self._rate + _NEWEST * (rate - self._rate)

    def first(self, rectangle, finest, coarsest):
        size = finest
        while size < coarsest and self._seconds(rectangle, size) > _FIRST:
            size *= 2
        return size

    def after(self, size, rectangle, finest):
        """Return the next finer size after a picture of this size."""
        while size > finest:
            size = max(finest, size // 2)
            if self._seconds(rectangle, max(finest, size // 2)) > _NEXT:
                break
        return size

    def _seconds(self, rectangle, size):
        """Return the expected seconds of one sample per pixel; infinity before the first measurement."""
        return rectangle.width * rectangle.height / size**2 / self._rate if self._rate > 0.0 else math.inf


def coarsest(rectangle, finest, resolution):
    """Return the coarsest size at which the shorter side still has resolution pixels."""
    size = finest
    while min(rectangle.width, rectangle.height) >= 2 * size * resolution:
        size *= 2
    return size
