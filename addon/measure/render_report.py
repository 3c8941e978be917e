"""Figures of a finished render and sentences about them, for the file's metadata, the terminal and the panel."""

import dataclasses
import math
from enum import IntEnum

from ..bindings.enums import Integrator
from ..bindings.numbered_pass import extras
from ..messages.messages import Messages
from ..messages.severity import Severity
from .schedule import CANCELLED, DENOISED_POWER, POWER, SAMPLES, TARGET, TIME

# Shares of light below this are not reported.
NOTHING = 5e-5
# Limits that the artist sets, by the entry of a render's statistics with the share of the light that each has removed.
REMOVED = {
    "error_clipped": "clamping has removed",
    "error_clipped_direct": "clamping of direct light has removed",
    "error_cut": "limits of kinds of bounces and of lamps have removed about",
    "error_no_caustics": "the lack of caustics has removed about",
}
# Settings that take light away or add some, by the entry with the share that they take away, which has a neighbour ..._error.
CHANGED = {"error_filtered": "Filter Glossy", "error_guessed": "Fast GI"}
BIASES = (*REMOVED, *(f"{name}{end}" for name in CHANGED for end in ("", "_error")))


def percent(share):
    """Return a share in percent, rounded to two or three digits; "unknown" if it is not finite."""
    if not math.isfinite(share):
        return "unknown"
    return f"{100.0 * share:.3g} %" if share >= 0.0995 else f"{100.0 * share:.2g} %"


def changed_light(numbers, name):
    """Return what a setting has done to the light, by an entry of CHANGED; "" if there is nothing to report."""
    share, half = numbers.get(name, 0.0), numbers.get(f"{name}_error", 0.0)
    if max(abs(share), half) <= NOTHING:
        return ""
    if math.isinf(half):
        return f"{CHANGED[name]} has changed the light by a share that is unknown: without it the picture may be black"
    done = "taken away" if share > 0.0 else "added"
    return f"{CHANGED[name]} has {done} about {percent(abs(share))} of the light, give or take {percent(half)}"


def interval(numbers):
    """Return the error and its 95 % interval as text; numbers: a PictureError."""
    return f"{percent(numbers.error)} ({percent(numbers.low)} to {percent(numbers.high)})"


def duration(value):
    """Return seconds as text with about two digits, in seconds, minutes or hours; "unknown" if not finite."""
    if not math.isfinite(value):
        return "unknown"
    for limit, unit, name in ((99.5, 1.0, "s"), (99.5 * 60.0, 60.0, "min"), (math.inf, 3600.0, "h")):
        if value < limit:
            value /= unit
            return f"{value:.1f} {name}" if value < 9.95 else f"{value:.0f} {name}"


def account(session, schedule):
    """Return the statistics of a Session that a Schedule has rendered, as a dict for engine.last_statistics."""
    statistics, error = session.statistics(), session.error()
    numbers = dataclasses.asdict(statistics)
    numbers["pixel_samples"] = numbers["samples"]
    numbers["samples"] = error.least_samples
    numbers["samples_most"] = error.most_samples
    numbers["samples_mean"] = statistics.samples / schedule.pixels
    numbers["seconds"] = statistics.render_seconds
    numbers["rays"] = statistics.rays
    numbers["rays_per_second"] = statistics.rays_per_second
    numbers["version"] = session.library.lancer_version().decode()
    numbers["ended_by"] = schedule.reason or CANCELLED
    numbers["target_of_denoised"] = schedule.of_denoised
    # As long as nothing is denoised.
    numbers |= {"denoised": "", "denoised_moved": 0.0}
    numbers |= {f"denoised_error{end}": math.inf for end in ("", "_low", "_high")}
    numbers["error"] = error.error
    for name in ("low", "high", "cannot_exclude", *(name[len("error_") :] for name in BIASES), "missing"):
        numbers[f"error_{name}"] = getattr(error, name)
    return numbers


def left_out(numbers, place="pixel"):
    """Return Messages about samples that were not finite. numbers: of the statistics; place: what the picture consists of."""
    count = numbers["invalid_samples"]
    if not count:
        return Messages()
    first = f"{place} ({numbers['invalid_x']}, {numbers['invalid_y']}), sample {numbers['invalid_sample']}"
    return Messages([f"{count} samples were not finite and are left out, the first at {first}"], Severity.WRONG)


def of_layers(statistics):
    """Return the accuracy lines of all view layers in engine.last_statistics."""
    return [line for numbers in statistics.get("layers", {"": statistics}).values() for line in numbers["accuracy"]]


def lines(numbers, settings, layer=""):
    """Return sentences about the accuracy of a render: numbers as in engine.last_statistics, settings of its snapshot.

    layer: the view layer's name if there are several. The first line reports the error, or that the target was missed.
    """
    told = [*missed(numbers, settings), *_accuracy(numbers, settings)]
    return [f"view layer '{layer}': {line}" for line in told] if layer else told


