"""Object > Bake in the engine: one engine bakes all images of one object."""

from ..bake.bake import Bake
from ..bake.baked_scene import BakedScene
from . import render_job
from .picture import Picture
from .results import last_messages


class Baking:
    """A part of the render engine."""

    _baked = None  # the BakedScene of the object; it ends with the engine, which Blender frees after the last image
    _bakes_on = True  # no image of the object has failed or been cancelled

    def bake(self, depsgraph, object, pass_type, pass_filter, width, height):
        if not self._bakes_on or self._is_over():
            return
        scene = depsgraph.scene
        if self._picture is None:
            self._picture = Picture((scene.name, scene.frame_current_final), ())
            last_messages.pop(scene, None)
        self._baked = self._baked or BakedScene()
        with render_job.baking():
            job = Bake(self, depsgraph, object, self._baked, lambda messages: self._tell(scene, messages), self._is_over)
            self._bakes_on = self._guarded(scene, job.run, pass_type, pass_filter, width, height)
