"""Images in their own bit depth, exported once however many materials use them."""

import contextlib
import hashlib
import os
import tempfile

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.enums import AlphaMode, Transfer
from ..host import main_thread
from ..host.by_scene import identity
from ..messages.severity import Severity
from .colorspace import IDENTITY, conversion, convert, floats, loaded, stored
from .frames import shown
from .gaps import mended
from .layered_exr import combined_pass, has_layers, shown_by_cycles
from .missing import HAS_TEXEL, missing
from .tiles import is_generated, path_of_tile, regenerated, shows_memory

_VALUES_AT_ONCE = 1 << 18  # converted in one pass, small enough for the processor's cache
_WHITE = 65535.0
_SHOWS_STROKES = bpy.app.version >= (5, 2)  # older Cycles shows the file of an image with unsaved strokes
_SHOWS_PACKED_LAYERS = bpy.app.version >= (4, 3)  # older Cycles finds no pixels, as scripts do
_ASSOCIATED_FORMATS = ("OPEN_EXR", "OPEN_EXR_MULTILAYER", "HDR")  # formats that store colour multiplied by alpha


# Takes the place of an image that is not used any more, until another one gets its number.
_NOTHING = snapshot.Image(name="nothing", texels=np.zeros((1, 1, 1), np.uint8))


class Images:
    """The images that nodes use, by number."""

    def __init__(self, obey=None, kept=None):
        """obey is called before each file and raises Cancelled if the user cancels. kept: the Kept of earlier frames."""
        self.list = []
        self.placed = 0  # images so far, those included that are not used any more
        self.obey = obey
        self.frame = 1  # of the scene
        self.is_preview = False  # whether the images are shown in a preview of a material or a world
        self._kept = kept
        self._ranges = {}
        self._tables = {}
        self._free = set()  # numbers

    def numbers(self, image, user, tell):
        """Return (first, count) of a Blender image, one for each tile; None if it cannot be read. tell(text, key, severity)."""
        seen = shown(image, user, self.frame)
        key = (identity(image), image.colorspace_settings.name, image.alpha_mode, seen)
        if key not in self._ranges:
            with main_thread.obeying(self.obey):
                read = _read_all if self._kept is None else self._kept.pictures(_read_all)
                # Cycles shows unsaved strokes in previews.
                if self.is_preview and image.source == "FILE" and image.is_dirty:
                    read = _read_memory
                pictures = read(image, seen, tell)
            self._ranges[key] = (self.repeat(pictures), len(pictures)) if pictures else None
        if self._ranges[key] is None:
            tell(
                f"image '{image.name}' has no pixels ({seen.path or image.filepath or 'empty'}), magenta is used",
                severity=Severity.WRONG,
            )
        return self._ranges[key]

    def repeat(self, pictures):
        """Add images, even known ones, so that their numbers are consecutive; return the first number."""
        numbers = range(len(self.list), len(self.list) + len(pictures))
        for number in sorted(self._free):
            if self._free.issuperset(range(number, number + len(pictures))):
                numbers = range(number, number + len(pictures))
                break
        self._free.difference_update(numbers)
        self.list[numbers.start : numbers.stop] = pictures
        self.placed += len(pictures)
        return numbers.start

    def table(self, texels):
        """Return the number of an image with these texels, (rows, columns, channels) of float32. Equal tables share one."""
        key = texels.shape, hashlib.sha256(texels.tobytes()).digest()
        if key not in self._tables:
            self._tables[key] = self.repeat([snapshot.Image(name="table", texels=texels, alpha=AlphaMode.CHANNEL_PACKED)])
        return self._tables[key]

    def forget(self, changed, used):
        """Drop the images whose identity is in changed and those whose number is not in used."""
        for key, found in list(self._ranges.items()):
            if key[0] in changed or found is not None and found[0] not in used:
                del self._ranges[key]
        self._tables = {key: number for key, number in self._tables.items() if number in used}
        kept = {number for found in self._ranges.values() if found is not None for number in range(found[0], sum(found))}
        for number in range(len(self.list)):
            if number not in kept and number not in used:
                self.list[number] = _NOTHING
                self._free.add(number)


class NoPictures:
    """A stand-in for Images that reads none, for panels and for a lamp alone."""

    def numbers(self, image, user, tell):
        return 0, 1

    def repeat(self, pictures):
        return 0

    def table(self, texels):
        return 0


def _read_all(image, seen, tell):
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
    return _read_memory(image, None, tell)


