"""The panel that lists what the last Check Scene found, with a way to each object."""

import bpy

from . import check_scene
from .checks.finding import Harm, shortened, told
from .ui_render import LancerPanel

_ICONS = {Harm.WRONG: "ERROR", Harm.WASTE: "TIME", Harm.HINT: "INFO"}
# Letters in a line: Blender cuts off what is longer than the panel.
_WIDTH = 60


class LANCER_RENDER_PT_check(LancerPanel, bpy.types.Panel):
    bl_label = "Check"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        name = context.scene.name
        self._column().prop(context.scene.lancer, "use_check")
        column = self.layout.column(align=True)
        column.operator("lancer.check_scene", icon="VIEWZOOM")
        findings = check_scene.last_findings.get(name)
        if findings is None:
            return
        messages = check_scene.last_messages[name]
        if not findings and not messages:
            column.label(text="Nothing found that would hurt", icon="CHECKMARK")
        for finding, left in shortened(findings):
            row = _show(column, told(finding, left), _ICONS[finding.harm])
            if finding.object or finding.light:
                button = row.operator("lancer.select_object", text="", icon="RESTRICT_SELECT_OFF")
                button.name = finding.object or finding.light
        for line in messages:
            _show(column, line, "DOT")


def _show(column, text, icon):
    """Writes a sentence in as many lines as it takes; gives the row of the first."""
    first, *rest = _wrapped(text)
    row = column.row(align=True)
    row.label(text=first, icon=icon)
    for part in rest:
        column.label(text=part, icon="BLANK1")
    return row


def _wrapped(text):
    parts = [""]
    for word in text.split():
        if parts[-1] and len(parts[-1]) + len(word) >= _WIDTH:
            parts.append("")
        parts[-1] += f" {word}" if parts[-1] else word
    return parts


CLASSES = (LANCER_RENDER_PT_check,)
