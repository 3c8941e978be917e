"""The Render tab: settings in the order of Cycles."""

import bpy
from bl_ui.properties_grease_pencil_common import GreasePencilSimplifyPanel

from ..denoise import view_layer as denoise
from ..engine import last_statistics
from ..export.settings import glass_owner
from ..measure.render_report import NOTHING, REMOVED, percent
from ..operators import measure_quality, measuring, take_over_cycles
from ..settings import presets
from . import motion
from .panel import LancerPanel, setting, uses_classic
from .sentences import sentence

_MEASURE = "lancer.measure_quality"

# A note for users of Cycles.
_REPLACED = (
    "These settings replace Cycles' bounces, Clamp Indirect and Filter Glossy, and leave no light out by default. Messages "
    "report differences by them, and how much light each limit removes."
)

_FAST = "Bounced light is replaced by a guess, or the guess is added to it. How far the picture is off is not measured."

_DENOISING = (
    "Open Image Denoise is a guess and can remove details. Its own error is reported beside that of the picture before "
    "denoising, the pass Noisy Image."
)


_MACHINES = (
    "Workers get the exported scene and send back sums of samples; the picture has the same bits as here. Views and previews "
    "stay on this machine."
)


class LancerRenderPanel(LancerPanel):
    """Panels appear in the order of registration, followed by Blender's Grease Pencil and Color Management."""

    bl_context = "render"


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


def draw_biases(column, context, *names):
    """Draw the share of light that limits have removed from the last render, by names in its statistics, where there is any."""
    numbers = last_statistics.get(context.scene.name, {})
    for name in names:
        if numbers.get(name, 0.0) > NOTHING:
            told = f"{REMOVED[name]} {percent(numbers[name])} of the light of the last render"
            sentence(column, context, told[0].upper() + told[1:])


def draw_measuring(column, scene, operator, doing="Measuring"):
    """Draw the progress of a running operator instead of its button; return False if it does not run."""
    what, fraction, text = measuring.running.get(scene.name, ("", 0.0, ""))
    if what != operator:
        return False
    column.label(text=f"{doing}, {fraction * 100:.0f} % (Esc stops)", icon="TIME")
    column.label(text=text)
    return True


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