def _read_memory(image, _, tell):
    """Read the pixels that Blender has, or decodes from a packed file."""
    # Free the pixels again if Blender had not loaded them before.
    had_data = image.has_data
    # Blender tells the type only after it has read the file, and scripts cannot read the pixels of layers.
    if min(image.size) < 1 and image.type == "MULTILAYER":
        pictures = _read_packed_layers(image, tell)
    else:
        pictures = _read(image, image, tell, _space(image))
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
            with stored(path) as source:
                return _read(image, source, tell, _space(image), tile, path)
        with open(path, "rb") as file:
            plain = shown_by_cycles(file.read())
        with _temporary(plain.data, ".exr") as copy, stored(copy) as source:
            return _read(image, source, tell, _space(image), tile, copy, plain.columns)
    except ValueError as error:
        return _unread_layers(image, error, tell, tile)
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
            return _read(image, source, tell, _space(source), columns=plain.columns)
    except ValueError as error:
        return _unread_layers(image, error, tell)
    except RuntimeError:
        return []


def _unread_layers(image, error, tell, tile=0):
    text = f"is a multilayer EXR that cannot be read ({error}), save its layer as a plain EXR or PNG; mid-grey is used"
    tell(f"image '{image.name}' {text}", "feature:multilayer EXR", severity=Severity.WRONG)
    return [_picture(image, np.full((1, 1, 3), 0.5, np.float32), Transfer.LINEAR, AlphaMode.NONE, tile, IDENTITY)]


@contextlib.contextmanager
def _temporary(data, extension):
    """Yield the path of a file with these bytes, removed on exit."""
    number, path = tempfile.mkstemp(extension, "lancer_", bpy.app.tempdir)
    try:
        with open(number, "wb") as file:
            file.write(data)
        yield path
    finally:
        os.remove(path)


def _read_tiles(image, tell):
    in_memory = shows_memory(image)
    if image.is_dirty:
        text = "those of tile 1001 alone are shown" if in_memory else "its files are shown, as in Cycles"
        tell(f"image '{image.name}' has unsaved changes, {text}", severity=Severity.DIFFERENT if in_memory else Severity.HINT)
    pictures = []
    for tile in image.tiles:
        found = (_read_tile_in_memory if in_memory else _read_tile)(image, tile, tell)
        if not found:
            path = path_of_tile(image, tile.number) or "no file"
            text = f"tile {tile.number} of image '{image.name}' cannot be read ({path}), magenta is used"
            tell(text, severity=Severity.WRONG)
            found = [missing(image, tile.number)] if HAS_TEXEL else []
        pictures += found
    return pictures


def _read_tile(image, tile, tell):
    return _read_packed(image, tile.number, tell) or _read_file(image, path_of_tile(image, tile.number), tell, tile.number)


def _read_tile_in_memory(image, tile, tell):
    if tile.number == 1001:
        return _read(image, image, tell, _space(image), tile.number)
    if not is_generated(tile):
        return _read_tile(image, tile, tell)
    with regenerated(image, tile) as source:
        return _read(image, source, tell, _space(image), tile.number)


def _read_packed(image, number, tell):
    """Read a tile packed in the .blend: its bytes are written to a temporary file, which Blender decodes."""
    packed = next((item for item in image.packed_files if getattr(item, "tile_number", 0) == number), None)
    if packed is None or packed.packed_file is None:
        return []
    with _temporary(packed.packed_file.data, os.path.splitext(packed.filepath)[1]) as path:
        return _read_decoded(image, path, tell, number)


def _read_decoded(image, path, tell, tile=0, frame=None):
    """Read a file, or a movie's frame, as Blender decodes it under the settings of image."""
    try:
        with loaded(path, image.colorspace_settings.name, image.alpha_mode, frame) as source:
            return _read(image, source, tell, _space(source), tile)
    except RuntimeError:
        return []


