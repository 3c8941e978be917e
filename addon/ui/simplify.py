"""Simplify and Subdivision in the Render tab: Blender's and Cycles' limits of detail."""

import bpy
from bl_ui.properties_grease_pencil_common import GreasePencilSimplifyPanel

from .panel import LancerRenderPanel, setting


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


CLASSES = (
    LANCER_RENDER_PT_simplify,
    LANCER_RENDER_PT_simplify_viewport,
    LANCER_RENDER_PT_simplify_render,
    LANCER_RENDER_PT_simplify_culling,
    LANCER_RENDER_PT_simplify_strokes,
    LANCER_RENDER_PT_subdivision,
)
