"""Redraw of panels with results of a render or a measurement; Blender redraws only the area under the pointer by itself."""

import bpy

from . import main_thread

_LOOK_AGAIN = 0.1  # seconds


def properties():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()


def properties_after_render():
    """Redraw the properties editors when the running render has ended; may be called from the render thread."""
    if not bpy.app.background:
        main_thread.post(_watch)


def _watch():
    if not bpy.app.timers.is_registered(_when_over):
        bpy.app.timers.register(_when_over)


def _when_over():
    if bpy.app.is_job_running("RENDER"):
        return _LOOK_AGAIN
    properties()
    return None


def forget():
    """Cancel the redraw after the render."""
    if bpy.app.timers.is_registered(_when_over):
        bpy.app.timers.unregister(_when_over)
