"""Press F12 from a program: register the engine, read the picture's values, and time the engine."""

import os
import re
import tempfile
import time
from typing import NamedTuple

import bpy
import exr
import numpy as np

import addon

from . import workers


def registered(work):
    """Return work(), which is called while the engine is registered."""
    addon.register()
    try:
        return work()
    finally:
        addon.unregister()


class Rendered(NamedTuple):
    picture: np.ndarray  # (h, w, 4); row 0 is the bottom row
    wall: float  # seconds from F12 to the file
    seconds: float  # by the engine's own clock, from its first ray on
    peak: int  # peak of the process's bytes, before the picture is read


def press_f12(scene):
    """Render to a file of linear floats, whatever the output settings of the file. Return a Rendered."""
    _write_floats(scene)
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.exr")
        start = time.perf_counter()
        bpy.ops.render.render(write_still=True, scene=scene.name)
        wall, peak = time.perf_counter() - start, workers.memory("VmHWM")
        if not os.path.exists(scene.render.filepath):
            raise RuntimeError(f"{scene.render.engine} wrote no picture")
        values = next(iter(exr.read(scene.render.filepath).values()))
        return Rendered(np.ascontiguousarray(values[::-1]), wall, _own_clock(scene), peak)


def _write_floats(scene):
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "IMAGE"
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGBA", "32", "NONE"
    if hasattr(image, "color_management"):
        image.color_management = "FOLLOW_SCENE"


def _own_clock(scene):
    """Return the seconds of the last render; Cycles writes them into the picture's file, rounded to a hundredth."""
    if scene.render.engine == "LANCER":
        return addon.engine.last_statistics[scene.name]["seconds"]
    with open(scene.render.filepath, "rb") as file:
        found = re.search(rb"cycles\.[^\0]*\.render_time\0string\0....([0-9:.]+)", file.read(1 << 16), re.DOTALL)
    seconds = 0.0
    for part in found[1].decode().split(":"):
        seconds = 60.0 * seconds + float(part)
    return seconds
