"""Images beyond a limit of memory: their texels are written once, in blocks, to a file that the library maps.

The file is in Blender's folder for temporary files. It has no name, or the system removes it with its last user, so that it
ends with the scenes that read it, also if Blender crashes.
"""

import os
import tempfile

import bpy
import numpy as np

from ..bindings.blocks import Blocks, even_sample, in_blocks
from ..bindings.enums import AlphaMode
from ..bindings.mapped_file import MappedFile
from ..bindings.mipmaps import smaller_levels
from ..host.machine_memory import machine_memory
from ..messages.severity import Severity

# Bytes of images in memory, from the add-on's preferences; 0 = a share of the machine's memory.
image_memory = 0
_SHARE = 0.25
# Smaller images stay in memory: they need little, and a block of a small image is mostly padding.
_LEAST = 1 << 20
_IN_MEMORY = ("tmpfs", "ramfs")
# Follows each image: the library reads whole words, which may extend beyond the last texel.
_SPARE = np.zeros(1 << 12, np.uint8)


class Scratch:
    """The files of the images of an export."""

    def __init__(self):
        self._file = None
        self._failed = False

    def stored(self, pictures, held, tell):
        """Return a list of the pictures; those beyond the limit have Blocks as texels. held: bytes of others in memory."""
        result = []
        # Scratch of a window lives longer than a value of the preferences.
        limit = image_memory or int(_SHARE * machine_memory())
        for picture in pictures:
            size = bytes_in_memory(picture)
            if held + size > limit and size >= _LEAST and not self._failed:
                try:
                    picture, size = self._moved(picture, limit), 0
                except OSError as error:
                    # A full disk must not end the render.
                    self._failed = True
                    text = f"image '{picture.name}' and all after it stay in memory: {error.strerror or error}"
                    tell(f"{text} ({bpy.app.tempdir}, of Preferences > File Paths)", severity=Severity.WASTE)
            held += size
            result.append(picture)
        return result

    def _moved(self, picture, limit):
        """Return the picture with its texels in the file."""
        # A file that a scene reads is not written any more.
        if self._file is None or self._file.is_mapped:
            self._file = _new_file(limit)
        texels, file = picture.texels, self._file
        offset, gaps = file.size, 0
        is_straight = picture.alpha == AlphaMode.STRAIGHT and texels.shape[2] == 4
        for blocks in in_blocks(texels):
            if texels.dtype == np.float32:
                gaps += int((~np.isfinite(blocks).all(axis=-1)).sum())
            file.write(_associated(blocks) if is_straight else blocks)
        for level in smaller_levels(picture) if picture.mipmaps else ():
            for blocks in in_blocks(level):
                file.write(blocks)
        file.write(_SPARE)
        sample = even_sample(texels)
        sample = _associated(sample) if is_straight else sample.copy()
        moved = Blocks(texels.shape, texels.dtype, file, offset, gaps, sample)
        return picture.replaced(texels=moved, alpha=AlphaMode.ASSOCIATED if is_straight else picture.alpha)


def bytes_in_memory(picture):
    """Return the bytes of a picture's texels, with those of its levels, which make a third more; 0 if they are in a file."""
    if isinstance(picture.texels, Blocks):
        return 0
    return picture.texels.nbytes * 4 // 3 if picture.mipmaps else picture.texels.nbytes


def _associated(texels):
    """Return texels with their colour multiplied by alpha, with the roundings of the library, which does so for rows."""
    color, alpha = texels[..., :3], texels[..., 3:]
    if texels.dtype == np.float32:
        return np.concatenate((color * alpha, alpha), axis=-1)
    largest = np.iinfo(texels.dtype).max
    return np.concatenate(((color.astype(np.uint32) * alpha // largest).astype(texels.dtype), alpha), axis=-1)


def _new_file(limit):
    folder = bpy.app.tempdir
    if _kind_of_disk(folder) in _IN_MEMORY:
        raise OSError("the folder for temporary files is itself in memory")
    return MappedFile(tempfile.TemporaryFile(prefix="lancer_", dir=folder), limit)


def _kind_of_disk(folder):
    """Return the name of the file system of a folder on Linux, else an empty text."""
    number = os.stat(folder).st_dev
    try:
        with open("/proc/self/mountinfo", encoding="utf-8", errors="replace") as mounts:
            # 36 35 98:0 / /tmp rw shared:1 - ext4 /dev/root rw: the third field is the device, the first after "-" the kind.
            for line in mounts:
                if line.split()[2] == f"{os.major(number)}:{os.minor(number)}":
                    return line.partition(" - ")[2].split()[0]
    except OSError:
        pass
    return ""
