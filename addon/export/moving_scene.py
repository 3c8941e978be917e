"""Export of a scene for a picture: as it stands, or while its shutter is open."""

import dataclasses
import math

from .images import Images
from .scene import export_scene
from .shader_cache import ShaderCache


def export_picture(depsgraph, options, frame_set, poll=None):
    """Return (SceneSnapshot, Messages) of a scene with what moves while options.shutter is open, as export_scene.

    frame_set: of the RenderEngine; it is called with the scene's own frame at the end, and if the export fails.
    """
    shutter = options.shutter
    if shutter is None:
        return export_scene(depsgraph, options, poll)
    scene = depsgraph.scene
    now = scene.frame_current, scene.frame_subframe

    def set_frame(time):
        frame = math.floor(time)
        frame_set(frame, time - frame)

    options = dataclasses.replace(options, set_frame=set_frame)
    try:
        settings = None
        if shutter.middle != now[0] + now[1]:
            # As in Cycles, materials are those of the frame; objects, lamps and the camera are those of the shutter's middle.
            options = dataclasses.replace(options, shaders=ShaderCache(Images(kept=options.kept)))
            still = dataclasses.replace(options, shutter=None)
            settings = export_scene(depsgraph, still, poll)[0].settings
            set_frame(shutter.middle)
        snapshot, messages = export_scene(depsgraph, options, poll)
        return snapshot if settings is None else snapshot.replaced(settings=settings), messages
    finally:
        frame_set(*now)
