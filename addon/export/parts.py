"""Incremental export, for a window and for renders that keep their depsgraph: only data reported as updated is read again.

    parts = Parts()
    snapshot, messages = export_scene(depsgraph, ExportOptions(parts=parts))

The snapshot is the same as without parts; parts.counts counts what was read for it. Every update of the depsgraph must be
exported, as a window's view_update does.
"""

import dataclasses
import itertools
from typing import NamedTuple

import bpy
import numpy as np

from ..bindings.enums import ObjectKind
from ..host import shared_scenes
from ..host.by_scene import identity
from .animated import has_traits, only_moves, traits
from .images import Images
from .shader_cache import ShaderCache

# Whether Blender reports other materials of an object as its move.
_MOVES_MEAN_MORE = bpy.app.version < (4, 2)


class _Mesh(NamedTuple):
    owners: frozenset  # identities of the data whose updates change it
    size: tuple  # of Blender's mesh
    data: object


class _Export(NamedTuple):
    snapshot: object  # without camera and settings
    messages: object
    places: object  # the Places of the instances; None if more than they move with objects
    geometries: list  # of each name of the instance table, see with_even_normals
    state: object  # of scene and view layer, on which objects and messages depend


class Parts:
    def __init__(self, watches=False):
        """watches: whether images are read again once their files have changed, of which the depsgraph does not tell."""
        self.images = Images(watches=watches)
        self.shaders = ShaderCache(self.images)
        self.counts = {}
        self._images_before = 0
        self._meshes, self._used_meshes = {}, {}
        self._lights = []
        self.even = {}  # of with_even_normals
        self._traits = {}  # of objects that have some, see has_traits
        self._frame = None
        self._last = None  # the _Export before

    def read_by(self, cache):
        """Read all images again if the scene's TextureCache has changed."""
        if cache == self.images.texture_cache:
            return
        self.images = Images(watches=self.images.watches)
        self.images.texture_cache = cache
        self.shaders = ShaderCache(self.images)
        self._last = None

    def begin(self, depsgraph, state, obey):
        """Drop data that has changed since the last export. state: see _Export.

        Return (snapshot without camera and settings, Messages, geometries) if objects have moved and nothing else has changed.
        Else return None; the caller exports and then calls end().
        """
        self._used_meshes = {}
        self.shaders.begin()
        self.counts = dict.fromkeys(("objects", "meshes", "shaders", "images"), 0)
        self._images_before = self.images.placed
        self.images.obey = obey
        moved, others = _updates(depsgraph)
        last, self._last = self._last, None
        is_other = last is None or state != last.state
        forgotten = self._forget(moved, others, is_other, depsgraph.scene.frame_current_final)
        # Each export remembers the traits of all objects that have some.
        moves_only = [self._moves_only(update) for update in others]
        if is_other or forgotten or not all(moves_only):
            return None
        # An attribute may be a property that moves with its object.
        if last.snapshot.instances.attributes or last.places is None:
            return None
        # The scene's update also stands for what a view hides, and for other relations between objects, which shade all anew.
        may_differ = last.places.space is not None or not moved
        if may_differ and any(update.is_scene for update in others) and not last.places.shows_the_same(depsgraph):
            return None
        try:
            matrices = last.places.matrices(depsgraph)
        except (RuntimeError, TypeError):
            # foreach_get fails if the number of entries has changed.
            return None
        table = last.snapshot.instances
        if not np.array_equal(matrices.view(np.uint64), table.matrices.view(np.uint64)):
            table = dataclasses.replace(table, matrices=matrices)
        self._last = last._replace(snapshot=last.snapshot.replaced(instances=table))
        return self._last.snapshot, last.messages.copy(), last.geometries

    def _moves_only(self, update):
        """Whether an update moves an object at most."""
        if not update.has_traits:
            return update.is_harmless
        now = traits(update.block)
        before, self._traits[update.key] = self._traits.get(update.key), now
        return now == before and update.may_move and only_moves(update.block)

    def _forget(self, moved, others, is_other, frame):
        """Drop what the updates change; return whether anything was dropped.

        moved: objects that have only moved. is_other: whether settings have changed, for which Blender may have no update.
        """
        changed = {update.key for update in others}
        reshaped = {update.key for update in others if update.reshapes}
        pictures = {update.key for update in others if update.is_picture} | self.images.changed()
        later, self._frame = frame != self._frame, frame
        before = len(self._meshes)
        self._meshes = {key: mesh for key, mesh in self._meshes.items() if not mesh.owners & reshaped}

        def places():
            return {*map(identity, moved), *(update.key for update in others if update.moves)}

        forgotten = self.shaders.forget(changed, is_other or bool(moved or others), places, pictures, later)
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
            # The views of one scene hold one copy of each mesh.
            found = _Mesh(owners, size, shared_scenes.stock.known(ObjectKind.MESH, read()))
        self._used_meshes[key] = found._replace(owners=found.owners | owners)
        return found.data

    def lights(self, found):
        """Return lights, each as the record of the export before where that is equal."""
        self._lights = [old if new == old else new for new, old in itertools.zip_longest(found, self._lights)][: len(found)]
        return self._lights

    def count(self, kind):
        self.counts[kind] += 1

    def end(self, snapshot, messages, places, geometries, state):
        """Keep the data that this export has used, and drop the rest. The arguments are the fields of an _Export."""
        self.counts.update(shaders=self.shaders.count, images=self.images.placed - self._images_before)
        self._meshes, self._used_meshes = self._used_meshes, {}
        self.shaders.end()
        self.images.forget((), self.shaders.numbers())
        self._last = _Export(snapshot, messages.copy(), places, geometries, state)


def _updates(depsgraph):
    """Return the objects of a depsgraph's updates that have only moved, and the other updates as _Updates."""
    updates = depsgraph.updates
    flags = [np.zeros(len(updates), bool) for _ in range(3)]
    for name, values in zip(("transform", "geometry", "shading"), flags, strict=True):
        updates.foreach_get(f"is_updated_{name}", values)
    moved, others = [], []
    for update, moves, reshapes, shades in zip(updates, *(values.tolist() for values in flags), strict=True):
        block = update.id
        # A lamp's light depends on its transform and must be read again.
        is_object = isinstance(block, bpy.types.Object) and block.type != "LIGHT"
        if is_object and moves and not (reshapes or shades or has_traits(block)):
            moved.append(block)
        else:
            others.append(_Update(block, is_object, moves, reshapes, shades))
    if _MOVES_MEAN_MORE and any(update.is_scene for update in others):
        others += [_Update(block, True, True, False, False) for block in moved]
        moved = []
    return moved, others


class _Update:
    """One update of the depsgraph, classified for the export. is_object: False for lamps."""

    def __init__(self, block, is_object, moves, reshapes, shades):
        self.key = identity(block)
        self.is_picture = isinstance(block, bpy.types.Image)
        self.is_scene = isinstance(block, bpy.types.Scene)
        self.moves = moves
        # A new material updates the shading of all its objects and meshes, not their geometry.
        self.reshapes = reshapes
        self.has_traits = is_object and has_traits(block)
        # An object with an action is reported as shaded anew in each frame.
        self.may_move = is_object and not reshapes and (not shades or block.animation_data is not None)
        # Each export reads the camera and compares the scene's state, and the objects of an action are reported themselves.
        self.is_harmless = self.is_scene or isinstance(block, (bpy.types.Action, bpy.types.Camera))
        # Evaluated data lives as long as the depsgraph is not evaluated again.
        self.block = block
