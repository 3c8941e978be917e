"""Forecast of a render's time and error from the points of trial_renders.py.

measured = trial_renders.measure(snapshot, 10.0)
told = forecast(measured, pixels, target_error=0.03, samples=8192)
told.seconds.value, told.seconds.low, told.seconds.high, told.error.value ...
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .schedule import FIRST_LOOK, SAMPLES, TARGET, TIME
from .trial_renders import SLOPE, Point

# Standard deviation of the exponent p of error ~ samples^-p, and its limits as multiples of the expected one.
_SLOPE_SPREAD = 0.12
_SLOWEST, _FASTEST = 0.64, 1.82
_FITTED = 4  # number of last points in the fit, which resemble the following samples most
# Least relative uncertainty of a rate: processor clocks and other work vary from minute to minute.
_LEAST_SPREAD = 0.03
_REACH = 1.96  # standard deviations of the 95 % interval of a Gaussian


@dataclass(frozen=True)
class Range:
    """A figure and the interval in which it is expected with 95 % confidence."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Forecast:
    seconds: Range
    error: Range
    samples: Range  # of a pixel, on average
    ended_by: str

    def misses(self, target_error):
        """Whether the limit of samples is expected to end the render above the target error; False if the target is 0."""
        return target_error > 0.0 and self.ended_by == SAMPLES


def forecast(measured, pixels, target_error=0.0, samples=0, time_limit=0.0):
    """Return the Forecast of a render with that many pixels and these settings."""
    refines = target_error > 0.0 or time_limit > 0.0
    curve = _Curve(measured, pixels, refines)
    ends = [(Range(float(samples), float(samples), float(samples)), SAMPLES)]
    if target_error > 0.0:
        ends.append((curve.samples_for(target_error), TARGET))
    if time_limit > 0.0:
        ends.append((curve.samples_within(time_limit - measured.before), TIME))
    # Name the limit with the least expected samples; within the interval any of them may end the render.
    by = min(ends, key=lambda end: end[0].value)[1]
    needed = Range(*(min(getattr(end, name) for end, _ in ends) for name in ("value", "low", "high")))
    seconds = curve.seconds(needed)
    if by == TIME:
        seconds = Range(time_limit, min(seconds.low, time_limit), time_limit)
    return Forecast(seconds, curve.error(needed), needed, by)


def classic_seconds(measured, pixels, samples):
    """Return the seconds of a render in CLASSIC; None if CLASSIC was not measured."""
    return measured.before + measured.classic_seconds * pixels * samples if measured.classic_seconds > 0.0 else None


class _Curve:
    """Error and time of a picture with that many pixels as functions of the samples."""

    def __init__(self, measured, pixels, refines):
        self.measured, self.pixels, self.refines = measured, pixels, refines
        self.size, self.size_spread = _size_factor(measured, pixels)
        self.points = measured.refined if refines else _even_points(measured)
        self.slope, self.slope_spread = slope(self.points, measured.slope)
        # The width of an error's interval falls with the square root of the number of pixels.
        self.narrowing = math.sqrt(min(1.0, measured.pixels / pixels))

    def samples_for(self, target):
        # A render compares its target with the error's upper bound plus the share of light that samples may have missed.
        levels = [self._bound(point) for point in self.points]
        x = _inverse(
            [(math.log(p.samples), _log(b)) for p, b in zip(self.points, levels, strict=True)], _log(target), self.slope
        )
        spread = self._spread(x) / self.slope
        # A render checks its target from FIRST_LOOK samples on.
        return Range(*(max(float(FIRST_LOOK), math.exp(min(x + step * spread, 40.0))) for step in (0.0, -_REACH, _REACH)))

    def samples_within(self, seconds):
        rate, spread = self._rate()
        last = self.points[-1]
        at = last.samples + (seconds / self.pixels - last.seconds / self.measured.pixels) / rate
        if at < last.samples:
            at = last.samples * max(seconds, 0.0) / self.pixels * self.measured.pixels / max(last.seconds, 1e-9)
        return Range(*(max(1.0, at * math.exp(step * spread)) for step in (0.0, -_REACH, _REACH)))

    def error(self, samples):
        logs = [(math.log(p.samples), _log(self.size * p.error)) for p in self.points]

        def at(count, step):
            x = math.log(count)
            return math.exp(_value(logs, x, self.slope) + step * self._spread(x))

        # More samples than expected give less error than expected.
        middle = at(samples.value, 0.0)
        return Range(
            middle, min(at(samples.high, 0.0), at(samples.value, -_REACH)), max(at(samples.low, 0.0), at(samples.value, _REACH))
        )

    def seconds(self, samples):
        rate, spread = self._rate()
        last = self.points[-1]

        def at(count):
            if count >= last.samples:
                return last.seconds / self.measured.pixels + (count - last.samples) * rate
            return _between([(0.0, 0.0)] + [(p.samples, p.seconds / self.measured.pixels) for p in self.points], count)

        steps = ((samples.value, 0.0), (samples.low, -_REACH), (samples.high, _REACH))
        return Range(*(self.measured.before + self.pixels * at(count) * math.exp(step * spread) for count, step in steps))

    def _bound(self, point):
        return (
            self.size * point.error * (point.high / point.error) ** self.narrowing + point.cannot_exclude
            if point.error
            else 0.0
        )

    def _spread(self, x):
        """Return the standard deviation of ln error at ln samples = x."""
        beyond = max(0.0, x - math.log(self.points[-1].samples))
        return math.hypot(self.points[-1].spread, self.size_spread, beyond * self.slope_spread)

    def _rate(self):
        """Return the seconds of a pixel's sample beyond the points, and the standard deviation of their logarithm."""
        rates = _rates(self.points, self.measured.pixels)
        other = _rates(self.measured.even, self.measured.even_pixels)
        spread = 0.5 * math.log(max(rates[-3:]) / min(rates[-3:]))
        # The difference of the rates of the two picture sizes estimates the change from the larger one to the whole picture.
        alike = _rates([p for p in self.measured.refined if p.samples <= FIRST_LOOK], self.measured.pixels)
        return rates[-1], math.hypot(spread, math.log(alike[-1] / other[min(len(alike), len(other)) - 1]), _LEAST_SPREAD)


