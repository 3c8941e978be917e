"""Check Scene finds faults that will hurt the picture; Select Object selects the object of a finding."""

import bpy
from bpy.app.handlers import persistent

from ..bindings.session import Cancelled
from ..checks.check import check_snapshot
from ..checks.finding import lines
from ..host.by_scene import ByScene
from ..host.registering import add_all
from . import measuring

# Findings and messages of the export of each scene's last Check Scene.
last_findings = ByScene()
last_messages = ByScene()


class LANCER_OT_check_scene(measuring.Measuring, bpy.types.Operator):
    bl_idname = "lancer.check_scene"
    bl_label = "Check Scene"
    bl_description = "Find faults of the scene that will hurt the picture or waste time. Esc stops the check"

    def work(self):
        return _check

    def keep(self, scene, measurement):
        findings = measurement.found
        last_findings[scene], last_messages[scene] = findings, self.messages
        for line in lines(findings):
            self.report({"WARNING"}, f"Lancer: {line}")
        if not findings:
            self.report({"INFO"}, "Lancer: no faults found")


def _check(snapshot, poll, tell):
    def obey(share):
        if poll():
            raise Cancelled
        if share is not None:
            tell(share, "Looking for faults")

    return check_snapshot(snapshot, poll=obey)


class LANCER_OT_select_object(bpy.types.Operator):
    """Select this object and make it the active one"""

    bl_idname = "lancer.select_object"
    bl_label = "Select Object"
    bl_options = {"UNDO"}

    name: bpy.props.StringProperty(name="Object")

    def execute(self, context):
        objects = context.view_layer.objects
        thing = objects.get(self.name)
        if thing is None:
            self.report({"WARNING"}, f"'{self.name}' is no object of this view layer")
            return {"CANCELLED"}
        active = objects.active
        if active is not None and active != thing and active.mode != "OBJECT":
            # Else the old active object would stay in Edit Mode, unnoticed.
            bpy.ops.object.mode_set(mode="OBJECT")
        for other in objects:
            other.select_set(False)
        # A hidden object cannot be selected, but as the active object it shows its properties.
        thing.select_set(True)
        objects.active = thing
        return {"FINISHED"}


_OPERATORS = (LANCER_OT_check_scene, LANCER_OT_select_object)


@persistent
def _forget(*_):
    """Drop all findings before another file is loaded."""
    last_findings.clear()
    last_messages.clear()


def register():
    add_all(_OPERATORS, bpy.utils.register_class, bpy.utils.unregister_class)
    bpy.app.handlers.load_pre.append(_forget)


def unregister():
    bpy.app.handlers.load_pre.remove(_forget)
    for cls in reversed(_OPERATORS):
        bpy.utils.unregister_class(cls)
    _forget()
