"""The course of a still: rounds until samples, target error or time limit end it, told as they go."""

import math

from ..measure import render_report
from ..measure.schedule import SAMPLES, TARGET, TIME, Schedule, TimeShare

# Seconds between polls.
_STEP = 0.1
# Seconds of the longest round on many machines: parts are shown as they come, so that long rounds have no disadvantage.
LONGEST = 1e9
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
        schedule.longest = LONGEST
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
