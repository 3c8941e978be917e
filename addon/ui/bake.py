"""Object > Bake: Blender's own settings of a bake in the Render tab; the type is that of Cycles."""

import bpy

from ..bake.wanted import TYPES
from .panel import LancerPanel, setting

_LIGHT = {"DIFFUSE", "GLOSSY", "TRANSMISSION"}


def _type_of(scene):
    return getattr(getattr(scene, "cycles", None), "bake_type", "COMBINED")


class LANCER_RENDER_PT_bake(LancerPanel, bpy.types.Panel):
    bl_label = "Bake"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        scene = context.scene
        own, kind = scene.render.bake, _type_of(scene)
        row = self.layout.row()
        # Where a bake fails, Blender leaves the image black.
        row.enabled = kind in TYPES
        row.operator("object.bake", icon="RENDER_STILL").type = kind
        column = self._column()
        if kind not in TYPES:
            column.label(text=f"Lancer does not bake {kind.title()}", icon="ERROR")
        setting(column, "bake_type", getattr(scene, "cycles", None))
        setting(column, "view_from", own)
        if kind == "NORMAL":
            column.prop(own, "normal_space", text="Space")
            for axis in "rgb":
                column.prop(own, f"normal_{axis}", text=f"Swizzle {axis.upper()}")
        elif kind == "COMBINED" or kind in _LIGHT:
            row = column.row(heading="Lighting", align=True)
            row.prop(own, "use_pass_direct", toggle=True)
            row.prop(own, "use_pass_indirect", toggle=True)
            if kind in _LIGHT:
                row.prop(own, "use_pass_color", toggle=True)
            else:
                lobes = column.column(heading="Contributions")
                for name in ("diffuse", "glossy", "transmission", "emit"):
                    lobes.prop(own, f"use_pass_{name}")


class LANCER_RENDER_PT_bake_selected(LancerPanel, bpy.types.Panel):
    bl_label = "Selected to Active"
    bl_context = "render"
    bl_parent_id = "LANCER_RENDER_PT_bake"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render.bake, "use_selected_to_active", text="")

    def draw(self, context):
        own = context.scene.render.bake
        column = self._column()
        column.active = own.use_selected_to_active
        column.prop(own, "use_cage")
        if own.use_cage:
            column.prop(own, "cage_object")
        column.prop(own, "cage_extrusion")
        setting(column, "max_ray_distance", own)


class LANCER_RENDER_PT_bake_output(LancerPanel, bpy.types.Panel):
    bl_label = "Output"
    bl_context = "render"
    bl_parent_id = "LANCER_RENDER_PT_bake"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        own = context.scene.render.bake
        column = self._column()
        column.prop(own, "target")
        if own.target == "IMAGE_TEXTURES":
            column.prop(own, "use_clear")
            setting(column, "margin_type", own, text="Margin Type")
            column.prop(own, "margin")


CLASSES = (LANCER_RENDER_PT_bake, LANCER_RENDER_PT_bake_selected, LANCER_RENDER_PT_bake_output)
