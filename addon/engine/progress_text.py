"""The line about a running render: the remaining time, the error, samples and speed."""

import math

from ..measure import render_report
from ..measure.schedule import SAMPLES, TARGET, TIME
from . import many_machines

# Text after the remaining time: the limit that is expected to end the render.
_REMAINING = {SAMPLES: "", TARGET: " to the target error", TIME: " of the time limit"}


def progress_text(schedule, progress):
    """Return the line. Small windows cut off its end: the most important part comes first."""
    rate = progress.rays / progress.seconds / 1e6 if progress.seconds > 0.0 else 0.0
    seconds, reason = schedule.remaining()
    samples = progress.samples / schedule.pixels
    parts = [f"Remaining {_clock(seconds)}{_REMAINING[reason]}"]
    if schedule.error is not None and schedule.error.known:
        parts.append(f"Error {render_report.interval(schedule.error)}")
    parts += [f"Sample {samples:.0f}/{schedule.settings.samples}", f"{rate:.2f} M rays/s", *many_machines.status(schedule)]
    return " | ".join(parts)


def _clock(seconds):
    if not math.isfinite(seconds):
        return "unknown"
    minutes, seconds = divmod(int(seconds + 0.5), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes:02}:{seconds:02}"
