"""Sampling in the Render tab: the accuracy of a render, its forecast, denoising, the machines that share it."""

import bpy

from ..denoise import view_layer as denoise
from ..measure.render_report import percent
from ..operators import measure_quality, take_over_cycles
from ..settings import presets
from .panel import LancerRenderPanel, draw_measuring
from .sentences import sentence

_MEASURE = "lancer.measure_quality"

_DENOISING = (
    "Open Image Denoise is a guess and can remove details. Its own error is reported beside that of the picture before "
    "denoising, the pass Noisy Image."
)

_MACHINES = (
    "Workers get the exported scene and send back sums of samples; the picture has the same bits as here. Views and previews "
    "stay on this machine."
)


class LANCER_RENDER_PT_sampling(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Sampling"
    draw_header_preset = presets.draw_sampling

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(settings, "integrator")
        column.prop(settings, "quality")
        column.prop(settings, "target_error")
        column.prop(settings, "samples", text="Samples" if settings.target_error == 0.0 else "Max Samples")
        column.prop(settings, "time_limit")
        _draw_take_over(self.layout.column(align=True), context)
        _draw_forecast(self.layout.column(align=True), context)


def _draw_take_over(column, context):
    """Draw the button that copies Cycles' settings and the names of those that it changes, while any differs."""
    changes = take_over_cycles.differing(context.scene)
    if changes:
        column.operator(take_over_cycles.LANCER_OT_take_over_cycles.bl_idname, icon="IMPORT")
        sentence(column, context, f"Changes {', '.join(take_over_cycles.titles(context.scene, changes))}")


def _draw_forecast(column, context):
    """Draw the measure button and the measured forecast of each quality."""
    scene = context.scene
    if draw_measuring(column, scene, _MEASURE):
        return
    column.operator(_MEASURE, icon="TIME")
    if scene.name not in measure_quality.measured:
        return
    if measure_quality.is_old(scene):
        sentence(column, context, "Measured before the last changes", "ERROR")
    for line in measure_quality.lines(scene):
        # Panels are narrow.
        for part in line.split("; "):
            sentence(column, context, part)


class LANCER_RENDER_PT_sampling_viewport(LancerRenderPanel, bpy.types.Panel):
    """Settings of 3D views in Rendered shading."""

    bl_label = "Viewport"
    bl_parent_id = "LANCER_RENDER_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(settings, "preview_samples", text="Samples")
        row = column.row()
        row.active = settings.integrator != "NORMALS" and not denoise.missing()
        row.prop(settings, "use_preview_denoising", text="Denoise")


class LANCER_RENDER_PT_denoising(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Denoise"
    bl_parent_id = "LANCER_RENDER_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.active = context.scene.lancer.integrator != "NORMALS"
        self.layout.prop(context.scene.lancer, "use_denoising", text="")

    def draw(self, context):
        column = self.layout.column(align=True)
        missing = denoise.missing()
        if missing:
            sentence(column, context, missing, "ERROR")
        sentence(column, context, _DENOISING)
        settings = context.scene.lancer
        column = self._column()
        column.active = settings.use_denoising and settings.integrator != "NORMALS" and not missing
        column.prop(settings, "use_denoising_samples")
        row = column.row()
        row.active = settings.target_error > 0.0
        row.prop(settings, "use_denoised_target")


class LANCER_RENDER_PT_sampling_advanced(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Advanced"
    bl_parent_id = "LANCER_RENDER_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings = context.scene.lancer
        row = self._column().row(align=True)
        row.prop(settings, "seed")
        row.prop(settings, "use_animated_seed", text="", icon="TIME")


class LANCER_RENDER_PT_many_machines(LancerRenderPanel, bpy.types.Panel):
    """The scheduler whose workers render F12, with what ends the picture there, too."""

    bl_label = "Many Machines"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.lancer, "use_many_machines", text="")

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.active = settings.use_many_machines
        column.prop(settings, "scheduler")
        ends = [f"{settings.samples} samples"]
        if settings.target_error > 0.0:
            ends.insert(0, f"an error of {percent(settings.target_error)}")
        sentence(column, context, f"Ends as here: at {' or '.join(ends)}, see Sampling")
        sentence(column, context, _MACHINES)


CLASSES = (
    LANCER_RENDER_PT_sampling,
    LANCER_RENDER_PT_sampling_viewport,
    LANCER_RENDER_PT_denoising,
    LANCER_RENDER_PT_sampling_advanced,
    LANCER_RENDER_PT_many_machines,
)
