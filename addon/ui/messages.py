"""The panel that tells how the last render went: its error, its speed, and what of the scene it could not show."""

import bpy

from .. import engine, stamp
from ..harm import Harm
from .render import LancerRenderPanel
from .sentences import sentence


class LANCER_RENDER_PT_messages(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Messages of the Last Render"

    def draw(self, context):
        messages = engine.last_messages.get(context.scene.name)
        column = self.layout.column(align=True)
        statistics = engine.last_statistics.get(context.scene.name)
        if statistics is not None:
            # The error, then what it does not count.
            for line in stamp.of_layers(statistics):
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
        if all(message.harm == Harm.HINT for message in messages.told()):
            sentence(column, context, "All of the scene was rendered as it is", "CHECKMARK")
        for message in messages.told():
            sentence(column, context, message.line, "INFO" if message.harm == Harm.HINT else "ERROR")


CLASSES = (LANCER_RENDER_PT_messages,)
