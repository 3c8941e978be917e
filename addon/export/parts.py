"""Incremental export for a window: only data that the depsgraph reports as updated is read again.

    parts = Parts()
    snapshot, messages = export_scene(depsgraph, ExportOptions(view=camera, parts=parts))

The snapshot is the same as without parts; parts.counts counts what was read for it. Every update of the depsgraph must be
exported, as a window's view_update does.
"""

import dataclasses
from typing import NamedTuple

import bpy

from ..host.by_scene import identity
from ..messages.messages import Messages
from .images import Images

_CHANGES_WITH_TIME = ("MOVIE", "SEQUENCE")


class _Mesh(NamedTuple):
    owners: frozenset  # identities of the data whose updates change it
    size: tuple  # of Blender's mesh
    data: object


class _Shader(NamedTuple):
    """The export of the nodes of a material, a world or a lamp."""

    owners: frozenset  # identities of the data whose updates change it
    exported: object
    messages: Messages
    pictures: frozenset  # identities of Blender's images
    numbers: frozenset
    with_time: bool


class _Asked:
    """A wrapper of Images that records the requests of one shader."""

    def __init__(self, images):
        self._images = images
        self.pictures, self.numbers_used, self.with_time = set(), set(), False

    @property
    def list(self):
        return self._images.list

    def numbers(self, image, user, tell):
        found = self._images.numbers(image, user, tell)
        self.pictures.add(identity(image))
        self.with_time = self.with_time or image.source in _CHANGES_WITH_TIME
        if found is not None:
            self.numbers_used.update(range(found[0], sum(found)))
        return found

    def repeat(self, pictures):
        first = self._images.repeat(pictures)
        self.numbers_used.update(range(first, first + len(pictures)))
        return first


class Parts:
    def __init__(self):
        self.images = Images()
        self.counts = {}
        self._meshes, self._used_meshes = {}, {}
        self._shaders, self._used_shaders = {}, {}
        self._frame = None
        self._last = None  # snapshot, Messages and Places of the last export

    def begin(self, depsgraph, obey):
        """Drop data that has changed since the last export.

        Return (snapshot, Messages) if objects have moved and nothing else has changed. Else return None; the caller exports
        and then calls end().
        """
        self._used_meshes, self._used_shaders = {}, {}
        self.counts = dict.fromkeys(("objects", "meshes", "shaders", "images"), 0)
        self.images.obey = obey
        updates = [_Update(update) for update in depsgraph.updates]
        forgotten = self._forget(updates, depsgraph.scene.frame_current_final)
        last, self._last = self._last, None
        if last is None or forgotten or not updates or not all(update.moves_only for update in updates):
            return None
        snapshot, messages, places = last
        # An attribute may be a property that moves with its object.
        if snapshot.instances.attributes:
            return None
        try:
            matrices = places.matrices(depsgraph)
        except (RuntimeError, TypeError):
            # foreach_get fails if the number of entries has changed.
            return None
        snapshot = snapshot.replaced(instances=dataclasses.replace(snapshot.instances, matrices=matrices))
        self._last = snapshot, messages, places
        return snapshot, messages.copy()

    def _forget(self, updates, frame):
        """Drop what the updates change; return whether anything was dropped."""
        changed = {update.key for update in updates}
        reshaped = {update.key for update in updates if update.reshapes}
        moved = {update.key for update in updates if update.moves}
        pictures = {update.key for update in updates if update.is_picture}
        later, self._frame = frame != self._frame, frame
        before = len(self._meshes), len(self._shaders)
        self._meshes = {key: mesh for key, mesh in self._meshes.items() if not mesh.owners & reshaped}
        for key, shader in list(self._shaders.items()):
            by_others = shader.pictures & pictures or shader.exported.objects & moved or changed and shader.exported.reads_layer
            if shader.owners & changed or by_others or shader.with_time and later:
                del self._shaders[key]
        if pictures:
            self.images.forget(pictures, self._numbers())
        return before != (len(self._meshes), len(self._shaders))

    def mesh(self, thing, owner, data_key, wanted, read):
        """Return the mesh of an evaluated object, from read() if it is not cached."""
        data = thing.data
        size = len(data.vertices), len(data.loops), len(data.polygons)
        original = thing.original.data
        key = data_key, identity(original) if original is not None else None, wanted
        owners = frozenset(identity(item) for item in (thing, owner, original) if item is not None)
        found = self._meshes.get(key)
        if found is None or found.size != size:
            self.count("meshes")
            found = _Mesh(owners, size, read())
        self._used_meshes[key] = found._replace(owners=found.owners | owners)
        return found.data

    def shader(self, blocks, messages, read, place=()):
        """Return read(messages, images) of the nodes of blocks, cached. Its field objects lists the objects it depends on.

        place tells results of the same blocks apart.
        """
        owners = tuple(map(identity, blocks))
        key = owners, place
        found = self._shaders.get(key)
        if found is None:
            self.count("shaders")
            asked, told, known = _Asked(self.images), Messages(), len(self.images.list)
            exported = read(told, asked)
            self.count("images", len(self.images.list) - known)
            with_time = asked.with_time or exported.reads_time
            pictures, numbers = frozenset(asked.pictures), frozenset(asked.numbers_used)
            found = _Shader(exported.owners.union(owners), exported, told, pictures, numbers, with_time)
        self._used_shaders[key] = found
        messages.merge(found.messages)
        return found.exported

    def count(self, kind, number=1):
        self.counts[kind] += number

    def end(self, snapshot, messages, places):
        """Keep the data that this export has used, and drop the rest."""
        self._meshes, self._used_meshes = self._used_meshes, {}
        self._shaders, self._used_shaders = self._used_shaders, {}
        self.images.forget((), self._numbers())
        self._last = snapshot, messages.copy(), places

    def _numbers(self):
        return frozenset().union(*(shader.numbers for shader in self._shaders.values()))


class _Update:
    """One update of the depsgraph, classified for the export."""

    def __init__(self, update):
        block = update.id
        is_object = isinstance(block, bpy.types.Object)
        self.key = identity(block)
        self.is_picture = isinstance(block, bpy.types.Image)
        self.moves = update.is_updated_transform
        # A new material updates the shading of all its objects and meshes, not their geometry.
        self.reshapes = update.is_updated_geometry
        # A lamp's light depends on its transform and must be read again.
        is_lamp = is_object and block.type == "LIGHT"
        self.moves_only = is_object and self.moves and not (self.reshapes or update.is_updated_shading or is_lamp)
