"""Data kept in memory for scenes, by scene or current name: it survives renaming and ends with the scene."""

from collections.abc import MutableMapping

import bpy


class ByScene(MutableMapping):
    """A mapping whose keys are scenes of bpy.data or their current names; iteration yields names."""

    def __init__(self):
        self._values = {}

    def __getitem__(self, scene):
        return self._values[identity(_scene(scene))]

    def __setitem__(self, scene, value):
        self._values[identity(_scene(scene))] = value

    def __delitem__(self, scene):
        del self._values[identity(_scene(scene))]

    def __iter__(self):
        return (scene.name for scene in bpy.data.scenes if identity(scene) in self._values)

    def __len__(self):
        return sum(1 for _ in self)

    def clear(self):
        # Drop the data of removed scenes too, over which MutableMapping.clear would not iterate.
        self._values.clear()


def identity(block):
    """Return a key of a data-block that renaming, editing and undo keep and that no later data-block shares.

    Before Blender 4.1 the key is address and name: a later data-block may get the same address, and renaming changes the key.
    """
    block = block.original
    uid = getattr(block, "session_uid", None)
    # Data-blocks of different types may share a number.
    return (type(block).__name__, *((block.as_pointer(), block.name) if uid is None else (uid,)))


def find(wanted):
    """Return the scene of that identity; None if it has been removed."""
    return next((scene for scene in bpy.data.scenes if identity(scene) == wanted), None)


def _scene(scene):
    return bpy.data.scenes[scene] if isinstance(scene, str) else scene