class LANCER_RENDER_PT_classic(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Classic"
    bl_parent_id = "LANCER_RENDER_PT_light_paths"

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.active = uses_classic(context.scene)
        column.prop(settings, "contribution_threshold", text="Threshold")
        column.prop(settings, "environment_reflections", text="Reflect Sky Only")


class LANCER_RENDER_PT_simplify(LancerRenderPanel, bpy.types.Panel):
    """Replaces Blender's own panel, which would appear before all others."""

    bl_label = "Simplify"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_simplify", text="")

    def draw(self, context):
        pass


class LANCER_RENDER_PT_simplify_viewport(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "LANCER_RENDER_PT_simplify"

    def draw(self, context):
        render = context.scene.render
        column = self._column()
        column.active = render.use_simplify
        column.prop(render, "simplify_subdivision", text="Max Subdivision")
        column.prop(render, "simplify_child_particles", text="Child Particles")
        for name in ("texture_limit", "texture_resolution"):
            setting(column, name, getattr(context.scene, "cycles", None))
        setting(column, "use_simplify_normals", render, text="Normals")


class LANCER_RENDER_PT_simplify_render(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Render"
    bl_parent_id = "LANCER_RENDER_PT_simplify"

    def draw(self, context):
        render = context.scene.render
        column = self._column()
        column.active = render.use_simplify
        column.prop(render, "simplify_subdivision_render", text="Max Subdivision")
        column.prop(render, "simplify_child_particles_render", text="Child Particles")
        for name in ("texture_limit_render", "texture_resolution_render"):
            setting(column, name, getattr(context.scene, "cycles", None))


class LANCER_RENDER_PT_simplify_culling(LancerRenderPanel, bpy.types.Panel):
    """Settings of Cycles, which Lancer follows."""

    bl_label = "Culling"
    bl_parent_id = "LANCER_RENDER_PT_simplify"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and hasattr(context.scene, "cycles")

    def draw(self, context):
        cycles = context.scene.cycles
        column = self._column()
        column.active = context.scene.render.use_simplify
        for kind in ("camera", "distance"):
            column.prop(cycles, f"use_{kind}_cull")
            row = column.row()
            row.active = getattr(cycles, f"use_{kind}_cull")
            row.prop(cycles, f"{kind}_cull_margin", text="Margin" if kind == "camera" else "Distance")


class LANCER_RENDER_PT_simplify_strokes(LancerRenderPanel, GreasePencilSimplifyPanel, bpy.types.Panel):
    bl_label = "Grease Pencil"
    bl_parent_id = "LANCER_RENDER_PT_simplify"
    bl_options = {"DEFAULT_CLOSED"}


class LANCER_RENDER_PT_subdivision(LancerRenderPanel, bpy.types.Panel):
    """Settings of Cycles, which Lancer follows."""

    bl_label = "Subdivision"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and hasattr(context.scene, "cycles")

    def draw(self, context):
        cycles = context.scene.cycles
        column = self._column()
        if bpy.app.version < (5, 0):
            column.prop(cycles, "feature_set")
        column.prop(cycles, "dicing_rate", text="Dicing Rate Render")
        column.prop(cycles, "preview_dicing_rate", text="Viewport")
        column.prop(cycles, "offscreen_dicing_scale", text="Offscreen Scale")
        column.prop(cycles, "max_subdivisions")
        column.prop(cycles, "dicing_camera")


class LANCER_RENDER_PT_film(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        setting(self._column(), "film_exposure", getattr(context.scene, "cycles", None), text="Exposure")


class LANCER_RENDER_PT_pixel_filter(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Pixel Filter"
    bl_parent_id = "LANCER_RENDER_PT_film"

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(settings, "pixel_filter", text="Type")
        if settings.pixel_filter == "BLACKMAN_HARRIS":
            column.prop(settings, "filter_width", text="Width")


class LANCER_RENDER_PT_transparent(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Transparent"
    bl_parent_id = "LANCER_RENDER_PT_film"

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "film_transparent", text="")

    def draw(self, context):
        owner = glass_owner(context.scene)
        column = self._column()
        column.active = context.scene.render.film_transparent
        column.prop(owner, "film_transparent_glass")
        row = column.row()
        row.active = owner.film_transparent_glass
        row.prop(owner, "film_transparent_roughness", text="Max Roughness")


class LANCER_RENDER_PT_performance(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        pass


class LANCER_RENDER_PT_threads(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Threads"
    bl_parent_id = "LANCER_RENDER_PT_performance"

    def draw(self, context):
        render = context.scene.render
        column = self._column()
        column.prop(render, "threads_mode")
        row = column.row()
        row.enabled = render.threads_mode == "FIXED"
        row.prop(render, "threads")


class LANCER_RENDER_PT_texture_cache(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Texture Cache"
    bl_parent_id = "LANCER_RENDER_PT_performance"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and hasattr(context.scene.render, "use_texture_cache")

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_texture_cache", text="")

    def draw(self, context):
        column = self._column()
        column.active = context.scene.render.use_texture_cache
        column.prop(context.scene.render, "use_auto_generate_texture_cache", text="Auto Generate")


class LANCER_RENDER_PT_acceleration(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Acceleration Structure"
    bl_parent_id = "LANCER_RENDER_PT_performance"

    def draw(self, context):
        column = self._column()
        column.prop(context.scene.lancer, "accelerator")
        column.prop(context.scene.lancer, "features")


class LANCER_RENDER_PT_performance_viewport(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "LANCER_RENDER_PT_performance"

    def draw(self, context):
        column = self._column()
        column.prop(context.scene.render, "preview_pixel_size", text="Pixel Size")
        column.prop(context.scene.lancer, "preview_start_resolution", text="Start Pixels")


class LANCER_RENDER_PT_final_render(LancerRenderPanel, bpy.types.Panel):
    bl_label = "Final Render"
    bl_parent_id = "LANCER_RENDER_PT_performance"

    def draw(self, context):
        self._column().prop(context.scene.render, "use_persistent_data")


CLASSES = (
    LANCER_RENDER_PT_sampling,
    LANCER_RENDER_PT_sampling_viewport,
    LANCER_RENDER_PT_denoising,
    LANCER_RENDER_PT_sampling_advanced,
    LANCER_RENDER_PT_many_machines,
    LANCER_RENDER_PT_light_paths,
    LANCER_RENDER_PT_max_bounces,
    LANCER_RENDER_PT_clamping,
    LANCER_RENDER_PT_caustics,
    LANCER_RENDER_PT_fast_gi,
    LANCER_RENDER_PT_classic,
    LANCER_RENDER_PT_simplify,
    LANCER_RENDER_PT_simplify_viewport,
    LANCER_RENDER_PT_simplify_render,
    LANCER_RENDER_PT_simplify_culling,
    LANCER_RENDER_PT_simplify_strokes,
    LANCER_RENDER_PT_subdivision,
    *motion.RENDER_CLASSES,
    LANCER_RENDER_PT_film,
    LANCER_RENDER_PT_pixel_filter,
    LANCER_RENDER_PT_transparent,
    LANCER_RENDER_PT_performance,
    LANCER_RENDER_PT_threads,
    LANCER_RENDER_PT_texture_cache,
    LANCER_RENDER_PT_acceleration,
    LANCER_RENDER_PT_performance_viewport,
    LANCER_RENDER_PT_final_render,
)
