"""The panel with the findings of the last Check Scene and a button to select each object."""

import bpy

from ..checks.finding import Severity, shortened, told
from ..operators import check_scene
from .panel import LancerRenderPanel, draw_measuring
from .sentences import sentence

_CHECK = "lancer.check_scene"
_ICONS = {Severity.WRONG: "ERROR", Severity.DIFFERENT: "ERROR", Severity.WASTE: "TIME", Severity.HINT: "INFO"}


class LANCER_RENDER_PT_check(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Check"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        name = context.scene.name
        self._column().prop(context.scene.lancer, "use_check")
        column = self.layout.column(align=True)
        if draw_measuring(column, context.scene, _CHECK, "Checking"):
            return
        column.operator(_CHECK, icon="VIEWZOOM")
        findings = check_scene.last_findings.get(name)
        if findings is None:
            return
        messages = check_scene.last_messages[name]
        if not findings and not messages:
            column.label(text="No faults found", icon="CHECKMARK")
        for finding, left in shortened(findings):
            name = finding.object or finding.light
            row = sentence(column, context, told(finding, left), _ICONS[finding.severity], buttons=1 if name else 0)
            if name:
                row.operator("lancer.select_object", text="", icon="RESTRICT_SELECT_OFF").name = name
        for line in messages:
            sentence(column, context, line, "DOT")


CLASSES = (LANCER_RENDER_PT_check,)