def _read(image, source, tell, space, tile=0, path="", columns=()):
    """Return a list with the image of source under the settings of image; empty if it has no pixels.

    path: the file that source reads with its stored values; its floating point values are in the image's colour space, as bytes
    always are. Without a path they are in the working space. columns: the channels of source to read; empty means all.
    """
    is_stored = bool(path)
    if min(source.size) < 1 or source.channels < 1:
        return []
    values = floats(source)
    if columns:
        values = np.ascontiguousarray(values[:, :, columns])
    if source.is_float and not np.isfinite(values).all():
        values = _mended(image, values, tell, path)
    name, is_data = space
    alpha = _alpha_mode(image, source, is_data, is_stored)
    if values.shape[2] == 2:
        values = values[:, :, [0, 0, 0, 1]]
    if values.shape[2] == 4 and (alpha == AlphaMode.NONE or bool((values[:, :, 3] == 1.0).all())):
        # Keep the alpha mode: it decides the colour outside the image with extension Clip.
        values = values[:, :, :3]
    transfer, matrix = Transfer.LINEAR, IDENTITY
    # Without the name of a colour space Cycles uses the values unchanged.
    if name and not is_data and (is_stored or not source.is_float):
        found = conversion(name)
        # Cycles decodes after interpolation only if the sRGB curve alone suffices; else it converts before interpolation.
        if found is None or (found[0] == Transfer.SRGB and found[1] != IDENTITY):
            values, alpha = _converted(values, name, alpha)
            return [_picture(image, values, transfer, alpha, tile, matrix)]
        transfer, matrix = found
    texels = _floating(values) if source.is_float else _quantised(values, 255.0, np.uint8)
    return [_picture(image, texels, transfer, alpha, tile, matrix)]


def _mended(image, values, tell, path):
    count = int((~np.isfinite(values).all(axis=2)).sum())
    packed = image.packed_file.data if image.packed_file is not None else b""
    values, is_finite = mended(values, path, packed)
    # The core reports the texels that are left.
    if is_finite:
        tell(f"image '{image.name}': {count} texels are not finite and are read as in Cycles", "")
    return values


def _picture(image, texels, transfer, alpha, tile, matrix):
    return snapshot.Image(name=image.name, texels=texels, transfer=transfer, alpha=alpha, tile=tile, matrix=matrix)


def _alpha_mode(image, source, is_data, is_stored):
    """Return the AlphaMode of the pixels of source, as each version of Cycles chooses it."""
    if image.alpha_mode == "NONE":
        return AlphaMode.NONE
    if is_data or image.alpha_mode == "CHANNEL_PACKED":
        return AlphaMode.CHANNEL_PACKED
    if bpy.app.version >= (5, 1):
        # Cycles follows the image's setting, even for pixels that Blender has already multiplied or divided.
        associated = image.alpha_mode == "PREMUL"
    elif is_stored:
        associated = source.file_format in _ASSOCIATED_FORMATS
    else:
        # In memory Blender keeps floating point associated and bytes straight.
        associated = source.is_float
    return AlphaMode.ASSOCIATED if associated else AlphaMode.STRAIGHT


def _converted(values, name, alpha):
    """Return (values, alpha mode) converted to floating point in the working space.

    Colour is divided by alpha before the conversion and multiplied after it, so that interpolation sees associated alpha.
    """
    full = np.ones((*values.shape[:2], 4), np.float32)
    full[:, :, : values.shape[2]] = values
    if values.shape[2] == 1:
        full[:, :, :3] = values
    if values.shape[2] < 4:
        return np.ascontiguousarray(convert(full, name)[:, :, :3]), alpha
    if alpha == AlphaMode.ASSOCIATED:
        _divide(full)
    full = convert(full, name)
    if alpha in (AlphaMode.ASSOCIATED, AlphaMode.STRAIGHT):
        full[:, :, :3] *= full[:, :, 3:]
        alpha = AlphaMode.ASSOCIATED
    return full, alpha


def _divide(values):
    """Divide colour by alpha in place where alpha is positive."""
    np.divide(values[:, :, :3], values[:, :, 3:], out=values[:, :, :3], where=values[:, :, 3:] > 0.0)


def _floating(values):
    """Return texels as float32, or as uint16 if all are multiples of 1/65535, as those of 16-bit files are."""
    values = np.ascontiguousarray(values)
    sample = values.reshape(-1)[:: max(1, values.size // 4096)]
    if _is_stepped(sample) and _is_stepped(values):
        return _quantised(values, _WHITE, np.uint16)
    return values


def _is_stepped(values):
    """Whether all values are multiples of 1/65535 up to the rounding of single precision, which is 2^-9 of a step."""
    # Inverted: values that are not finite are no multiples.
    if not (values.min() >= 0.0 and values.max() <= 1.0):
        return False
    steps = values * _WHITE
    return bool((np.abs(steps - np.rint(steps)) <= 2.0**-8).all())


def _quantised(values, scale, dtype):
    """Return values between 0 and 1 rounded to integers of dtype, in blocks of rows to limit peak memory."""
    texels = np.empty(values.shape, dtype)
    rows = max(1, _VALUES_AT_ONCE // (values.shape[1] * values.shape[2]))
    for first in range(0, len(values), rows):
        part = slice(first, first + rows)
        texels[part] = values[part] * np.float32(scale) + np.float32(0.5)
    return texels
