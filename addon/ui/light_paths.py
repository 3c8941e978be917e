"""Light Paths in the Render tab: the limits of paths, and how much light each has removed from the last render."""

import bpy

from ..engine import last_statistics
from ..measure.render_report import CHANGED, NOTHING, REMOVED, changed_light, percent
from ..settings import presets
from .panel import LancerRenderPanel, setting, uses_classic
from .sentences import sentence

# A note for users of Cycles.
_REPLACED = (
    "These settings replace Cycles' bounces, Clamp Indirect and Filter Glossy, and leave no light out by default. Messages "
    "report differences by them, and how much light each limit removes."
)

_FAST = "Bounced light is replaced by a guess, or the guess is added to it."


def draw_biases(column, context, *names):
    """Draw what limits have done to the light of the last render, by names in its statistics, where they have changed any."""
    numbers = last_statistics.get(context.scene.name, {})
    for name in names:
        if name in CHANGED:
            if told := changed_light(numbers, name):
                sentence(column, context, told)
        elif numbers.get(name, 0.0) > NOTHING:
            told = f"{REMOVED[name]} {percent(numbers[name])} of the light of the last render"
            sentence(column, context, told[0].upper() + told[1:])


class LANCER_RENDER_PT_light_paths(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Light Paths"
    bl_options = {"DEFAULT_CLOSED"}
    draw_header_preset = presets.draw_light_paths

    def draw(self, context):
        sentence(self.layout.column(align=True), context, _REPLACED)


class LANCER_RENDER_PT_max_bounces(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Max Bounces"
    bl_parent_id = "LANCER_RENDER_PT_light_paths"

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(settings, "max_bounces", text="Total")
        kinds = column.column()
        kinds.active = settings.integrator == "PATH"
        for kind in ("diffuse", "glossy", "transmission"):
            kinds.prop(settings, f"{kind}_bounces", text=kind.capitalize())
        draw_biases(column, context, "error_cut")
        column.prop(settings, "transparent_bounces", text="Transparent")


class LANCER_RENDER_PT_clamping(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Clamping"
    bl_parent_id = "LANCER_RENDER_PT_light_paths"

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.active = settings.integrator == "PATH"
        setting(column, "sample_clamp_direct", getattr(context.scene, "cycles", None), text="Direct Light")
        column.prop(settings, "clamp_indirect", text="Indirect Light")
        draw_biases(column, context, "error_clipped_direct", "error_clipped")


class LANCER_RENDER_PT_caustics(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Caustics"
    bl_parent_id = "LANCER_RENDER_PT_light_paths"

    def draw(self, context):
        settings, cycles = context.scene.lancer, getattr(context.scene, "cycles", None)
        column = self._column()
        column.active = settings.integrator == "PATH"
        column.prop(settings, "filter_glossy")
        draw_biases(column, context, "error_filtered")
        setting(column, "caustics_reflective", cycles, text="Reflective")
        setting(column, "caustics_refractive", cycles, text="Refractive")
        draw_biases(column, context, "error_no_caustics")


class LANCER_RENDER_PT_fast_gi(LancerRenderPanel, bpy.types.Panel):
    """Settings of Cycles, which Lancer follows."""

    bl_label = "Fast GI Approximation"
    bl_parent_id = "LANCER_RENDER_PT_light_paths"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and hasattr(context.scene, "cycles")

    def draw_header(self, context):
        self.layout.prop(context.scene.cycles, "use_fast_gi", text="")

    def draw(self, context):
        scene, cycles = context.scene, context.scene.cycles
        column = self._column()
        column.active = cycles.use_fast_gi and scene.lancer.integrator == "PATH"
        column.prop(cycles, "fast_gi_method", text="Method")
        if scene.world is not None:
            column.prop(scene.world.light_settings, "ao_factor", text="AO Factor")
            column.prop(scene.world.light_settings, "distance", text="AO Distance")
        if cycles.fast_gi_method == "REPLACE":
            column.prop(cycles, "ao_bounces", text="Viewport Bounces")
            column.prop(cycles, "ao_bounces_render", text="Render Bounces")
        sentence(column, context, _FAST)
        draw_biases(column, context, "error_guessed")


class LANCER_RENDER_PT_classic(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Classic"
    bl_parent_id = "LANCER_RENDER_PT_light_paths"

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.active = uses_classic(context.scene)
        column.prop(settings, "contribution_threshold", text="Threshold")
        column.prop(settings, "environment_reflections", text="Reflect Sky Only")


CLASSES = (
    LANCER_RENDER_PT_light_paths,
    LANCER_RENDER_PT_max_bounces,
    LANCER_RENDER_PT_clamping,
    LANCER_RENDER_PT_caustics,
    LANCER_RENDER_PT_fast_gi,
    LANCER_RENDER_PT_classic,
)
