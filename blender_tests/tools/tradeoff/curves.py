"""Curves of error against seconds: medians over several seeds, and comparisons between curves."""

import math
import statistics

import numpy as np

from tools.harness.errors import luminance


def middle(points):
    """Return [(seconds, error, least error, greatest error)] of several seeds' points, [(seconds, error)] each."""
    result = []
    for of_seeds in zip(*points, strict=True):
        seconds, errors = zip(*of_seeds, strict=True)
        result.append((statistics.median(seconds), statistics.median(errors), min(errors), max(errors)))
    return result


def seconds_to(points, error):
    """Return the seconds at which a curve of (seconds, error, ...) reaches an error, interpolated by logarithms, or None."""
    for (t0, e0, *_), (t1, e1, *_) in zip(points[:-1], points[1:], strict=True):
        if e0 >= error >= e1 and e0 > e1:
            share = math.log(e0 / error) / math.log(e0 / e1)
            return t0 * (t1 / t0) ** share
    return None


def slope(points):
    """Return p of error = constant * seconds^-p, by least squares of logarithms."""
    x, y = np.log([point[0] for point in points]), np.log([point[1] for point in points])
    return -float(np.polyfit(x, y, 1)[0])


def conclude(curves, ours, theirs):
    """Return the figures of all curves, for page and file; curves: {name: [of each seed [(samples, seconds, picture)]]}."""
    result = {}
    for name, of_seeds in curves.items():
        reference = theirs if name == "Cycles" else ours
        shown = [[(seconds, luminance(picture)) for _, seconds, picture in points] for points in of_seeds]
        middles = middle([[(seconds, reference.distance(values)) for seconds, values in points] for points in shown])
        samples = [count for count, *_ in of_seeds[0]]
        rows = [
            {"samples": count, "seconds": seconds, "error": error, "least": least, "greatest": greatest}
            for count, (seconds, error, least, greatest) in zip(samples, middles, strict=True)
        ]
        for index, row in enumerate(rows):
            row["noise"], row["bias"] = reference.split([points[index][1] for points in shown])
        # Below 0.05 s Cycles' clock, which counts hundredths, is too coarse.
        result[name] = [row for row in rows if name != "Cycles" or row["seconds"] >= 0.05]
    return result


def conclude_presets(presets, targets, ours):
    """Return the figures of presets: {name: [of each seed (samples, seconds, picture, reported error, reason of its end)]}."""
    result = {}
    for name, renders in presets.items():
        (point,) = middle([[(seconds, ours.distance(luminance(picture)))] for _, seconds, picture, *_ in renders])
        told = sorted(own for *_, own, _ in renders)[len(renders) // 2]
        samples = sorted(count for count, *_ in renders)[len(renders) // 2]
        result[name] = dict(zip(("seconds", "error", "least", "greatest"), point, strict=True))
        result[name] |= {"told": told, "samples": samples, "target": targets[name], "ended_by": renders[0][4]}
    return result


def headlines(curves):
    """Return the seconds to equal error, at the errors of the presets and between, within the range of both curves."""
    rows = []
    for error in (0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.01):
        found = [seconds_to([(row["seconds"], row["error"]) for row in curves[name]], error) for name in ("PATH", "Cycles")]
        if None not in found:
            rows.append({"error": error, "lancer": found[0], "cycles": found[1]})
    return rows


def slopes(curves):
    """Return the slopes of the curves of converging renders, from 4 samples on, when samples cover a pixel evenly."""
    result = {}
    for name in ("PATH", "Cycles"):
        points = [(row["seconds"], row["error"]) for row in curves[name] if row["samples"] >= 4 and row["error"] > 0.0]
        if len(points) > 1:
            result[name] = slope(points)
    return result
