"""The exports of materials, worlds and lamps by their data-blocks, kept from one export with Parts to the next."""

import os
from typing import NamedTuple

import bpy

from ..host.by_scene import identity
from ..messages.messages import Messages

_CHANGES_WITH_TIME = ("MOVIE", "SEQUENCE")


class Sources(NamedTuple):
    """Data apart from their own data-block that nodes read."""

    objects: frozenset = frozenset()  # identities of the objects whose transform they read
    layer: bool = False  # properties of the view layer, the scene or its world
    time: bool = False  # the frame or the time
    texts: frozenset = frozenset()  # (identity, contents)
    files: frozenset = frozenset()  # (path, time, size)


class _Shader(NamedTuple):
    """The export of the nodes of a material, a world or a lamp."""

    exported: object  # its field sources is a Sources
    messages: Messages
    pictures: frozenset  # identities of Blender's images
    numbers: frozenset
    with_time: bool


class _Variants:
    """The exports of one data-block, which differ in the facts of the object that shows it."""

    def __init__(self):
        self._shaders = {}  # by names of facts, then by their values and by whom the messages name

    def find(self, who, value):
        for names, found in self._shaders.items():
            values = tuple(value(name, Messages()) for name in names)
            shader = found.get((values, None)) or found.get((values, who))
            if shader is not None:
                return names, values, shader
        return None

    def add(self, who, names, values, shader):
        # An export without messages names nobody.
        self._shaders.setdefault(names, {})[values, who if shader.messages else None] = shader

    def keep(self, is_kept):
        """Drop shaders for which is_kept(shader) is false."""
        for names, found in self._shaders.items():
            self._shaders[names] = {key: shader for key, shader in found.items() if is_kept(shader)}

    def __iter__(self):
        return (shader for found in self._shaders.values() for shader in found.values())


class _Asked:
    """A wrapper of Images that records the requests of one shader."""

    def __init__(self, images):
        self.images = images
        self.pictures, self.numbers_used, self.with_time = set(), set(), False

    @property
    def list(self):
        return self.images.list

    @property
    def texture_cache(self):
        return self.images.texture_cache

    def numbers(self, image, user, tell, in_memory=False):
        found = self.images.numbers(image, user, tell, in_memory)
        self.pictures.add(identity(image))
        self.with_time = self.with_time or image.source in _CHANGES_WITH_TIME
        if found is not None:
            self.numbers_used.update(range(found[0], sum(found)))
        return found

    def repeat(self, pictures):
        first = self.images.repeat(pictures)
        self.numbers_used.update(range(first, first + len(pictures)))
        return first

    def table(self, texels):
        number = self.images.table(texels)
        self.numbers_used.add(number)
        return number


class ShaderCache:
    """count is the number of shaders read since begin()."""

    def __init__(self, images):
        self.images = images
        self._known, self._used = {}, {}
        self.count = 0

    def begin(self):
        self._used = {}
        self.count = 0

    def find(self, block, messages, read, who="", value=None):
        """Return read(messages, images, value) of the nodes of a data-block, cached.

        The result's field sources tells which other data it depends on. who: whom its messages name.
        value(name, messages): a fact of the object that shows it, which read gets as value(name); a result is returned again
        only where all facts that it asked for are equal.
        """
        key = identity(block)
        used = self._used.setdefault(key, _Variants())
        for variants in (used, self._known.get(key)):
            found = None if variants is None else variants.find(who, value)
            if found is not None:
                names, values, shader = found
                break
        else:
            names, values, shader = self._read(read, value)
        used.add(who, names, values, shader)
        messages.merge(shader.messages)
        return shader.exported

    def _read(self, read, value):
        """Return names and values of the facts that read asks for, and the _Shader."""
        self.count += 1
        asked, told, facts = _Asked(self.images), Messages(), {}

        def fact(name):
            facts[name] = value(name, told)
            return facts[name]

        exported = read(told, asked, None if value is None else fact)
        pictures, numbers = frozenset(asked.pictures), frozenset(asked.numbers_used)
        shader = _Shader(exported, told, pictures, numbers, asked.with_time or exported.sources.time)
        return tuple(facts), tuple(facts.values()), shader

    def forget(self, changed, is_changed, moved, pictures, later):
        """Drop results that depend on changed data; return whether there were any.

        changed: identities of data-blocks, without objects that have only moved. is_changed: whether anything has changed.
        moved() returns the identities of all objects that have moved. later: another frame is shown.
        """
        before = len(self._all())
        texts = _Texts()

        def is_kept(shader):
            sources = shader.exported.sources
            by_objects = sources.objects and sources.objects & moved()
            by_others = shader.pictures & pictures or by_objects or is_changed and sources.layer
            is_old = by_others or shader.with_time and later
            return (
                not is_old and all(map(texts.has, sources.texts)) and all(file_state(file[0]) == file for file in sources.files)
            )

        self._known = {key: variants for key, variants in self._known.items() if key not in changed}
        for variants in self._known.values():
            variants.keep(is_kept)
        return before != len(self._all())

    def end(self):
        """Keep the results that this export has used."""
        self._known, self._used = self._used, {}

    def numbers(self):
        """Return the numbers of the images in use."""
        return frozenset().union(*(shader.numbers for shader in self._all()))

    def _all(self):
        return [shader for variants in self._known.values() for shader in variants]


def file_state(path):
    """Return path, time and size of a file; the time and size are None if the file is missing."""
    try:
        told = os.stat(path)
    except OSError:
        return path, None, None
    return path, told.st_mtime_ns, told.st_size


class _Texts:
    """The current contents of Blender's texts, which the depsgraph does not report as changed."""

    def __init__(self):
        self._contents = None

    def has(self, text):
        """Whether a text of Sources still has these contents."""
        if self._contents is None:
            self._contents = {identity(block): block.as_string() for block in bpy.data.texts}
        key, contents = text
        return self._contents.get(key) == contents
