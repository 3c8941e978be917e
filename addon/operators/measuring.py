"""Operators that look at what F12 would render, beside Blender's window: one export, a thread that works, progress, Esc.

What they find is kept in this session only; no file and no data of the artist's changes.
"""

import logging
import threading

import bpy
from bpy.app.handlers import persistent

from ..bindings.abi import LancerError
from ..bindings.session import Cancelled
from ..engine import render_export
from ..host import by_scene, priority, redraw

# (operator's bl_idname, fraction, text) of the work that runs, by its scene.
running = by_scene.ByScene()
# The threads of those beside a window, each with the timer that looks at it.
_looked_at = []
# How often objects, materials or lights have changed since figures are kept, by the scene.
_changes = by_scene.ByScene()

_TICK = 0.1

# What noise and time hang on, apart from the number of samples and of pixels.
_OWN = (
    "integrator",
    "max_bounces",
    "contribution_threshold",
    "transparent_bounces",
    "environment_reflections",
    "clamp_indirect",
    "pixel_filter",
    "filter_width",
    "film_transparent_glass",
    "film_transparent_roughness",
    "accelerator",
    "features",
)
_RENDER = ("film_transparent", "use_border", "use_crop_to_border", "threads_mode", "threads", "use_simplify")


class _Measurement(threading.Thread):
    """It touches no data of Blender's."""

    def __init__(self, work, export):
        super().__init__(name="lancer measures", daemon=True)
        self.work, self.snapshot = work, export.snapshot
        self.exporting = export.seconds
        self.stop = threading.Event()
        self.progress = (0.0, "Building the scene")
        self.found = None
        self.error = ""

    def run(self):
        if not bpy.app.background:
            # As a render in a window does, whose seconds are foretold.
            priority.lower()
        try:
            self.found = self.work(self.snapshot, poll=self.stop.is_set, tell=self._tell)
        except Cancelled:
            pass
        except LancerError as error:
            self.error = str(error)
        except MemoryError:
            self.error = "not enough memory for this scene"
        except Exception as error:
            logging.getLogger(__name__).exception("measuring failed")
            self.error = f"{type(error).__name__}: {error}"
        self.snapshot = None

    def _tell(self, fraction, text):
        self.progress = (fraction, text)


class Measuring:
    """What such operators share. They give work() and keep(scene, measurement).

    figures: the mapping in which they keep what they find, which ends with the file.
    """

    figures = {}

    @classmethod
    def poll(cls, context):
        missing = _missing(context.scene)
        if missing:
            cls.poll_message_set(missing)
        return not missing

    def execute(self, context):
        measurement = self._started(context)
        if measurement is not None:
            measurement.join()
        return self._ended(measurement)

    def invoke(self, context, event):
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._measurement = self._started(context)
        if self._measurement is None:
            return self._ended(None)
        self._show()
        manager = context.window_manager
        self._timer = manager.event_timer_add(_TICK, window=context.window)
        _looked_at.append((self._measurement, self._timer))
        manager.progress_begin(0.0, 1.0)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        measurement = self._measurement
        if event.type == "ESC":
            measurement.stop.set()
        if event.type != "TIMER":
            return {"RUNNING_MODAL"} if event.type == "ESC" else {"PASS_THROUGH"}
        if bpy.app.is_job_running("RENDER") and not measurement.stop.is_set():
            # Beside it everything takes longer.
            measurement.stop.set()
            self.report({"WARNING"}, f"Lancer: '{self.bl_label}' was stopped, as a render has begun")
        self._show()
        context.window_manager.progress_update(measurement.progress[0])
        redraw.properties()
        if measurement.is_alive():
            return {"RUNNING_MODAL"}
        self._leave(context)
        return self._ended(measurement)

    def cancel(self, context):
        """Blender closes the window or loads another file."""
        self._measurement.stop.set()
        self._measurement.join()
        self._leave(context)
        _watch_figures()

    def _show(self):
        scene = by_scene.find(self._scene)
        fraction, text = self._measurement.progress
        text = "Stopping" if self._measurement.stop.is_set() else text
        if scene is not None:
            # An operator's own bl_idname is spelt as that of its class in C.
            running[scene] = type(self).bl_idname, fraction, text

    def _leave(self, context):
        running.clear()
        _looked_at.remove((self._measurement, self._timer))
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        redraw.properties()

    def _started(self, context):
        self._scene = by_scene.identity(context.scene)
        try:
            export = render_export.export(context)
        except LancerError as error:
            self.report({"ERROR"}, f"Lancer: {error}")
            return None
        # Blender writes properties of an operator in its own thread only: the work gets what it needs of them now.
        measurement = _Measurement(self.work(), export)
        _watch(True)
        self.messages = export.messages
        self.begun(context, export.snapshot)
        measurement.start()
        return measurement

    def begun(self, context, snapshot):
        """For what is to be noted of the scene as it is measured."""

    def _ended(self, measurement):
        kept = self._keep(measurement)
        _watch_figures()
        return {"FINISHED"} if kept else {"CANCELLED"}

    def _keep(self, measurement):
        if measurement is None or measurement.found is None:
            if measurement is not None and measurement.error:
                self.report({"ERROR"}, f"Lancer: {measurement.error}")
            return False
        scene = by_scene.find(self._scene)
        if scene is None:
            self.report({"WARNING"}, "Lancer: the scene of which figures were measured is gone")
            return False
        self.keep(scene, measurement)
        return True


def _missing(scene):
    """Why there is nothing to measure now; "" where there is."""
    if scene is None or scene.camera is None:
        return "The scene has no camera"
    # Two at once would slow each other down.
    if running:
        return "A measurement or a check is running"
    return "A render is running" if bpy.app.is_job_running("RENDER") else ""


def state(scene):
    """Another one when what was measured is not true of the scene any more."""
    own, render = scene.lancer, scene.render
    border = (render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y) if render.use_border else ()
    shape = render.resolution_x / render.resolution_y, render.pixel_aspect_x / render.pixel_aspect_y, *border
    values = [getattr(own, name) for name in _OWN] + [getattr(render, name) for name in _RENDER]
    return (_changes.get(scene, 0), *values, *shape, scene.camera.name if scene.camera else "", scene.frame_current)


def _changed(scene, depsgraph):
    if any(
        update.is_updated_geometry or update.is_updated_transform or update.is_updated_shading for update in depsgraph.updates
    ):
        _changes[scene] = _changes.get(scene, 0) + 1


def _watch(on):
    """Whether changes of scenes are counted: each costs a call."""
    handlers = bpy.app.handlers.depsgraph_update_post
    if on and _changed not in handlers:
        handlers.append(_changed)
    if not on:
        _changes.clear()
        if _changed in handlers:
            handlers.remove(_changed)


def _watch_figures():
    """Only figures that are kept can become old."""
    _watch(any(cls.figures for cls in Measuring.__subclasses__()))


@persistent
def _forget(*_):
    """Another file has other scenes."""
    for cls in Measuring.__subclasses__():
        cls.figures.clear()
    _watch(False)


def register():
    bpy.app.handlers.load_pre.append(_forget)


def unregister():
    # Blender drops an operator whose class goes, without a word to it.
    while _looked_at:
        measurement, timer = _looked_at.pop()
        measurement.stop.set()
        measurement.join()
        bpy.context.window_manager.event_timer_remove(timer)
        bpy.context.window_manager.progress_end()
    running.clear()
    bpy.app.handlers.load_pre.remove(_forget)
    _forget()
