"""Schedule of a session's sample ranges until samples, a target error or a time limit end the render.

schedule = Schedule(session)
while schedule.start():
    while not schedule.wait(0.05).finished:
        ...
schedule.reason, session.error()
"""

import contextlib
import math
import time

# Longest range in seconds: without target error and time limit, ranges have 1, 1, 2, 4 ... samples up to it, then all that fit.
_LONGEST_RANGE = 1.0
# Samples from which on the error is certain enough for decisions.
FIRST_LOOK = 16
# Total probability of ending a render above its target; the first check gets one half of it, the second a quarter, and so on.
_MISTAKE = 0.05

# The samples rise with this power of the ratio of two errors, of a picture and of a denoised one: 0.33 is the measured exponent
# of denoised pictures from 16 to 256 samples of twenty scenes.
POWER, DENOISED_POWER = 2, 3

SAMPLES, TARGET, TIME, CANCELLED = "samples", "target error", "time limit", "cancelled"


class Schedule:
    """Renders a Session by its settings: samples, target_error, time_limit.

    started: the start of the time limit, by time.monotonic().
    Without target and time limit all pixels get equal samples. With either, each range doubles the samples of all pixels, and
    from FIRST_LOOK on only those of the pixels that reduce the error most (Session.refine).
    denoised(): returns the upper end of the denoised picture's error, or None if unknown; the target is then of that picture.
    """

    def __init__(self, session, started=None, denoised=None):
        self.session = session
        self.settings = session.settings
        self.reason = None  # why the render ended
        self.longest = _LONGEST_RANGE
        self.first = 1  # samples of the first range: a power of two, at most FIRST_LOOK
        self.samples = 0  # of every pixel, at least
        self.error = None  # the last PictureError that was read
        self.confidence = 1.0 - _MISTAKE
        self.reserve = 0.0  # seconds of the time limit to keep for work after the last sample
        self._started = time.monotonic() if started is None else started
        self._looks = 0
        self._refining = False
        self._before = (0, False)  # these two before the last range was judged
        self._next = 0  # samples of the running range for all pixels; 0: only some pixels get more
        self._rest = None  # ranges of an earlier render's range that are left
        self._stopping = False
        self._range = (0.0, 0)  # start time of the range, pixel samples before it
        self._seconds_per_sample = 0.0
        self._progress = None
        self._denoised = denoised
        self._judged = False  # whether the last range has been compared with the limits
        self._checked = None  # the PictureError that was compared with the target
        self._bound = None  # the last error that was compared with the target
        self.pixels = session.camera.region_width * session.camera.region_height

    def start(self):
        """Start the next range; return False if the render is over."""
        if self.over:
            return False
        if self._rest is not None:
            rest, self._rest = self._rest, None
            self.session.render_in_steps(rest)
        else:
            self._next = 0
            self._refining = self._refining and self._refine()
            if not self._refining:
                self._next = self._count()
                if self._next == 0:
                    self.reason = SAMPLES
                    return False
                self.session.render(self.samples, self._next)
        self._range = (time.monotonic(), self._progress.samples if self._progress else 0)
        return True

    def wait(self, seconds):
        """Call Session.wait and stop the range if the time limit has passed."""
        progress = self.session.wait(seconds)
        if progress.finished:
            self._finished(progress)
        elif self.late and not self._stopping and self.samples > 0:
            self._stopping = True
            self.session.stop()
        self._progress = progress
        return progress

    def cancel(self):
        self.session.cancel()

    def state(self, is_running):
        """Return what continue_from() needs as numbers by name. is_running: whether ranges of the running range are left."""
        # With other limits the last range has to be judged once more.
        again = self._judged and not is_running
        looks, refining = self._before if again else (self._looks, self._refining)
        return {"samples": self.samples, "next": self._next, "looks": looks, "refining": refining}

    def continue_from(self, state, rest):
        """Continue a render with this state, whose samples the session has. rest: the ranges that are left of its range."""
        self.samples, self._next = state["samples"], state["next"]
        self._looks, self._refining = self._before = state["looks"], state["refining"]
        if len(rest):
            self._rest, self._judged = rest, True
        else:
            self.samples, self._next = self.samples + self._next, 0

    @property
    def over(self):
        """Whether no further range follows; reads the error if there is a target.

        A range is judged once, however often this is asked: a picture must not depend on how often it is shown.
        """
        if self.reason is None and not self._judged and (self._progress is None or self._progress.finished):
            self._judged = True
            self._before = self._looks, self._refining
            self.reason = self._ended()
        return self.reason is not None

    @property
    def late(self):
        limit = self.settings.time_limit
        return limit > 0.0 and time.monotonic() >= self._started + limit - self.reserve

    def look(self):
        """Read and return the current error."""
        self.error = self.session.error()
        return self.error

    def remaining(self):
        """Return (seconds, reason) of the limit that is expected to end the render first; infinity while unknown."""
        ends = []
        limit = self.settings.time_limit
        if limit > 0.0:
            ends.append((max(0.0, self._started + limit - time.monotonic()), TIME))
        progress = self._progress
        if progress is not None and progress.samples > 0 and progress.seconds > 0.0:
            rate = progress.samples / progress.seconds
            target = self.settings.target_error
            known = self.error is not None and self.error.known
            if target > 0.0 and known:
                needed = self._needed(progress, target)
                ends.append((needed / rate, TARGET))
            # With a target the limit of samples is usually never reached: ignore it until the error is known.
            if target <= 0.0 or known:
                ends.append((max(0.0, self.settings.samples * self.pixels - progress.samples) / rate, SAMPLES))
        return min(ends, default=(math.inf, SAMPLES))

    @property
    def fraction(self):
        """Expected share of the render that is done."""
        seconds, reason = self.remaining()
        elapsed = time.monotonic() - self._started
        if reason is SAMPLES:
            done = self._progress.samples if self._progress else 0
            return min(1.0, done / (self.settings.samples * self.pixels))
        return min(1.0, elapsed / max(elapsed + seconds, 1e-9))

    def _needed(self, progress, target):
        """Return the pixel samples still needed for the target: as planned by refine, or by error ~ samples^-1/2."""
        if self._refining and self.error.planned_samples > 0.0:
            return max(0.0, self.error.planned_samples - (progress.samples - self._range[1]))
        if self.of_denoised and self._bound is not None:
            return progress.samples * max(0.0, (self._bound / target) ** DENOISED_POWER - 1.0)
        return progress.samples * max(0.0, (self.error.bound / target) ** POWER - 1.0)

    def _ended(self):
        if self._progress is not None and self._progress.cancelled:
            return CANCELLED
        if self.samples > 0 and self.late:
            return TIME
        if not self._refining and self.samples >= self.settings.samples:
            return SAMPLES
        target = self.settings.target_error
        if self.samples >= FIRST_LOOK:
            may_double = _is_power(self.samples) and 2 * self.samples <= self.settings.samples
            self._refining = self.settings.refines and may_double or self._refining
            if target > 0.0:
                self.confidence = 1.0 - 2.0 * _MISTAKE / 2.0 ** (self._looks + 1)
                self._looks += 1
                self.error = self._checked = self.session.error(self.confidence)
                self._bound = self._compared()
                if self._bound <= target:
                    return TARGET
        return None

    @property
    def of_denoised(self):
        """Whether the target is that of the denoised picture."""
        return self._denoised is not None

    def _compared(self):
        """Return the bound on the error that the target is about."""
        high = self._denoised() if self.of_denoised else None
        # Denoising invents no light that no sample has met.
        return self.error.bound if high is None else min(self.error.bound, high + self.error.cannot_exclude)

    def _ratio(self):
        """Return the target of the picture before denoising, as a multiple of the target."""
        return self._checked.bound / self._bound if self._bound and self._checked.known else 1.0

    def _refine(self):
        """Start a round of refinement; return False if no pixel can be doubled: all then have the largest power of two."""
        if self.session.refine(self.settings.target_error * self._ratio(), self.confidence):
            return True
        self.samples = self.session.error().most_samples
        return False

    def _count(self):
        """Return the samples of the next range for all pixels."""
        count = max(self.first, self.samples)
        if self.settings.refines and not _is_power(self.samples):
            # An earlier render has ended here.
            count = (1 << self.samples.bit_length()) - self.samples
        if not self.settings.refines and self._seconds_per_sample > 0.0:
            # Multiples of an eighth of the largest power of two keep the film small.
            unit = max(1, (1 << self.samples.bit_length()) // 16)
            count = min(count, max(1, int(self.longest / self._seconds_per_sample / unit)) * unit)
        return min(count, self.settings.samples - self.samples)

    def _finished(self, progress):
        self._judged = False
        self._seconds_per_sample = (time.monotonic() - self._range[0]) / max(1, self._next)
        if self._stopping:
            self.reason = TIME
        elif not self._refining and not progress.cancelled:
            self.samples, self._next = self.samples + self._next, 0


def _is_power(samples):
    return samples & (samples - 1) == 0


class TimeShare:
    """Repeated work during a render, limited to a share of the time.

    share: the work's share of the time; shortest: least seconds between two runs of the work.
    """

    def __init__(self, share, shortest):
        self._share = share
        self._shortest = shortest
        self._last = None
        self.cost = 0.0  # seconds of the last run

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
