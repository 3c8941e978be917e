"""Panels of the render and of the view layer, and what all of Lancer's panels share."""

import bpy

from . import denoise, engine, measuring, presets, quality, stamp
from .bindings.enums import Pass
from .export.checks import EMPTY_PASSES
from .harm import Harm
from .ui_lines import sentence

_ID = engine.LancerRenderEngine.bl_idname
_MEASURE = "lancer.measure_quality"

# What an artist who comes from Cycles should know before the first render.
_REPLACED = (
    "They replace Cycles' bounces and clamping. Filter Glossy and limits of single kinds of bounces are not there. Where light "
    "differs by any of them, the messages tell."
)

_DENOISING = (
    "Open Image Denoise guesses what lies under the noise. The error given is that of the picture before, the pass Noisy Image."
)


class LancerPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {_ID}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def _column(self):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


class LANCER_RENDER_PT_sampling(LancerPanel, bpy.types.Panel):
    bl_label = "Sampling"
    bl_context = "render"
    draw_header_preset = presets.draw_sampling

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(settings, "integrator")
        column.prop(settings, "quality")
        column.prop(settings, "target_error")
        column.prop(settings, "samples", text="Samples" if settings.target_error == 0.0 else "Most Samples")
        column.prop(settings, "time_limit")
        column.prop(settings, "seed")
        column.prop(settings, "use_animated_seed")
        _draw_forecast(self.layout.column(align=True), context)


def _draw_forecast(column, context):
    """What each quality would take and give, as far as it was measured."""
    scene = context.scene
    if draw_measuring(column, scene, _MEASURE):
        return
    column.operator(_MEASURE, icon="TIME")
    if scene.name not in quality.measured:
        return
    if quality.is_old(scene):
        sentence(column, context, "Measured before the last changes", "ERROR")
    for line in quality.lines(scene):
        # Panels are narrow.
        for part in line.split("; "):
            sentence(column, context, part)


def draw_measuring(column, scene, operator, doing="Measuring"):
    """In the place of that operator's button, how far it is; False where it does not run."""
    what, fraction, text = measuring.running.get(scene.name, ("", 0.0, ""))
    if what != operator:
        return False
    column.label(text=f"{doing}, {fraction * 100:.0f} % (Esc stops)", icon="TIME")
    column.label(text=text)
    return True


class LANCER_RENDER_PT_denoising(LancerPanel, bpy.types.Panel):
    bl_label = "Denoising"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.active = context.scene.lancer.integrator != "NORMALS"
        self.layout.prop(context.scene.lancer, "use_denoising", text="")

    def draw(self, context):
        column = self.layout.column()
        missing = denoise.missing()
        if missing:
            sentence(column, context, missing, "ERROR")
        sentence(column, context, _DENOISING)


class LANCER_RENDER_PT_light_paths(LancerPanel, bpy.types.Panel):
    bl_label = "Light Paths"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}
    draw_header_preset = presets.draw_light_paths

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(settings, "max_bounces")
        column.prop(settings, "transparent_bounces")
        row = column.row()
        row.active = settings.integrator == "PATH"
        row.prop(settings, "clamp_indirect")
        row = column.column()
        row.active = settings.integrator == "CLASSIC"
        row.prop(settings, "contribution_threshold")
        row.prop(settings, "environment_reflections")
        column.separator()
        sentence(column, context, _REPLACED)


class LANCER_RENDER_PT_film(LancerPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(context.scene.render, "film_transparent", text="Transparent")
        glass = column.column()
        glass.active = context.scene.render.film_transparent
        glass.prop(settings, "film_transparent_glass")
        row = glass.row()
        row.active = settings.film_transparent_glass
        row.prop(settings, "film_transparent_roughness")
        column.prop(settings, "pixel_filter")
        row = column.row()
        row.active = settings.pixel_filter == "BLACKMAN_HARRIS"
        row.prop(settings, "filter_width")


class LANCER_RENDER_PT_performance(LancerPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        render = context.scene.render
        column = self._column()
        column.prop(render, "threads_mode")
        row = column.row()
        row.enabled = render.threads_mode == "FIXED"
        row.prop(render, "threads")
        column.prop(context.scene.lancer, "accelerator")
        column.prop(context.scene.lancer, "features")


class LANCER_RENDER_PT_messages(LancerPanel, bpy.types.Panel):
    bl_label = "Messages of the Last Render"
    bl_context = "render"

    def draw(self, context):
        messages = engine.last_messages.get(context.scene.name)
        column = self.layout.column(align=True)
        statistics = engine.last_statistics.get(context.scene.name)
        if statistics is not None:
            # The error, then what it does not count.
            for line in stamp.of_layers(statistics):
                for part in line.split("; "):
                    sentence(column, context, part[0].upper() + part[1:])
            sentence(column, context, f"{statistics['rays_per_second'] / 1e6:.2f} M rays/s, {statistics['instruction_set']}")
            sentence(column, context, f"Uses: {statistics['features']}")
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


class LANCER_VIEWLAYER_PT_passes(LancerPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        layer = context.view_layer
        column = self._column()
        for name in ("z", "mist", "position", "normal", "uv", "object_index", "material_index"):
            column.prop(layer, "use_pass_" + name)
        empty = EMPTY_PASSES[context.scene.lancer.integrator]
        for component in ("diffuse", "glossy", "transmission"):
            row = column.row(heading=component.capitalize(), align=True)
            for part in ("direct", "indirect", "color"):
                cell = row.row(align=True)
                cell.active = Pass[f"{component}_{part}".upper()] not in empty
                cell.prop(layer, f"use_pass_{component}_{part}", text=part.capitalize(), toggle=True)
        for name, source in (("emit", Pass.EMISSION), ("environment", Pass.ENVIRONMENT)):
            _switch(column, layer, name, source not in empty)
        _switch(column, layer, "ambient_occlusion", Pass.AMBIENT_OCCLUSION not in empty)
        if hasattr(layer, "cycles"):
            column.prop(layer.cycles, "denoising_store_passes", text="Denoising Data")
        column.prop(context.scene.lancer, "use_pass_error")
        column.prop(context.scene.lancer, "use_pass_albedo")
        column.prop(layer, "pass_alpha_threshold")


def _switch(column, layer, name, active):
    row = column.row()
    row.active = active
    row.prop(layer, "use_pass_" + name)


class LANCER_VIEWLAYER_PT_filter(LancerPanel, bpy.types.Panel):
    bl_label = "Filter"
    bl_context = "view_layer"

    def draw(self, context):
        column = self._column()
        column.prop(context.view_layer, "use_sky", text="Environment")
        column.prop(context.view_layer, "use_solid", text="Surfaces")
        if hasattr(context.view_layer, "cycles"):
            row = column.row()
            row.active = context.scene.lancer.use_denoising
            row.prop(context.view_layer.cycles, "use_denoising", text="Denoising")


CLASSES = (
    LANCER_RENDER_PT_sampling,
    LANCER_RENDER_PT_denoising,
    LANCER_RENDER_PT_light_paths,
    LANCER_RENDER_PT_film,
    LANCER_RENDER_PT_performance,
    LANCER_RENDER_PT_messages,
    LANCER_VIEWLAYER_PT_passes,
    LANCER_VIEWLAYER_PT_filter,
)
