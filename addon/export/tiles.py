"""The tiles of an image: the file of each, and tiles that were made without a file."""

import bpy

from .colorspace import in_own_data

_SHOWS_STROKES = bpy.app.version >= (5, 2)


def path_of_tile(image, number):
    column, row = (number - 1001) % 10, (number - 1001) // 10
    path = image.filepath.replace("<UDIM>", str(number)).replace("<UVTILE>", f"u{column + 1}_v{row + 1}")
    return bpy.path.abspath(path, library=image.library)


def shows_memory(image):
    """Whether Cycles shows the tiles that Blender has in memory, and not their files. Blender before 4.4 does not tell."""
    return any(map(is_generated, image.tiles)) or _SHOWS_STROKES and image.is_dirty


def is_generated(tile):
    return getattr(tile, "is_generated_tile", False)


def regenerated(image, tile):
    """Yield a tile that was made without a file, made again as an image outside the user's data.

    Scripts can read the pixels of tile 1001 alone.
    """

    def make(data):
        width, height = tile.size
        made = data.images.new("Lancer", width, height, alpha=True, float_buffer=tile.use_generated_float)
        made.colorspace_settings.name, made.alpha_mode = image.colorspace_settings.name, image.alpha_mode
        made.generated_type, made.generated_color = tile.generated_type, tile.generated_color
        return made

    return in_own_data(make)
