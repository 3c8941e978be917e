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
from .images import Images
from .shader_cache import ShaderCache


class _Mesh(NamedTuple):
    owners: frozenset  # identities of the data whose updates change it
    size: tuple  # of Blender's mesh
    data: object


class Parts:
    def __init__(self):
        self.images = Images()
        self.shaders = ShaderCache(self.images)
        self.counts = {}
        self._images_before = 0
        self._meshes, self._used_meshes = {}, {}
        self._frame = None
        self._last = None  # snapshot, Messages and Places of the last export

    def read_by(self, cache):
        """Read all images again if the scene's TextureCache has changed."""
        if cache == self.images.texture_cache:
            return
        self.images = Images()
        self.images.texture_cache = cache
        self.shaders = ShaderCache(self.images)
        self._last = None

    def begin(self, depsgraph, obey):
        """Drop data that has changed since the last export.

        Return (snapshot, Messages) if objects have moved and nothing else has changed. Else return None; the caller exports
        and then calls end().
        """
        self._used_meshes = {}
        self.shaders.begin()
        self.counts = dict.fromkeys(("objects", "meshes", "shaders", "images"), 0)
        self._images_before = self.images.placed
        self.images.obey = obey
        updates = [_Update(update) for update in depsgraph.updates]
        forgotten = self._forget(updates, depsgraph.scene.frame_current_final)
        last, self._last = self._last, None
        if last is None or forgotten or not updates or not all(update.moves_only for update in updates):
            return None
        snapshot, messages, places = last
        # An attribute may be a property that moves with its object.
        if snapshot.instances.attributes or places is None:
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
        before = len(self._meshes)
        self._meshes = {key: mesh for key, mesh in self._meshes.items() if not mesh.owners & reshaped}
        forgotten = self.shaders.forget(changed, moved, pictures, later)
        if pictures:
            self.images.forget(pictures, self.shaders.numbers())
        return forgotten or before != len(self._meshes)

    def mesh(self, thing, owner, data, data_key, wanted, read):
        """Return the mesh of an evaluated object, from read() if it is not cached. data: the mesh that it is made of."""
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

    def count(self, kind):
        self.counts[kind] += 1

    def end(self, snapshot, messages, places):
        """Keep the data that this export has used, and drop the rest.

        places: the Places of the instances; None if more than they move with objects.
        """
        self.counts.update(shaders=self.shaders.count, images=self.images.placed - self._images_before)
        self._meshes, self._used_meshes = self._used_meshes, {}
        self.shaders.end()
        self.images.forget((), self.shaders.numbers())
        self._last = snapshot, messages.copy(), places


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
