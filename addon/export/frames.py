"""The file and the frame that a node shows of a movie or an image sequence."""

import os
import re
from typing import NamedTuple

import bpy

ANIMATED = ("MOVIE", "SEQUENCE")
_LAST_DIGITS = re.compile(r"(.*?)([0-9]+)([^0-9]*)", re.DOTALL)


class Shown(NamedTuple):
    """Empty for images without frames."""

    path: str = ""
    frame: int | None = None  # of a movie, from 1 on; Blender shows the first or last frame for numbers beyond


def shown(image, user, scene_frame):
    """Return the Shown of an image under a node's ImageUser.

    Cycles maps the frame at each export, whatever the ImageUser's Auto Refresh says; frame_current may be of another frame.
    Without an ImageUser (the sides of a world's cube) the frame is the scene's. Blender takes six files whose names end in
    numbers for sequences: a sequence without a file for that frame shows the file from which it was made.
    """
    if image.source not in ANIMATED:
        return Shown()
    number = scene_frame if user is None else image_frame(user, scene_frame)
    path = bpy.path.abspath(image.filepath, library=image.library)
    if image.source == "MOVIE":
        return Shown(path, number)
    numbered = file_of_frame(path, number)
    return Shown(path if user is None and not os.path.isfile(numbered) else numbered)


def image_frame(user, scene_frame):
    """Return the number of the image or movie frame that an ImageUser shows at a frame of the scene."""
    count = user.frame_duration
    if count == 0:
        return 0
    number = scene_frame - user.frame_start + 1
    if user.use_cyclic:
        number = number % count or count
    return min(max(number, 0), count) + user.frame_offset


def file_of_frame(path, number):
    """Return the path of a sequence's file: the last digits before the extension, padded as they are, become the number."""
    head, name = _split(path, max(path.rfind("/"), path.rfind("\\")) + 1)
    stem, extension = _split(name, name.rfind(".") if "." in name else len(name))
    found = _LAST_DIGITS.fullmatch(stem)
    number = max(number, 0)
    if found is None:
        return f"{head}{stem}{number or ''}{extension}"
    before, digits, after = found.groups()
    return f"{head}{before}{number:0{len(digits)}}{after}{extension}"


def _split(text, at):
    return text[:at], text[at:]
