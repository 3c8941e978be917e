"""What the features of a scene cost, measured on what F12 would render: an operator with progress, and what it found.

The figures are kept in this session, in engine.last_costs; no file and no data of the artist's changes.
"""

import logging
import threading

import bpy

from . import engine
from .bindings.abi import LancerError
from .bindings.hints import measure_costs
from .bindings.session import Cancelled
from .export.scene import ExportOptions, export_scene
from .passes import render_passes

# (fraction, text) of a measurement that runs, by the scene's name.
running = {}

_TICK = 0.1


class _Measurement(threading.Thread):
    """Measures beside Blender's window; it touches no data of Blender's."""

    def __init__(self, snapshot, seconds):
        super().__init__(name="lancer measures features", daemon=True)
        self.snapshot, self.seconds = snapshot, seconds
        self.stop = threading.Event()
        self.progress = (0.0, "Building the scene")
        self.costs = None
        self.error = ""

    def run(self):
        try:
            self.costs = measure_costs(self.snapshot, self.seconds, self.stop.is_set, self._tell)
        except Cancelled:
            pass
        except LancerError as error:
            self.error = str(error)
        except MemoryError:
            self.error = "not enough memory to measure this scene"
        except Exception as error:
            logging.getLogger(__name__).exception("measuring failed")
            self.error = f"{type(error).__name__}: {error}"
        self.snapshot = None

    def _tell(self, fraction, text):
        self.progress = (fraction, text)


class LANCER_OT_measure_features(bpy.types.Operator):
    bl_idname = "lancer.measure_features"
    bl_label = "Measure What Features Cost"
    bl_description = (
        "Renders small pictures of the scene with and without each of its features in turn, and tells how much time each "
        "takes. Nothing in the scene is changed. Esc stops it"
    )

    seconds: bpy.props.FloatProperty(
        name="Seconds", description="How long to measure; more seconds give narrower figures", min=0.1, default=10.0
    )

    @classmethod
    def poll(cls, context):
        return context.scene is not None and context.scene.camera is not None and context.scene.name not in running

    def execute(self, context):
        measurement = self._started(context)
        if measurement is not None:
            measurement.join()
        return self._ended(context, measurement)

    def invoke(self, context, event):
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._measurement = self._started(context)
        if self._measurement is None:
            return {"CANCELLED"}
        manager = context.window_manager
        self._timer = manager.event_timer_add(_TICK, window=context.window)
        manager.progress_begin(0.0, 1.0)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        measurement = self._measurement
        if event.type == "ESC":
            measurement.stop.set()
        if event.type != "TIMER":
            return {"RUNNING_MODAL"} if event.type == "ESC" else {"PASS_THROUGH"}
        running[self._scene] = measurement.progress
        context.window_manager.progress_update(measurement.progress[0])
        _redraw(context)
        if measurement.is_alive():
            return {"RUNNING_MODAL"}
        self._leave(context)
        return self._ended(context, measurement)

    def cancel(self, context):
        """Blender closes the window or loads another file."""
        self._measurement.stop.set()
        self._measurement.join()
        self._leave(context)

    def _leave(self, context):
        running.pop(self._scene, None)
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        _redraw(context)

    def _started(self, context):
        self._scene = context.scene.name
        depsgraph = context.evaluated_depsgraph_get()
        wanted = tuple(item.source for item in render_passes(depsgraph.scene, depsgraph.view_layer_eval))
        try:
            snapshot, _ = export_scene(depsgraph, ExportOptions(passes=wanted))
        except LancerError as error:
            self.report({"ERROR"}, f"Lancer: {error}")
            return None
        measurement = _Measurement(snapshot, self.seconds)
        measurement.start()
        return measurement

    def _ended(self, context, measurement):
        if measurement is None or measurement.costs is None:
            if measurement is not None and measurement.error:
                self.report({"ERROR"}, f"Lancer: {measurement.error}")
            return {"CANCELLED"}
        engine.keep_costs(self._scene, measurement.costs)
        for cost in measurement.costs.hints:
            self.report({"INFO"}, f"Lancer: {cost.text}. Without: {cost.without}")
        return {"FINISHED"}


def _redraw(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()


def register():
    bpy.utils.register_class(LANCER_OT_measure_features)


def unregister():
    bpy.utils.unregister_class(LANCER_OT_measure_features)
    running.clear()
