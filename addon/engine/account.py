"""The account of a rendered view layer: in the file's metadata, in engine.last_statistics, and as lines for the user."""

import math

import bpy

from ..denoise import view_layer as denoise
from ..measure import render_report
from . import kept_pictures
from .results import keep_costs, last_costs, last_statistics

# Entries of last_statistics with the library's memory.
MEMORY = ("geometry_bytes", "accelerator_bytes", "texture_bytes", "film_bytes")


def account(engine, scene, layer, session, schedule, denoised, uses):
    """Store and show the figures of a view layer, and return Messages about samples that are left out.

    layer: its name, with that of the view if there are several. denoised: the denoised picture, or None.
    uses: the features of the scene, as dicts.
    """
    numbers = render_report.account(session, schedule)
    numbers.update(denoise.statistics(denoised))
    held = sum(numbers[name] for name in MEMORY) / 2**20
    engine.update_memory_stats(memory_used=held, memory_peak=held + numbers["denoising_bytes"] / 2**20)
    numbers["uses"] = uses
    kept = kept_pictures.of(scene)
    if kept is not None:
        kept.sample_seconds = numbers["seconds"] / schedule.samples if schedule.samples else math.inf
        numbers.update(kept.counts, kept_bytes=kept.bytes)
    # Only metadata of the result from get_result reaches the file.
    stamped = engine.get_result()
    several = len(stamped.layers) > 1 or len(stamped.views) > 1
    lines = numbers["accuracy"] = render_report.lines(numbers, session.settings, layer if several else "")
    layers = last_statistics.get(scene, {}).get("layers", {})
    last_statistics[scene] = {**numbers, "layers": {**layers, layer: numbers}}
    if scene in last_costs:
        keep_costs(scene, last_costs[scene])
    for name, value in render_report.fields(numbers, session.settings):
        stamped.stamp_data_add_field(f"lancer.{layer}.{name}", value)
    engine.update_stats("", lines[0])
    # In background mode reports go to the terminal; in a window the panel shows these lines.
    if bpy.app.background:
        for line in lines:
            engine.report({"INFO"}, f"Lancer: {line}")
    return render_report.left_out(numbers)
