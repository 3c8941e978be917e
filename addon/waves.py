"""How many samples to render before the picture is shown again."""

_FIRST_INTERVAL = 0.3
_LONGEST_INTERVAL = 1.0
# Showing may take this share of the time: Blender copies and colour-manages the whole picture each time.
_SHARE = 0.1


class Waves:
    """Waves of 1, 1, 2, 4, 8 ... samples, held back so that one takes no longer than the picture may stand still."""

    def __init__(self, samples):
        self.samples = samples
        self.first = 0
        self.interval = _FIRST_INTERVAL
        self._seconds_per_sample = 0.0

    @property
    def done(self):
        return self.first >= self.samples

    def next(self):
        """(first, count) of the next wave."""
        count = max(1, self.first)
        if self._seconds_per_sample > 0.0:
            count = min(count, max(1, int(max(self.interval, _LONGEST_INTERVAL) / self._seconds_per_sample)))
        return self.first, min(count, self.samples - self.first)

    def took(self, count, seconds):
        self.first += count
        self._seconds_per_sample = seconds / count

    def showing_took(self, seconds):
        self.interval = max(_FIRST_INTERVAL, seconds / _SHARE)
