"""Pictures in their own bit depth, once each, however many materials show them."""

import os

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.enums import AlphaMode, Transfer
from ..host import main_thread
from ..host.by_scene import identity
from ..messages.severity import Severity
from .colorspace import IDENTITY, conversion, convert, floats, loaded, stored

_VALUES_AT_ONCE = 1 << 18  # converted in one piece, which stays in the cache
_WHITE = 65535.0
_ASSOCIATED_FORMATS = ("OPEN_EXR", "OPEN_EXR_MULTILAYER", "HDR")  # their colour is multiplied by alpha in the file


# In the place of pictures that nothing asks for any more, so that the others keep their numbers.
_NOTHING = snapshot.Image(name="nothing", texels=np.zeros((1, 1, 1), np.uint8))


class Images:
    """Numbers the pictures that nodes ask for."""

    def __init__(self, obey=None, kept=None):
        """obey is called before each file; it raises Cancelled when the user has enough. kept: of earlier frames, a Kept."""
        self.list = []
        self.obey = obey
        self._kept = kept
        self._ranges = {}

    def numbers(self, image, user, tell):
        """(first, count) of a Blender image, more for tiles; None where there is none. tell takes text, key and severity."""
        path = _frame_path(image, user, tell)
        key = (identity(image), image.colorspace_settings.name, image.alpha_mode, path)
        if key not in self._ranges:
            first = len(self.list)
            with main_thread.obeying(self.obey):
                read = _read_all if self._kept is None else self._kept.pictures(_read_all)
                self.list += read(image, path, tell)
            self._ranges[key] = (first, len(self.list) - first) if len(self.list) > first else None
        if self._ranges[key] is None:
            tell(
                f"image '{image.name}' has no picture ({path or image.filepath or 'empty'}), magenta is used",
                severity=Severity.WRONG,
            )
        return self._ranges[key]

    def repeat(self, pictures):
        """The number of the first of pictures that are to stand in a row, known ones too."""
        self.list += pictures
        return len(self.list) - len(pictures)

    def forget(self, changed, used):
        """Drops the pictures of the Blender images that have changed, by identity, and all but the used numbers."""
        for key, found in list(self._ranges.items()):
            if key[0] in changed or found is not None and found[0] not in used:
                del self._ranges[key]
        kept = {number for found in self._ranges.values() if found is not None for number in range(found[0], sum(found))}
        for number in range(len(self.list)):
            if number not in kept and number not in used:
                self.list[number] = _NOTHING


class NoPictures:
    """Stands for Images where only whether there is a picture matters."""

    def numbers(self, image, user, tell):
        return 0, 1

    def repeat(self, pictures):
        return 0


def _frame_path(image, user, tell):
    """The file of the current frame of a sequence; "" for what has one picture only."""
    if image.source != "SEQUENCE":
        return ""
    if user is None:
        # Which file belongs to a frame is kept by the nodes that show it; without one Blender would name that of frame 0.
        tell(
            f"image '{image.name}' is a sequence, of which only the file that it was made from is used",
            "feature:image sequence",
        )
        path = image.filepath
    else:
        path = image.filepath_from_user(image_user=user)
    return bpy.path.abspath(path, library=image.library)


def _read_all(image, path, tell):
    if image.source == "TILED":
        return [picture for tile in image.tiles for picture in _read_tile(image, tile.number, tell)]
    if path:
        return _read_file(image, path, tell)
    if image.source == "MOVIE":
        tell(f"image '{image.name}' is a movie, of which only the frame that Blender shows is used", "feature:movie as image")
    # Bytes that Blender holds are those of the file, unless it has divided them by alpha.
    is_file = image.source == "FILE" and image.packed_file is None and not image.is_dirty
    if is_file and (not image.has_data or image.is_float or image.alpha_mode == "PREMUL"):
        pictures = _read_file(image, bpy.path.abspath(image.filepath, library=image.library), tell)
        if pictures:
            return pictures
    # What Blender had not loaded before, it need not keep.
    had_data = image.has_data
    pictures = _read(image, image, tell, _space(image))
    if not had_data and not image.is_dirty:
        main_thread.run(image.buffers_free)
    return pictures


def _space(image):
    """(name, whether it is data) of the colour space. Tiles that Blender has not looked at have no name yet."""
    return image.colorspace_settings.name, image.colorspace_settings.is_data


def _read_file(image, path, tell, tile=0):
    """A file outside of the .blend with its values as they are stored, which Cycles decodes after interpolation."""
    if not os.path.isfile(path):
        return []
    try:
        with stored(path) as source:
            return _read(image, source, tell, _space(image), tile, is_stored=True)
    except RuntimeError:
        return []


def _read_tile(image, number, tell):
    if image.is_dirty:
        tell(f"image '{image.name}' has tiles with unsaved changes, their files are used")
    column, row = (number - 1001) % 10, (number - 1001) // 10
    path = image.filepath.replace("<UDIM>", str(number)).replace("<UVTILE>", f"u{column + 1}_v{row + 1}")
    path = bpy.path.abspath(path, library=image.library)
    pictures = _read_packed(image, number, tell) or _read_file(image, path, tell, number)
    if not pictures and len(image.tiles) == 1:
        pictures = _read(image, image, tell, _space(image), number)
    if not pictures:
        tell(f"tile {number} of image '{image.name}' cannot be read ({path}), it is left out", severity=Severity.LEFT_OUT)
    return pictures


