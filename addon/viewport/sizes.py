"""How coarse the pixels of a view are, so that its first picture is there at once."""

import math

# Seconds that the first picture after a change may take, and each finer one before the finest.
_FIRST, _NEXT = 0.07, 0.25
# The speed that was measured last counts this much: the rays of one view are not those of another.
_NEWEST = 0.5


class PixelSizes:
    """Sizes are sides of a picture's pixels in pixels of the region, powers of two times the finest."""

    def __init__(self):
        self._rate = 0.0  # pixels a second

    def learn(self, pixels, seconds):
        """From a picture of one sample a pixel and the seconds that its rays took."""
        rate = pixels / max(seconds, 1e-6)
        self._rate = rate if self._rate == 0.0 else self._rate + _NEWEST * (rate - self._rate)

    def first(self, rectangle, finest, coarsest):
        size = finest
        while size < coarsest and self._seconds(rectangle, size) > _FIRST:
            size *= 2
        return size

    def after(self, size, rectangle, finest):
        """The next size once a picture of this one is shown."""
        while size > finest:
            size = max(finest, size // 2)
            if self._seconds(rectangle, max(finest, size // 2)) > _NEXT:
                break
        return size

    def _seconds(self, rectangle, size):
        """What one sample of each pixel is expected to take; for ever while nothing is known."""
        return rectangle.width * rectangle.height / size**2 / self._rate if self._rate > 0.0 else math.inf


def coarsest(rectangle, finest, resolution):
    """The size at which the shorter side still has that many pixels."""
    size = finest
    while min(rectangle.width, rectangle.height) >= 2 * size * resolution:
        size *= 2
    return size
