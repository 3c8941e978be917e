"""What is kept of scenes in memory: found by a scene or its name, followed when it is renamed, gone when it is."""

from collections.abc import MutableMapping

import bpy


class ByScene(MutableMapping):
    """A mapping whose keys are scenes of bpy.data, or the names that they have now; it iterates over names."""

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
        # What is kept of scenes that are gone, too.
        self._values.clear()


def identity(block):
    """What stays the same of a scene, or of other data, when it is renamed, edited and undone, and is that of no later one.

    Blenders before 4.1 tell its address only, which a later one may have: there one with another name is another one.
    """
    block = block.original
    uid = getattr(block, "session_uid", None)
    # Blocks of different types may share a number.
    return (type(block).__name__, *((block.as_pointer(), block.name) if uid is None else (uid,)))


def find(wanted):
    """The scene of that identity; None when it is gone."""
    return next((scene for scene in bpy.data.scenes if identity(scene) == wanted), None)


def _scene(scene):
    return bpy.data.scenes[scene] if isinstance(scene, str) else scene
