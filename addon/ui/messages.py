"""Panels with error, speed and messages of the last render, and with messages of the viewport."""

import bpy

from .. import engine
from ..measure import render_report
from ..messages.severity import Severity
from ..viewport import viewport
from .panel import LancerRenderPanel
from .sentences import sentence


class LANCER_RENDER_PT_messages(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Messages of the Last Render"

    def draw(self, context):
        messages = engine.last_messages.get(context.scene.name)
        column = self.layout.column(align=True)
        statistics = engine.last_statistics.get(context.scene.name)
        if statistics is not None:
            # The error, then the biases that it does not include.
            for line in render_report.of_layers(statistics):
                for part in line.split("; "):
                    sentence(column, context, part[0].upper() + part[1:])
            rate = f"{statistics['rays_per_second'] / 1e6:.2f} million rays per second"
            sentence(column, context, f"{rate} ({statistics['instruction_set']})")
            if statistics["denoised"]:
                size = statistics["denoising_bytes"] / 2**20
                text = f"{statistics['denoiser']}: {statistics['denoising_seconds']:.1f} s, {size:.0f} MB"
                sentence(column, context, text)
        if messages is None:
            column.label(text="Nothing rendered yet")
            return
        _draw_messages(column, context, messages, "The whole scene is supported")


class LANCER_RENDER_PT_viewport_messages(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Messages of the Viewport"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        column = self.layout.column(align=True)
        messages = viewport.last_messages.get(context.scene.name)
        if messages is None:
            column.label(text="No view in Rendered shading yet")
        else:
            _draw_messages(column, context, messages, "The whole scene is supported")


def _draw_messages(column, context, messages, none):
    if all(message.severity == Severity.HINT for message in messages.told()):
        sentence(column, context, none, "CHECKMARK")
    for message in messages.told():
        sentence(column, context, message.line, "INFO" if message.severity == Severity.HINT else "ERROR")


CLASSES = (LANCER_RENDER_PT_messages, LANCER_RENDER_PT_viewport_messages)
