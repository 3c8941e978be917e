"""The state of an image from which its texels follow: files by time and size, packed ones by contents, and settings."""

import hashlib
import os

import bpy

from ..host import main_thread
from .tiles import path_of_tile


def image_state(image, seen, digests=None):
    """Return the files and the settings of an image; None if its pixels can change without changing these.

    digests: a dict of those of packed files, by address and size, for calls between which no script packs others.
    """
    if image.is_dirty or image.source == "VIEWER":
        return None
    settings = (image.source, image.alpha_mode, image.colorspace_settings.name, image.filepath, seen)
    working = getattr(getattr(bpy.data, "colorspace", None), "working_space", "")
    if image.source == "GENERATED":
        made = image.generated_type, *image.generated_color, image.generated_width, image.generated_height, image.is_float
        return (*settings, working, *made)
    packed = tuple(item.packed_file for item in image.packed_files) or ((image.packed_file,) if image.packed_file else ())
    if packed and not seen.path:
        digests = {} if digests is None else digests
        return (*settings, working, *(_digest(item, digests) for item in packed if item is not None))
    return (*settings, working, *_files_of(image, seen.path))


def _digest(packed, digests):
    """Return the digest of a packed file's contents: Blender does not tell that a script has packed others."""
    key = packed.as_pointer(), packed.size
    if key not in digests:
        main_thread.look()
        digests[key] = hashlib.sha256(packed.data).digest()
    return digests[key]


def _files_of(image, path):
    """Yield path, time, size and inode of each file; the path alone if it is missing."""
    paths = [path or bpy.path.abspath(image.filepath, library=image.library)]
    if image.source == "TILED":
        paths = [path_of_tile(image, tile.number) for tile in image.tiles]
    for path in paths:
        try:
            told = os.stat(path)
        except OSError:
            yield (path,)
            continue
        yield path, told.st_mtime_ns, told.st_size, told.st_ino
