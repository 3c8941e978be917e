"""What the features of a scene cost, measured on what F12 would render. The figures are kept in engine.last_costs."""

import functools

import bpy

from . import engine
from .bindings.hints import measure_costs
from .measuring import Measuring


def _work(seconds, snapshot, poll, tell):
    return measure_costs(snapshot, seconds, poll, tell)


class LANCER_OT_measure_features(Measuring, bpy.types.Operator):
    bl_idname = "lancer.measure_features"
    bl_label = "Measure What Features Cost"
    bl_description = (
        "Renders small pictures of the scene with and without each of its features in turn, and tells how much time each "
        "takes. Nothing in the scene is changed. Esc stops it"
    )

    seconds: bpy.props.FloatProperty(
        name="Seconds", description="How long to measure; more seconds give narrower figures", min=0.1, default=10.0
    )

    def work(self):
        return functools.partial(_work, self.seconds)

    def keep(self, scene, measurement):
        engine.keep_costs(scene.name, measurement.found)
        for cost in measurement.found.hints:
            self.report({"INFO"}, f"Lancer: {cost.text}. Without: {cost.without}")


def register():
    bpy.utils.register_class(LANCER_OT_measure_features)


def unregister():
    bpy.utils.unregister_class(LANCER_OT_measure_features)