def _read_packed(image, number, tell):
    """A tile that lies in the .blend: its bytes are a file, which Blender decodes."""
    packed = next((item for item in image.packed_files if getattr(item, "tile_number", 0) == number), None)
    if packed is None or packed.packed_file is None:
        return []
    path = os.path.join(bpy.app.tempdir, f"lancer_{os.getpid()}_{number}{os.path.splitext(packed.filepath)[1]}")
    try:
        with open(path, "wb") as file:
            file.write(packed.packed_file.data)
        with loaded(path, image.colorspace_settings.name, image.alpha_mode) as source:
            return _read(image, source, tell, _space(source), number)
    except RuntimeError:
        return []
    finally:
        if os.path.exists(path):
            os.remove(path)


def _read(image, source, tell, space, tile=0, is_stored=False):
    """The picture of source under the settings of image, in a list; empty where it has no pixels.

    is_stored: floating point, too, is in the colour space, as bytes always are; otherwise it is in the working space.
    """
    if min(source.size) < 1 or source.channels < 1:
        # Only now Blender has looked at the file. It gives scripts no pixels of its layers.
        if source.type == "MULTILAYER":
            text = "is a multilayer EXR, save its layer as a plain EXR or PNG; mid-grey is used"
            tell(f"image '{image.name}' {text}", "feature:multilayer EXR", severity=Severity.WRONG)
            return [_picture(image, np.full((1, 1, 3), 0.5, np.float32), Transfer.LINEAR, AlphaMode.NONE, tile, IDENTITY)]
        return []
    values = floats(source)
    name, is_data = space
    alpha = _alpha_mode(image, source, is_data, is_stored)
    if values.shape[2] == 2:
        values = values[:, :, [0, 0, 0, 1]]
    if values.shape[2] == 4 and (alpha == AlphaMode.NONE or bool((values[:, :, 3] == 1.0).all())):
        # The mode stays: it says what becomes of colour where the picture is clipped.
        values = values[:, :, :3]
    transfer, matrix = Transfer.LINEAR, IDENTITY
    # Without a name Cycles takes values as they are.
    if name and not is_data and (is_stored or not source.is_float):
        found = conversion(name)
        # Cycles keeps texels encoded where the curve alone makes them scene-linear; what takes more comes before interpolation.
        if found is None or (found[0] == Transfer.SRGB and found[1] != IDENTITY):
            values, alpha = _converted(values, name, alpha)
            return [_picture(image, values, transfer, alpha, tile, matrix)]
        transfer, matrix = found
    texels = _floating(values) if source.is_float else _quantised(values, 255.0, np.uint8)
    return [_picture(image, texels, transfer, alpha, tile, matrix)]


def _picture(image, texels, transfer, alpha, tile, matrix):
    return snapshot.Image(name=image.name, texels=texels, transfer=transfer, alpha=alpha, tile=tile, matrix=matrix)


def _alpha_mode(image, source, is_data, is_stored):
    """As Cycles takes the pixels of source, per version."""
    if image.alpha_mode == "NONE":
        return AlphaMode.NONE
    if is_data or image.alpha_mode == "CHANNEL_PACKED":
        return AlphaMode.CHANNEL_PACKED
    if bpy.app.version >= (5, 1):
        # As the image says, even of pixels that Blender has already multiplied or divided.
        associated = image.alpha_mode == "PREMUL"
    elif is_stored:
        associated = source.file_format in _ASSOCIATED_FORMATS
    else:
        # As Blender keeps pixels in memory.
        associated = source.is_float
    return AlphaMode.ASSOCIATED if associated else AlphaMode.STRAIGHT


def _converted(values, name, alpha):
    """Values of a colour space that takes more than its curve, as floating point in the working space; and their alpha mode.

    Colour with alpha is converted straight, and multiplied by it after, as interpolation wants it.
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
    """Colour by alpha, where there is any."""
    np.divide(values[:, :, :3], values[:, :, 3:], out=values[:, :, :3], where=values[:, :, 3:] > 0.0)


def _floating(values):
    """Floating point texels; those of a 16 bit file, which are whole steps of it, as 16 bits."""
    values = np.ascontiguousarray(values)
    if not np.isfinite(values).all():
        values[~np.isfinite(values).all(axis=2)] = 0.0
    sample = values.reshape(-1)[:: max(1, values.size // 4096)]
    if _is_stepped(sample) and _is_stepped(values):
        return _quantised(values, _WHITE, np.uint16)
    return values


def _is_stepped(values):
    """Whether all are whole steps of 16 bits, to the rounding of single precision, which is 2^-9 of a step."""
    if values.min() < 0.0 or values.max() > 1.0:
        return False
    steps = values * _WHITE
    return bool((np.abs(steps - np.rint(steps)) <= 2.0**-8).all())


def _quantised(values, scale, dtype):
    """Whole steps between 0 and 1 again, some rows at a time so that memory does not peak."""
    texels = np.empty(values.shape, dtype)
    rows = max(1, _VALUES_AT_ONCE // (values.shape[1] * values.shape[2]))
    for first in range(0, len(values), rows):
        part = slice(first, first + rows)
        texels[part] = values[part] * np.float32(scale) + np.float32(0.5)
    return texels
