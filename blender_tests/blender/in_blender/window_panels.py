"""In a real window: the panels that Blender draws, and their contents, while it measures, renders and loads another file.

Started by window_case.py. Nothing here draws or redraws: only Blender's own drawings are logged.
"""

import os
import time

import bpy

import addon
from addon.ui import messages, sampling


def watch(say):
    """Show the render's properties, and log what is drawn there."""
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "PROPERTIES":
            area.spaces[0].context = "RENDER"
    draw_measuring, draw_messages = sampling.draw_measuring, messages.LANCER_RENDER_PT_messages.draw

    def measuring(*arguments):
        drawn = draw_measuring(*arguments)
        say("draws-progress" if drawn else "draws-button")
        return drawn

    def told(panel, context):
        draw_messages(panel, context)
        over = not bpy.app.is_job_running("RENDER")
        say("draws-figures" if over and context.scene.name in addon.engine.last_statistics else "draws-no-figures")

    sampling.draw_measuring, messages.LANCER_RENDER_PT_messages.draw = measuring, told


def measure():
    """Measure as the panel's button does. Return "running_modal", or "refused" if the button is grey."""
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        if not bpy.ops.lancer.measure_quality.poll():
            return "refused"
        return next(iter(bpy.ops.lancer.measure_quality("INVOKE_DEFAULT", seconds=600.0))).lower()


def check(say):
    """Check as the panel's button does, with a check that never ends by itself."""

    def endless(_snapshot, poll):
        try:
            while True:
                poll(0.5)
                time.sleep(0.02)
        finally:
            say("check-cancelled")

    addon.operators.check_scene.check_snapshot = endless
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        return next(iter(bpy.ops.lancer.check_scene("INVOKE_DEFAULT"))).lower()


def switch():
    """Switch the add-on off and on again."""
    addon.unregister()
    addon.register()
    bpy.context.scene.render.engine = "LANCER"
    return "can-measure" if bpy.ops.lancer.measure_quality.poll() else "cannot-measure"


def load(folder):
    """Load another file, whose scene has the same name: no result of the old scene may be shown."""
    path = os.path.join(folder, "other.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.wm.open_mainfile(filepath=path)
    known = [
        *addon.operators.measuring.running,
        *addon.operators.measure_quality.measured,
        *addon.engine.last_statistics,
        *addon.engine.last_messages,
    ]
    return "knows-" + ("-".join(known) or "nothing")
