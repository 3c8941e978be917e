"""Work beside the rendering that may take no more than its share of the time."""

import contextlib
import time


class Pace:
    """share: of the time; shortest: seconds between two times at least."""

    def __init__(self, share, shortest):
        self._share = share
        self._shortest = shortest
        self._last = None
        self.cost = 0.0  # seconds that it took last

    @property
    def interval(self):
        return max(self._shortest, self.cost / self._share)

    @property
    def begun(self):
        return self._last is not None

    @property
    def due(self):
        return self._last is None or time.monotonic() - self._last > self.interval

    def spend(self, work):
        with self.spending():
            work()

    @contextlib.contextmanager
    def spending(self):
        before = time.monotonic()
        yield
        self._last = time.monotonic()
        self.cost = self._last - before
