"""Simulated time: events in order, what waits for them, and what serves one request after another."""

import heapq
import itertools
import math
import queue

_START = 1e6
# Simulated seconds after which nobody expects an end.
_LONGEST = 1e6


class Stalled(Exception):
    """Somebody waits for what will not happen any more."""


class Clock:
    """In place of the module time. The caller's own work is advance(); other things happen meanwhile."""

    def __init__(self):
        # The farm's code takes a clock near 0 for a look that is due only later.
        self.now = _START
        self._events = []
        self._order = itertools.count()

    @property
    def elapsed(self):
        return self.now - _START

    def after(self, seconds, act):
        """Call act() in that many seconds."""
        heapq.heappush(self._events, (self.now + seconds, next(self._order), act))

    def advance(self, seconds):
        self._run(self.now + seconds, lambda: False)

    def wait(self, is_ready, seconds=math.inf):
        """Let time pass until is_ready(), or for that long; return whether it is ready."""
        if self._run(self.now + seconds, is_ready):
            return True
        if math.isinf(seconds):
            raise Stalled
        return False

    def monotonic(self):
        return self.now

    def sleep(self, seconds):
        self.advance(seconds)

    def _run(self, until, is_ready):
        while not is_ready():
            if not self._events or self._events[0][0] > until:
                if math.isfinite(until):
                    self.now = until
                return False
            self.now, _, act = heapq.heappop(self._events)
            if self.elapsed > _LONGEST:
                raise Stalled
            act()
        return True


class Server:
    """Something that does one thing at a time, in order of arrival: a process, a link of a network."""

    def __init__(self, clock):
        self.clock = clock
        self.busy = 0.0  # seconds
        self.ends = 0.0  # when all requests so far are done

    def serve(self, seconds, act):
        """Call act() after that much work, once earlier requests are done."""
        self.ends = max(self.ends, self.clock.now) + seconds
        self.busy += seconds
        self.clock.after(self.ends - self.clock.now, act)


class Queues:
    """In place of the module queue."""

    Empty = queue.Empty

    def __init__(self, clock):
        self._clock = clock

    def Queue(self):  # noqa: N802
        return _Queue(self._clock)


class _Queue:
    def __init__(self, clock):
        self._clock = clock
        self._items = []

    def put(self, item):
        self._items.append(item)

    def get(self, timeout):
        if not self._clock.wait(lambda: self._items, timeout):
            raise queue.Empty
        return self._items.pop(0)

    def get_nowait(self):
        if not self._items:
            raise queue.Empty
        return self._items.pop(0)
