"""Performance in the Render tab: threads, memory, the acceleration structure."""

import bpy

from .panel import LancerRenderPanel


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
    LANCER_RENDER_PT_performance,
    LANCER_RENDER_PT_threads,
    LANCER_RENDER_PT_texture_cache,
    LANCER_RENDER_PT_acceleration,
    LANCER_RENDER_PT_performance_viewport,
    LANCER_RENDER_PT_final_render,
)
