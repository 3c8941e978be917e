"""Data that the pictures of an animation, or of a scene with Persistent Data, have in common."""

from bpy.app.handlers import persistent

from ..export.kept import Kept
from ..export.parts import Parts
from ..host.by_scene import ByScene
from ..host.registering import add_handlers, remove_handlers

_kept = ByScene()
_jobs = 0  # how many renders, of a picture or an animation, have begun


def begin(scene, is_animation):
    """Begin a picture of a scene."""
    if is_animation or scene.render.use_persistent_data:
        _kept.setdefault(scene, Kept()).next_picture()
    else:
        _kept.pop(scene, None)


def of(scene):
    """Return the Kept of a scene; None if its pictures have nothing in common."""
    return _kept.get(scene)


class Following:
    """The Parts of an engine whose depsgraph Blender keeps from one picture to the next."""

    def __init__(self):
        self._key = self._parts = self._job = None

    def take(self, depsgraph, layers):
        """Return the Parts for an export of the depsgraph, to be given back; None if the next picture has another depsgraph.

        layers: the number of view layers of the picture, which take turns in one depsgraph. A depsgraph tells its updates once:
        after an export that failed, the next one reads everything.
        """
        key = depsgraph.as_pointer(), depsgraph.view_layer.name
        before, parts = self._key, self._parts
        self._key = self._parts = None
        if not depsgraph.scene.render.use_persistent_data or layers > 1:
            return None
        self._key = key
        if parts is None or key != before:
            parts = Parts(watches=True)
        # Reading packed files takes seconds for a gigabyte, too long for each frame of an animation.
        if self._job != _jobs:
            parts.images.digests.clear()
            self._job = _jobs
        return parts

    def give_back(self, parts):
        # The function belongs to the engine, which owns this object.
        parts.images.obey = None
        self._parts = parts


@persistent
def _begun(*_):
    global _jobs
    _jobs += 1


@persistent
def _forget(*_):
    """Drop all caches before another file is loaded."""
    _kept.clear()


@persistent
def _forget_kept(scene, *_):
    """Drop the scene's cache after the last frame, or after Esc."""
    if not scene.render.use_persistent_data:
        _kept.pop(scene, None)


_HANDLERS = (("render_init", _begun), ("load_pre", _forget), ("render_complete", _forget_kept), ("render_cancel", _forget_kept))


def register():
    add_handlers(_HANDLERS)


def unregister():
    remove_handlers(_HANDLERS)
    _forget()
