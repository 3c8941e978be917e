"""Film in the Render tab: exposure, pixel filter, transparency."""

import bpy

from ..export.settings import glass_owner
from .panel import LancerRenderPanel, setting


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


CLASSES = (
    LANCER_RENDER_PT_film,
    LANCER_RENDER_PT_pixel_filter,
    LANCER_RENDER_PT_transparent,
)
