"""The file that F12 writes: the picture's own numbers, and the time that its engine took."""

import re

import exr
import numpy as np

import addon


def write_floats(scene):
    """What F12 writes are the numbers themselves, whatever the file's author wanted to have written."""
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "IMAGE"
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGBA", "32", "NONE"
    if hasattr(image, "color_management"):
        image.color_management = "FOLLOW_SCENE"


def read_floats(scene):
    """The written picture, (h, w, 4); row 0 is the bottom row."""
    values = next(iter(exr.read(scene.render.filepath).values()))
    return np.ascontiguousarray(values[::-1])


def own_clock(scene):
    """Seconds of the last render from its first ray on; Cycles writes them into the picture's file, to a hundredth."""
    if scene.render.engine == "LANCER":
        return addon.engine.last_statistics[scene.name]["seconds"]
    with open(scene.render.filepath, "rb") as file:
        found = re.search(rb"cycles\.[^\0]*\.render_time\0string\0....([0-9:.]+)", file.read(1 << 16), re.DOTALL)
    seconds = 0.0
    for part in found[1].decode().split(":"):
        seconds = 60.0 * seconds + float(part)
    return seconds
