"""Denoised pictures of Lancer and of Cycles by F12, and their errors at equal time."""

import math
import statistics

import bpy

from tools.harness.f12 import press_f12

# Samples per pixel of the pictures, and those of Cycles at whose time both are compared.
COUNTS = (1, 2, 4, 8, 16, 32, 64, 128, 256)
DRAFTS = (16, 32, 64)
# Samples of Cycles whose FLIP is to be reached.
REACHED = 128


def denoise(scene, on=True):
    """Let both engines denoise with their own guides, by the best network."""
    scene.lancer.use_denoising = scene.cycles.use_denoising = on
    scene.cycles.denoiser = "OPENIMAGEDENOISE"
    if hasattr(scene.cycles, "denoising_use_gpu"):
        scene.cycles.denoising_use_gpu = False
    bpy.context.view_layer.update()


def curve(scene, engine, counts, seed, set_samples):
    """Return [(samples, seconds of F12, picture)]; the first render, which fills the caches, is left out."""
    scene.render.engine = engine
    found = []
    for count in (counts[0], *counts):
        set_samples(scene, count, seed)
        rendered = press_f12(scene)
        found.append((count, rendered.wall, rendered.picture[..., :3]))
    return found[1:]


def measured(points, reference):
    """Return a list of {"samples", "seconds", "square", "flip"}: medians over seeds. points: curves, one of each seed."""
    rows = []
    for of_seeds in zip(*points, strict=True):
        squares = [reference.square(picture) for *_, picture in of_seeds]
        flips = [reference.flip(picture) for *_, picture in of_seeds]
        rows.append(
            {
                "samples": of_seeds[0][0],
                "seconds": statistics.median(seconds for _, seconds, _ in of_seeds),
                "square": statistics.median(squares),
                "flip": statistics.median(flips),
            }
        )
    return rows


def compared(ours, theirs):
    """Return {"square", "flip": {samples: ratio at Cycles' time}, "time": ratio of the times to Cycles' FLIP at REACHED}.

    Values between two pictures are interpolated by logarithms. A ratio that would need a picture beyond the ends is missing.
    """
    found = {"square": {}, "flip": {}, "time": None}
    for row in theirs:
        if row["samples"] in DRAFTS:
            for name in ("square", "flip"):
                value = at(ours, "seconds", row["seconds"], name)
                if value is not None and row[name] > 0.0:
                    found[name][str(row["samples"])] = value / row[name]
        if row["samples"] == REACHED:
            seconds = at(ours, "flip", row["flip"], "seconds")
            found["time"] = seconds / row["seconds"] if seconds is not None else None
    return found


def at(rows, key, value, wanted):
    """Return wanted where key has this value, on a curve that rises or falls with it; None beyond its ends."""
    for before, after in zip(rows[:-1], rows[1:], strict=True):
        low, high = sorted((before[key], after[key]))
        if low <= value <= high and low < high and min(before[wanted], after[wanted]) > 0.0:
            share = math.log(value / before[key]) / math.log(after[key] / before[key])
            return before[wanted] * (after[wanted] / before[wanted]) ** share
    return None


def mean(ratios):
    """Return the geometric mean, or None."""
    ratios = [ratio for ratio in ratios if ratio is not None and ratio > 0.0]
    return math.exp(sum(math.log(ratio) for ratio in ratios) / len(ratios)) if ratios else None
