"""Which images Cycles reads from its texture cache, since Blender 5.2: those have mipmaps."""

import functools
import os
import re
from typing import NamedTuple

import bpy

from ..host import main_thread

# The folder beside an image for files of the cache, and the end of their names.
_FOLDER = "blender_tx"
_END = re.compile(r"\.0-[0-9A-Fa-f]{32}\.tx")


class TextureCache(NamedTuple):
    """The settings of a scene that uses the cache."""

    makes: bool  # Cycles makes the files that are missing
    folder: str  # from the preferences


def texture_cache(scene):
    """Return the TextureCache of a scene; None if Cycles reads images whole."""
    render = scene.render
    if not getattr(render, "use_texture_cache", False):
        return None
    # Only the main thread may read the preferences.
    folder = main_thread.run(lambda: bpy.context.preferences.filepaths.texture_cache_directory)
    return TextureCache(render.use_auto_generate_texture_cache, bpy.path.abspath(folder) if folder.startswith("//") else folder)


def is_cached(cache, path):
    """Whether Cycles reads an image's file from the cache, as far as the names and times of its files tell."""
    if cache is None or not os.path.isfile(path):
        return False
    return cache.makes or any(
        _has_file(os.path.join(os.path.dirname(path), folder), path) for folder in (cache.folder, _FOLDER)
    )


def _has_file(folder, path):
    """Whether a folder has a file of the cache that was made from the image as it is."""
    name, made = os.path.basename(path), int(os.stat(path).st_mtime)
    try:
        names = _names(folder, os.stat(folder).st_mtime_ns)
        return any(
            other.startswith(name) and _END.fullmatch(other, len(name)) and int(_time(folder, other)) == made for other in names
        )
    except OSError:
        return False


def _time(folder, name):
    return os.stat(os.path.join(folder, name)).st_mtime


@functools.lru_cache(maxsize=16)
def _names(folder, _changed):
    """Return the names of a folder that may be files of the cache. _changed: the folder's time, which follows new names."""
    return [name for name in os.listdir(folder) if name.endswith(".tx")]
