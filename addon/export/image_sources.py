"""Where the pixels of an image come from: a file, Blender's memory, packed data, or the tiles of a set."""

import contextlib
import os
import tempfile

import bpy

from ..host import main_thread
from ..messages.severity import Severity
from .colorspace import loaded, stored
from .decoded import READS_BYTES, decoded_bytes, decoded_file
from .layered_exr import combined_pass, has_layers, shown_by_cycles
from .missing import HAS_TEXEL, missing
from .texels import mid_grey, read_texels
from .texture_cache import is_cached
from .tiles import is_generated, path_of_tile, regenerated, shows_memory

_SHOWS_STROKES = bpy.app.version >= (5, 2)  # older Cycles shows the file of an image with unsaved strokes
_SHOWS_ONE_TILE_EVERYWHERE = bpy.app.version < (4, 2, 7) or (4, 3) <= bpy.app.version < (4, 4)  # as no tile, but as an image
_SHOWS_PACKED_LAYERS = bpy.app.version >= (4, 3)  # older Cycles finds no pixels, as scripts do


def read_all(image, seen, tell):
    """Return the pictures of an image, or yield them where there are many, so that not all have to be in memory."""
    if image.source == "TILED":
        return _read_tiles(image, tell)
    if image.source == "MOVIE":
        return _read_decoded(image, seen.path, tell, frame=seen.frame)
    if image.source == "SEQUENCE":
        return _read_file(image, seen.path, tell)
    if image.source == "VIEWER":
        return []
    if image.source == "FILE" and image.packed_file is None and not (image.is_dirty and _SHOWS_STROKES):
        path = bpy.path.abspath(image.filepath, library=image.library)
        if not os.path.isfile(path):
            return []
        if image.is_dirty:
            text = f"image '{image.name}' has unsaved changes, its file is shown, as in Cycles"
            tell(text, severity=Severity.HINT)
            return _read_file(image, path, tell)
        # Blender's bytes in memory equal the file's, unless Blender has divided them by alpha.
        if not image.has_data or image.is_float or image.alpha_mode == "PREMUL" or image.type == "MULTILAYER":
            return _read_file(image, path, tell)
    return read_memory(image, None, tell)


def has_cached_file(cache, image, seen):
    """Whether Cycles reads an image from a TextureCache: one with a file of its own, or the files of tiles."""
    if cache is None or image.is_dirty or image.packed_file is not None or image.source not in ("FILE", "SEQUENCE", "TILED"):
        return False
    if image.source == "TILED":
        return not shows_memory(image) and all(is_cached(cache, path_of_tile(image, tile.number)) for tile in image.tiles)
    return is_cached(cache, seen.path or bpy.path.abspath(image.filepath, library=image.library))


def read_memory(image, _, tell):
    """Read the pixels that Blender has, or decodes from a packed file."""
    # Blender divides the bytes of some images by alpha.
    is_packed = image.source == "FILE" and image.packed_file is not None
    if READS_BYTES and is_packed and not image.has_data and image.alpha_mode != "PREMUL":
        with decoded_bytes(image.packed_file.data) as found:
            if found is not None:
                return read_texels(image, found, tell, _space(image))
    # Free the pixels again if Blender had not loaded them before.
    had_data = image.has_data
    # Blender tells the type only after it has read the file, and scripts cannot read the pixels of layers.
    if min(image.size) < 1 and image.type == "MULTILAYER":
        pictures = _read_packed_layers(image, tell)
    else:
        pictures = read_texels(image, image, tell, _space(image))
    if not had_data and not image.is_dirty:
        main_thread.run(image.buffers_free)
    return pictures


def _space(image):
    """Return (name, is_data) of the colour space. The name is empty for tiles that Blender has not loaded yet."""
    return image.colorspace_settings.name, image.colorspace_settings.is_data


def _read_file(image, path, tell, tile=0):
    """Read a file outside the .blend with its stored values, which Cycles decodes after interpolation."""
    if not os.path.isfile(path):
        return []
    try:
        if not has_layers(path):
            with decoded_file(path) as found, contextlib.nullcontext(found) if found else stored(path) as source:
                return read_texels(image, source, tell, _space(image), tile, path)
        try:
            with open(path, "rb") as file:
                plain = shown_by_cycles(file.read())
        except ValueError as error:
            return _unread_layers(image, error, tell, tile)
        with _temporary(plain.data, ".exr") as copy, stored(copy) as source:
            return read_texels(image, source, tell, _space(image), tile, copy, plain.columns)
    except _UnwrittenError as error:
        return _unwritten(image, error, tell, tile)
    except (OSError, RuntimeError):
        return []


