"""Images in their own bit depth, exported once however many materials use them."""

import hashlib

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.enums import AlphaMode, ObjectKind
from ..host import main_thread, shared_scenes
from ..host.by_scene import identity
from ..messages.severity import Severity
from .frames import shown
from .image_sources import has_cached_file, read_all, read_memory
from .image_state import image_state
from .missing import is_black, missing
from .scratch import Scratch, bytes_in_memory
from .smaller_images import NO_LIMIT, smaller

# Takes the place of an image that is not used any more, until another one gets its number.
_NOTHING = snapshot.Image(name="nothing", texels=np.zeros((1, 1, 1), np.uint8))


class Images:
    """The images that nodes use, by number."""

    def __init__(self, obey=None, kept=None, watches=False):
        """obey is called before each file and raises Cancelled if the user cancels. kept: the Kept of earlier frames.

        watches: whether changed() is going to be called.
        """
        self.list = []
        self.placed = 0  # images so far, those included that are not used any more
        self.obey = obey
        self.frame = 1  # of the scene
        self.is_preview = False  # whether the images are shown in a preview of a material or a world
        self.texture_cache = None  # the scene's TextureCache
        self.limit = NO_LIMIT  # of the size of images
        self.watches = watches
        self._states = {}  # image_state() by the keys of _ranges
        self.digests = {}  # of image_state(); to be emptied where a script may have packed other files
        self._kept = kept
        self._scratch = Scratch()
        self._ranges = {}
        self._lost = set()  # keys of _ranges
        self._tables = {}
        self._free = set()  # numbers
        self._held = 0  # bytes in memory

    def numbers(self, image, user, tell, in_memory=False):
        """Return (first, count) of a Blender image, one for each tile; None if it cannot be read. tell(text, key, severity).

        in_memory: keep the texels in memory, since all of them will be read.
        """
        seen = shown(image, user, self.frame)
        has_mipmaps = not self.is_preview and has_cached_file(self.texture_cache, image, seen)
        key = (identity(image), image.colorspace_settings.name, image.alpha_mode, seen, has_mipmaps, self.limit)
        if key not in self._ranges:
            if self.watches:
                self._states[key] = self._state(image, seen)
            with main_thread.obeying(self.obey):
                read = self._reader(read_all, in_memory, has_mipmaps)
                # Cycles shows unsaved strokes in previews.
                if self.is_preview and image.source == "FILE" and image.is_dirty:
                    read = self._reader(read_memory, in_memory)
                elif self._kept is not None:
                    read = self._kept.pictures(read, (has_mipmaps, self.limit))
                pictures = read(image, seen, tell)
            if not pictures:
                self._lost.add(key)
                pictures = [missing(image)] if is_black(image) else []
            self._ranges[key] = (self.repeat(pictures), len(pictures)) if pictures else None
        found = self._ranges[key]
        if key in self._lost:
            text = f"has no pixels ({seen.path or image.filepath or 'empty'})"
            color = "magenta is used" if found is None else "black is used, as in Cycles"
            tell(f"image '{image.name}' {text}, {color}", severity=Severity.WRONG)
        return found

    def _reader(self, read, in_memory, has_mipmaps=False):
        """Return a function like read(image, seen, tell) that returns a list, with texels beyond the limit in a file."""

        def made(*arguments):
            pictures = (smaller(picture, self.limit) for picture in read(*arguments))
            return (picture.replaced(mipmaps=1) if has_mipmaps else picture for picture in pictures)

        if in_memory:
            return lambda *arguments: list(made(*arguments))

        def stored(image, seen, tell):
            return self._scratch.stored(made(image, seen, tell), self._held, tell)

        return stored

    def repeat(self, pictures):
        """Add images, even known ones, so that their numbers are consecutive; return the first number."""
        numbers = range(len(self.list), len(self.list) + len(pictures))
        for number in sorted(self._free):
            if self._free.issuperset(range(number, number + len(pictures))):
                numbers = range(number, number + len(pictures))
                break
        self._free.difference_update(numbers)
        pictures = [shared_scenes.stock.known(ObjectKind.IMAGE, picture) for picture in pictures]
        self._held += sum(map(bytes_in_memory, pictures))
        self.list[numbers.start : numbers.stop] = pictures
        self.placed += len(pictures)
        return numbers.start

    def table(self, texels):
        """Return the number of an image with these texels, (rows, columns, channels) of float32. Equal tables share one."""
        key = texels.shape, hashlib.sha256(texels.tobytes()).digest()
        if key not in self._tables:
            self._tables[key] = self.repeat([snapshot.Image(name="table", texels=texels, alpha=AlphaMode.CHANNEL_PACKED)])
        return self._tables[key]

    def changed(self):
        """Return the identities of images whose files or settings are others than when their texels were read."""
        keys = {}
        for key in self._states:
            keys.setdefault(key[0], []).append(key)
        found = set()
        for image in bpy.data.images if keys else ():
            own = keys.pop(identity(image), ())
            # A key has the seen file as its fourth part.
            if any(self._states[key] is None or self._states[key] != self._state(image, key[3]) for key in own):
                found.add(identity(image))
        return found | set(keys)

    def _state(self, image, seen):
        state = image_state(image, seen, self.digests)
        return None if state is None else (state, has_cached_file(self.texture_cache, image, seen))

    def forget(self, changed, used):
        """Drop the images whose identity is in changed and those whose number is not in used."""
        for key, found in list(self._ranges.items()):
            if key[0] in changed or found is not None and found[0] not in used:
                del self._ranges[key]
                self._states.pop(key, None)
                self._lost.discard(key)
        self._tables = {key: number for key, number in self._tables.items() if number in used}
        kept = {number for found in self._ranges.values() if found is not None for number in range(found[0], sum(found))}
        for number in range(len(self.list)):
            if number not in kept and number not in used and number not in self._free:
                self._held -= bytes_in_memory(self.list[number])
                self.list[number] = _NOTHING
                self._free.add(number)


class NoPictures:
    """A stand-in for Images that reads none, for panels and for a lamp alone."""

    list = ()
    texture_cache = None

    def numbers(self, image, user, tell, in_memory=False):
        return 0, 1

    def repeat(self, pictures):
        return 0

    def table(self, texels):
        return 0