def missed(numbers, settings):
    """Yield a sentence if the target error was not reached, with the settings that are expected to reach it."""
    target, of_denoised = settings.target_error, numbers["target_of_denoised"] and numbers["denoised"]
    name = "denoised_error" if of_denoised else "error"
    bound = numbers[f"{name}_high"] + numbers["error_cannot_exclude"]
    if target <= 0.0 or bound <= target or numbers["ended_by"] in (TARGET, CANCELLED):
        return
    if not math.isfinite(bound):
        yield f"{percent(target)} was not reached: the error is unknown until each pixel has two samples"
        return
    more = (bound / target) ** (DENOISED_POWER if of_denoised else POWER)
    helps = []
    samples = numbers["samples_most"] * more
    if numbers["ended_by"] == SAMPLES or samples > settings.samples:
        helps.append(f"about {_two_digits_up(samples)} Samples")
    if settings.time_limit > 0.0:
        seconds = settings.time_limit + numbers["seconds"] * (more - 1.0)
        if numbers["ended_by"] == TIME:
            helps.append(f"a Time Limit of about {duration(seconds)}")
    error, most = percent(numbers[name]), percent(bound)
    yield f"{percent(target)} was not reached: {error}, at most {most}; it would take {' and '.join(helps)}"


def _two_digits_up(number):
    step = 10 ** max(0, math.floor(math.log10(number)) - 1)
    return math.ceil(number / step) * step


def _accuracy(numbers, settings):
    samples = f"{numbers['samples']} samples"
    if numbers["samples_most"] > numbers["samples"]:
        samples = f"{numbers['samples']} to {numbers['samples_most']} samples a pixel, {numbers['samples_mean']:.0f} on average"
    how = CANCELLED if numbers["ended_by"] == CANCELLED else f"ended by {numbers['ended_by']}"
    lights, paths = numbers["split_lights"], numbers["split_paths"]
    if lights > 1 or paths > 1:
        samples += f", each of {lights} light{'s' * (lights > 1)} and {paths} path{'s' * (paths > 1)},"
    ended = f"{samples} in {numbers['seconds']:.1f} s, {how}"
    if not math.isfinite(numbers["error"]):
        told = [f"error unknown until each pixel has two samples; {ended}"]
    elif math.isfinite(numbers["denoised_error"]):
        told = [f"denoised error {_confident(numbers, 'denoised_error')}; {ended}"]
        told.append(f"before denoising: error {_confident(numbers, 'error')}")
    else:
        told = [f"error {_confident(numbers, 'error')}; {ended}"]
    return [*told, *biases(numbers, settings)]


def _confident(numbers, name):
    low, high = percent(numbers[f"{name}_low"]), percent(numbers[f"{name}_high"])
    return f"{percent(numbers[name])}, with 95 % confidence between {low} and {high}"


def biases(numbers, settings):
    """Yield a sentence for each bias that the error does not include."""
    if numbers["error_cannot_exclude"] > NOTHING and math.isfinite(numbers["error_cannot_exclude"]):
        yield f"light in flashes that no sample has met could add {percent(numbers['error_cannot_exclude'])} to the error"
    if settings.clamp_indirect > 0.0:
        yield f"clamping has removed {percent(numbers['error_clipped'])} of the light: the picture is too dark by this share"
    for name in ("error_clipped_direct", "error_cut", "error_no_caustics"):
        if numbers[name] > NOTHING:
            yield f"{REMOVED[name]} {percent(numbers[name])} of the light: the picture is too dark by this share"
    yield from filter(None, (changed_light(numbers, name) for name in CHANGED))
    if settings.integrator == Integrator.PATH:
        missing = numbers["error_missing"]
        if math.isinf(missing):
            last = "the last bounce finds no less light than the one before"
            yield f"light beyond {settings.max_bounces} bounces is left out, and {last}"
        elif missing > NOTHING:
            yield f"light beyond {settings.max_bounces} bounces is left out: about {percent(missing)}"
    if numbers["denoised"]:
        yield numbers["denoised"]
        if numbers["denoised_moved"] > NOTHING:
            moved = percent(numbers["denoised_moved"])
            yield f"denoising alone would move about {moved} of the light; the samples bring it back as they rise"


def fields(numbers, settings):
    """Yield (name, text) pairs for the metadata of a file."""
    for name in ("error", "error_low", "error_high", "error_cannot_exclude", *BIASES, "error_missing"):
        yield name, f"{numbers[name]:.6g}"
    yield "samples", str(numbers["samples"])
    yield "samples_most", str(numbers["samples_most"])
    yield "samples_mean", f"{numbers['samples_mean']:.6g}"
    yield "split_lights", str(numbers["split_lights"])
    yield "split_paths", str(numbers["split_paths"])
    yield "seconds", f"{numbers['seconds']:.3f}"
    yield "ended_by", numbers["ended_by"]
    yield "invalid_samples", str(numbers["invalid_samples"])
    yield "seed", str(settings.seed)
    yield "settings", ", ".join(_changed(settings))
    yield "features", numbers["features"]
    yield "kernel", f"{numbers['kernel']}, {numbers['instruction_set']}"
    if numbers["denoised"]:
        yield "denoising", numbers["denoised"]
        for name in ("denoised_error", "denoised_error_low", "denoised_error_high", "denoised_moved"):
            yield name, f"{numbers[name]:.6g}"
    yield "version", numbers["version"]


def _changed(settings):
    for field in dataclasses.fields(settings):
        value = getattr(settings, field.name)
        if field.name in ("passes", "threads", "tile_size", "seed", *extras(())):
            continue
        if isinstance(value, IntEnum):
            value = value.name
        yield f"{field.name} {value:.6g}" if isinstance(value, float) else f"{field.name} {value}"
