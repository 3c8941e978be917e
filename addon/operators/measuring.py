"""Base of operators that examine the scene that F12 would render: one export, a worker thread, progress, Esc.

Results are kept in memory only; no file and no data of the artist changes.
"""

import logging
import threading

import bpy
from bpy.app.handlers import persistent

from ..bindings.abi import LancerError
from ..bindings.session import Cancelled
from ..engine import render_export
from ..export.settings import glass_owner
from ..host import by_scene, priority, redraw

# (operator's bl_idname, fraction, text) of the running work, by scene.
running = by_scene.ByScene()
# (thread, timer) of modal operators.
_looked_at = []
# Number of changes of objects, materials or lights since figures are kept, by scene.
_changes = by_scene.ByScene()

_TICK = 0.1

# Settings that noise and time depend on, apart from the numbers of samples and pixels.
_OWN = (
    "integrator",
    "max_bounces",
    "contribution_threshold",
    "transparent_bounces",
    "environment_reflections",
    "clamp_indirect",
    "pixel_filter",
    "filter_width",
    "accelerator",
    "features",
)
_RENDER = ("film_transparent", "use_border", "use_crop_to_border", "threads_mode", "threads", "use_simplify")


class _Measurement(threading.Thread):
    """The worker thread; it accesses no data of Blender."""

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
            # The forecast is for a render in a window, whose threads have a lower priority.
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
    """Base class: subclasses define work(), which returns the function to run, and keep(scene, measurement).

    figures: the mapping of results by scene, cleared when another file is loaded.
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
            # A render in parallel would falsify the times.
            measurement.stop.set()
            self.report({"WARNING"}, f"Lancer: '{self.bl_label}' was stopped because a render has begun")
        self._show()
        context.window_manager.progress_update(measurement.progress[0])
        redraw.properties()
        if measurement.is_alive():
            return {"RUNNING_MODAL"}
        self._leave(context)
        return self._ended(measurement)

    def cancel(self, context):
        """Stop the work; Blender calls this when it closes the window or loads another file."""
        self._measurement.stop.set()
        self._measurement.join()
        self._leave(context)
        _watch_figures()

    def _show(self):
        scene = by_scene.find(self._scene)
        fraction, text = self._measurement.progress
        text = "Stopping" if self._measurement.stop.is_set() else text
        if scene is not None:
            # self.bl_idname has the spelling of the C class: use the Python class's.
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
        # Operator properties are valid in Blender's thread only: work() copies them now.
        measurement = _Measurement(self.work(), export)
        _watch(True)
        self.messages = export.messages
        self.begun(context, export.snapshot)
        measurement.start()
        return measurement

    def begun(self, context, snapshot):
        """Called before the work starts, to record the state of the scene."""

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
            self.report({"WARNING"}, "Lancer: the measured scene has been removed")
            return False
        self.keep(scene, measurement)
        return True


def _missing(scene):
    """Return why no measurement can start now; "" if one can."""
    if scene is None or scene.camera is None:
        return "The scene has no camera"
    # Two in parallel would falsify their times.
    if running:
        return "A measurement or a check is running"
    return "A render is running" if bpy.app.is_job_running("RENDER") else ""


def state(scene):
    """Return a tuple that changes when measured figures are out of date."""
    own, render = scene.lancer, scene.render
    border = (render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y) if render.use_border else ()
    shape = render.resolution_x / render.resolution_y, render.pixel_aspect_x / render.pixel_aspect_y, *border
    values = [getattr(own, name) for name in _OWN] + [getattr(render, name) for name in _RENDER]
    glass = glass_owner(scene)
    values += [glass.film_transparent_glass, glass.film_transparent_roughness]
    return (_changes.get(scene, 0), *values, *shape, scene.camera.name if scene.camera else "", scene.frame_current)


def _changed(scene, depsgraph):
    if any(
        update.is_updated_geometry or update.is_updated_transform or update.is_updated_shading for update in depsgraph.updates
    ):
        _changes[scene] = _changes.get(scene, 0) + 1


def _watch(on):
    """Start or stop counting changes of scenes, which costs a handler call for each change."""
    handlers = bpy.app.handlers.depsgraph_update_post
    if on and _changed not in handlers:
        handlers.append(_changed)
    if not on:
        _changes.clear()
        if _changed in handlers:
            handlers.remove(_changed)


def _watch_figures():
    """Count changes only while there are figures that can become old."""
    _watch(any(cls.figures for cls in Measuring.__subclasses__()))


@persistent
def _forget(*_):
    """Drop all figures before another file is loaded."""
    for cls in Measuring.__subclasses__():
        cls.figures.clear()
    _watch(False)


def register():
    bpy.app.handlers.load_pre.append(_forget)


def unregister():
    # Blender drops a modal operator whose class is unregistered, without calling its cancel(): end the work here.
    while _looked_at:
        measurement, timer = _looked_at.pop()
        measurement.stop.set()
        measurement.join()
        bpy.context.window_manager.event_timer_remove(timer)
        bpy.context.window_manager.progress_end()
    running.clear()
    bpy.app.handlers.load_pre.remove(_forget)
    _forget()
