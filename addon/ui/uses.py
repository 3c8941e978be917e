"""The panel with the features that the scene uses, their memory and their measured costs."""

import bpy

from .. import engine
from ..measure.scene_features import kernel_in_words
from ..operators import measure_features
from .panel import LancerRenderPanel, draw_measuring
from .sentences import sentence

_MEASURE = "lancer.measure_features"
_MEMORY = {
    "geometry_bytes": "Geometry and lights",
    "accelerator_bytes": "Acceleration",
    "texture_bytes": "Textures",
    "mapped_bytes": "Textures in a temporary file",
    "film_bytes": "Film",
}


def _size(size):
    return f"{size / 2**20:.1f} MB" if size >= 2**20 / 20 else f"{size / 2**10:.1f} kB"


def _share(value):
    return f"{value * 100:.0f} %"


class LANCER_RENDER_PT_uses(LancerRenderPanel, bpy.types.Panel):
    bl_label = "What This Scene Uses"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        name = context.scene.name
        column = self.layout.column(align=True)
        statistics = engine.last_statistics.get(name)
        if statistics is None:
            column.label(text="Shown after the first render")
        else:
            for feature in statistics["uses"]:
                sentence(column, context, feature["text"])
            column.separator()
            sentence(column, context, f"Rendered by the code for {kernel_in_words(statistics['kernel'])}")
            column.separator()
            for key, what in _MEMORY.items():
                if statistics[key] or key != "mapped_bytes":
                    column.label(text=f"{what}: {_size(statistics[key])}")
        column.separator()
        if draw_measuring(column, context.scene, _MEASURE):
            return
        column.operator(_MEASURE, icon="TIME")
        costs = engine.last_costs.get(name)
        if costs is None:
            return
        if measure_features.is_old(context.scene):
            sentence(column, context, "Measured before the last changes", "ERROR")
        if not costs.hints:
            which = "None of the features that were measured" if costs.skipped else "No feature"
            sentence(column, context, f"{which} would save 3 % of the time with certainty", "CHECKMARK")
        for cost in costs.hints:
            start, rest = cost.text.split("; ", 1)
            sentence(column, context, start, "INFO")
            sentence(column, context, rest)
            told = f"about {cost.seconds:.1f} s, {_share(cost.share)} plus or minus {_share(cost.uncertainty)}"
            sentence(column, context, f"{told}. Without: {cost.without}")
        if costs.skipped:
            sentence(column, context, f"Not measured for lack of time: {len(costs.skipped)} more")


CLASSES = (LANCER_RENDER_PT_uses,)
