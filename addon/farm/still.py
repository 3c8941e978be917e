"""The course of a still: rounds until samples, target error or time limit end it, told as they go."""

import math

from ..measure import render_report
from ..measure.schedule import FIRST_LOOK, SAMPLES, TARGET, TIME, Schedule, TimeShare

# Seconds between polls.
_STEP = 0.1
# Seconds of the longest round on many machines: parts are shown as they come, so that long rounds have no disadvantage.
_LONGEST = 1e9
# Least number of rounds on many machines, as a picture is to refine before it is done.
_LEAST_ROUNDS = 4
# Share of the time for reading the error, and least seconds between two readings.
_ERROR_SHARE, _ERROR_EVERY = 0.03, 0.5
# Text after the remaining time: the limit that is expected to end the picture.
_REMAINING = {SAMPLES: "", TARGET: " to the target error", TIME: " of the time limit"}


def render_still(session, tell=None, poll=None):
    """Render a Session or RemoteSession and return its Schedule.

    tell(fraction, text) is called during the render; poll() returns True to end it with the samples that are there.
    """
    schedule, reading = Schedule(session), TimeShare(_ERROR_SHARE, _ERROR_EVERY)
    if getattr(session, "pool", None) is not None:
        set_rounds(schedule)
    while schedule.start():
        finished = False
        while not finished:
            progress = schedule.wait(_STEP)
            finished = progress.finished
            if not finished and poll is not None and poll():
                schedule.cancel()
            elif tell is not None:
                if schedule.samples > 1 and reading.due:
                    reading.spend(schedule.look)
                tell(schedule.fraction, _status(schedule, progress))
    return schedule


def set_rounds(schedule):
    """Let a RemoteSession's Schedule have few rounds: each brings the sums of all its pixels to this machine.

    The first one has as many samples as there are workers, so that the first picture comes as soon as on one machine.
    """
    settings = schedule.settings
    first = min(max(1, schedule.session.pool.workers), max(1, settings.samples >> (_LEAST_ROUNDS - 1)))
    first = min(first, FIRST_LOOK) if settings.refines else first
    schedule.first = 1 << (first.bit_length() - 1)
    schedule.longest = _LONGEST
    schedule.session.overlaps = not settings.refines


def _status(schedule, progress):
    parts = [f"{progress.samples / schedule.pixels:.0f}/{schedule.settings.samples} samples"]
    if schedule.error is not None and schedule.error.known:
        parts.append(f"error {render_report.percent(schedule.error.error)}")
    pool = getattr(schedule.session, "pool", None)
    if pool is not None:
        parts.append(pool.trouble or f"{pool.workers} worker{'s' * (pool.workers != 1)}")
    seconds, reason = schedule.remaining()
    if math.isfinite(seconds):
        parts.append(f"{render_report.duration(seconds)} left{_REMAINING[reason]}")
    return ", ".join(parts)