def slope(points, expected=SLOPE):
    """Return (p, its standard deviation) of error = constant * samples^-p, a weighted fit to the last points.

    The points share samples and are correlated; the deviation assumes independence, which is conservative. The exponent may
    change: half of the difference between the fits of the first and the second half of the points is added.
    """
    known = [p for p in points[-_FITTED:] if p.error > 0.0]
    if len(known) < 2 or known[-1].samples == known[0].samples:
        return expected, _SLOPE_SPREAD
    p, deviation = _line(known)
    if len(known) >= 4:
        half = len(known) // 2
        deviation = math.hypot(deviation, 0.5 * (_line(known[: half + 1])[0] - _line(known[half - 1 :])[0]))
    # Combine the fit with the prior, each weighted by its inverse variance.
    own, other = 1.0 / max(deviation, 1e-3) ** 2, 1.0 / _SLOPE_SPREAD**2
    p = (own * p + other * expected) / (own + other)
    return min(max(p, _SLOWEST * expected), _FASTEST * expected), (own + other) ** -0.5


def _line(points):
    weights = [1.0 / max(p.spread, 0.01) ** 2 for p in points]
    x, y = [math.log(p.samples) for p in points], [math.log(p.error) for p in points]
    total = sum(weights)
    middle_x = sum(w * a for w, a in zip(weights, x, strict=True)) / total
    middle_y = sum(w * b for w, b in zip(weights, y, strict=True)) / total
    square = sum(w * (a - middle_x) ** 2 for w, a in zip(weights, x, strict=True))
    return -sum(w * (a - middle_x) * (b - middle_y) for w, a, b in zip(weights, x, y, strict=True)) / square, square**-0.5


def _size_factor(measured, pixels):
    """Return the ratio of the whole picture's error to that of the larger trial picture, and its logarithm's deviation.

    The squared error has a part from edges that falls as 1 / width: two widths determine both parts.
    """
    growth = math.sqrt(pixels / measured.pixels)
    if growth <= 1.0 or measured.even_pixels >= measured.pixels:
        return 1.0, 0.0
    large, small = _at_pilot(measured.refined), _at_pilot(measured.even)
    if not (large.error > 0.0 and small.error > 0.0):
        return 1.0, 0.0
    step = math.sqrt(measured.pixels / measured.even_pixels) - 1.0
    edges = min(max(((small.error / large.error) ** 2 - 1.0) / step, 0.0), 1.0)
    factor = math.sqrt(1.0 - edges * (1.0 - 1.0 / growth))
    # The model is approximate, and a difference of two errors is less certain than each of them.
    doubt = math.hypot(large.spread, small.spread) / step * (1.0 - 1.0 / growth)
    return factor, math.hypot(0.5 * math.log(factor), doubt)


def _at_pilot(points):
    return min(points, key=lambda p: abs(p.samples - FIRST_LOOK))


def _even_points(measured):
    """Return the larger picture's points, continued with equal samples for all pixels as measured in the smaller one."""
    at = _at_pilot(measured.refined)
    base = _at_pilot(measured.even)
    scale = at.error / base.error if base.error > 0.0 else 1.0
    slower = at.seconds / base.seconds
    later = [p for p in measured.even if p.samples > base.samples]
    grown = [Point(p.samples, scale * p.error, scale * p.high, p.cannot_exclude, slower * p.seconds) for p in later]
    return tuple(p for p in measured.refined if p.samples <= at.samples) + tuple(grown)


def _rates(points, pixels):
    """Return the seconds of a pixel's sample between successive points."""
    before, found = (0.0, 0.0), []
    for p in points:
        found.append(max(p.seconds - before[1], 1e-12) / ((p.samples - before[0]) * pixels))
        before = p.samples, p.seconds
    return found


def _log(value):
    return math.log(max(value, 1e-30))


def _between(points, x):
    """Interpolate linearly between points sorted by x."""
    for (x0, y0), (x1, y1) in zip(points[:-1], points[1:], strict=True):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return points[-1][1]


def _value(logs, x, slope):
    """Return ln error at ln samples = x: interpolated between the points, extrapolated by the slope."""
    for end in (logs[0], logs[-1]):
        if (x <= end[0]) if end is logs[0] else (x >= end[0]):
            return end[1] - slope * (x - end[0])
    return _between(logs, x)


def _inverse(logs, y, slope):
    """Return the least ln samples from which on ln error is at most y."""
    if y <= logs[-1][1]:
        return logs[-1][0] + (logs[-1][1] - y) / slope
    for (x0, y0), (x1, y1) in reversed(list(zip(logs[:-1], logs[1:], strict=True))):
        if y <= y0:
            return x0 + (x1 - x0) * (y0 - y) / max(y0 - y1, 1e-12)
    return logs[0][0] - (y - logs[0][1]) / slope
