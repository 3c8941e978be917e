"""Measure What Features Cost: the cost of each feature of the scene that F12 would render, kept in engine.last_costs."""

import functools

import bpy

from ..engine.results import keep_costs
from ..host.by_scene import ByScene
from ..measure.costs import measure_costs
from . import measuring

# The state of each scene when the figures in engine.last_costs were measured.
_states = ByScene()


def _state(scene):
    # Costs in seconds are those of the whole frame: they depend on samples and resolution too.
    render = scene.render
    return *measuring.state(scene), scene.lancer.samples, render.resolution_x, render.resolution_percentage


def is_old(scene):
    return scene in _states and _states[scene] != _state(scene)


class LANCER_OT_measure_features(measuring.Measuring, bpy.types.Operator):
    bl_idname = "lancer.measure_features"
    bl_label = "Measure What Features Cost"
    figures = _states
    bl_description = (
        "Render small pictures of the scene with and without each of its features, and report the time that each feature "
        "takes. The scene is not changed. Esc stops it"
    )

    seconds: bpy.props.FloatProperty(
        name="Seconds", description="Time of the measurement; more seconds give narrower intervals", min=0.1, default=10.0
    )

    def work(self):
        return functools.partial(measure_costs, seconds=self.seconds)

    def begun(self, context, snapshot):
        self._state = _state(context.scene)

    def keep(self, scene, measurement):
        _states[scene] = self._state
        keep_costs(scene, measurement.found)
        for cost in measurement.found.hints:
            self.report({"INFO"}, f"Lancer: {cost.text}. Without: {cost.without}")


def register():
    bpy.utils.register_class(LANCER_OT_measure_features)


def unregister():
    bpy.utils.unregister_class(LANCER_OT_measure_features)