def _read_packed_layers(image, tell):
    """Read a packed file of layers, whose first pass Cycles shows. Blender converts only colours to the working space."""
    if not _SHOWS_PACKED_LAYERS:
        return []
    try:
        plain = combined_pass(image.packed_file.data if image.packed_file is not None else b"")
        name = image.colorspace_settings.name if len(plain.columns) > 2 else None
        with _temporary(plain.data, ".exr") as path, loaded(path, name, image.alpha_mode) as source:
            return read_texels(image, source, tell, _space(source), columns=plain.columns)
    except ValueError as error:
        return _unread_layers(image, error, tell)
    except _UnwrittenError as error:
        return _unwritten(image, error, tell)
    except RuntimeError:
        return []


def _unread_layers(image, error, tell, tile=0):
    text = f"is a multilayer EXR that cannot be read ({error}), save its layer as a plain EXR or PNG; mid-grey is used"
    tell(f"image '{image.name}' {text}", "feature:multilayer EXR", severity=Severity.WRONG)
    return [mid_grey(image, tile)]


class _UnwrittenError(Exception):
    """A temporary file cannot be written."""


@contextlib.contextmanager
def _temporary(data, extension):
    """Yield the path of a file with these bytes, removed on exit; raise _UnwrittenError if it cannot be written."""
    path = None
    try:
        try:
            number, path = tempfile.mkstemp(extension, "lancer_", bpy.app.tempdir)
            with open(number, "wb") as file:
                file.write(data)
        except OSError as error:
            raise _UnwrittenError(error.strerror or str(error)) from None
        yield path
    finally:
        if path is not None:
            os.remove(path)


def _unwritten(image, error, tell, tile=0):
    text = f"image '{image.name}' needs a temporary file: {error} ({bpy.app.tempdir}, of Preferences > File Paths)"
    tell(f"{text}; mid-grey is used", severity=Severity.WRONG)
    return [mid_grey(image, tile)]


def _read_tiles(image, tell):
    in_memory = shows_memory(image)
    if image.is_dirty:
        text = "those of tile 1001 alone are shown" if in_memory else "its files are shown, as in Cycles"
        tell(f"image '{image.name}' has unsaved changes, {text}", severity=Severity.DIFFERENT if in_memory else Severity.HINT)
    for tile in image.tiles:
        found = (_read_tile_in_memory if in_memory else _read_tile)(image, tile, tell)
        if not found:
            path = path_of_tile(image, tile.number) or "no file"
            text = f"tile {tile.number} of image '{image.name}' cannot be read ({path}), magenta is used"
            tell(text, severity=Severity.WRONG)
            found = [missing(image, tile.number)] if HAS_TEXEL else []
        if _SHOWS_ONE_TILE_EVERYWHERE and len(image.tiles) == 1:
            found = [picture.replaced(tile=0) for picture in found]
        yield from found


def _read_tile(image, tile, tell):
    return _read_packed(image, tile.number, tell) or _read_file(image, path_of_tile(image, tile.number), tell, tile.number)


def _read_tile_in_memory(image, tile, tell):
    if tile.number == 1001:
        return read_texels(image, image, tell, _space(image), tile.number)
    if not is_generated(tile):
        return _read_tile(image, tile, tell)
    with regenerated(image, tile) as source:
        return read_texels(image, source, tell, _space(image), tile.number)


def _read_packed(image, number, tell):
    """Read a tile packed in the .blend: its bytes are written to a temporary file, which Blender decodes."""
    packed = next((item for item in image.packed_files if getattr(item, "tile_number", 0) == number), None)
    if packed is None or packed.packed_file is None:
        return []
    try:
        with _temporary(packed.packed_file.data, os.path.splitext(packed.filepath)[1]) as path:
            return _read_decoded(image, path, tell, number)
    except _UnwrittenError as error:
        return _unwritten(image, error, tell, number)


def _read_decoded(image, path, tell, tile=0, frame=None):
    """Read a file, or a movie's frame, as Blender decodes it under the settings of image."""
    try:
        with loaded(path, image.colorspace_settings.name, image.alpha_mode, frame) as source:
            return read_texels(image, source, tell, _space(source), tile)
    except RuntimeError:
        return []
