"""The View Layer tab: passes, filters and overrides."""

import bpy

from ..bindings.enums import Pass
from ..export.shutter import blurs_motion
from ..export.unsupported import EMPTY_PASSES
from .panel import LancerPanel, setting

_DATA = ("z", "mist", "position", "normal", "vector", "uv")
_CRYPTOMATTES = ("object", "material", "asset")
_INDEXES = ("object_index", "material_index")
_WORK = (("pass_debug_sample_count", "Sample Count"), ("pass_render_time", "Render Time"))
_COMPONENTS = ("diffuse", "glossy", "transmission")


class LancerViewLayerPanel(LancerPanel):
    bl_context = "view_layer"


class LANCER_VIEWLAYER_PT_passes(LancerViewLayerPanel, bpy.types.Panel):
    bl_label = "Passes"

    def draw(self, context):
        pass


class LANCER_VIEWLAYER_PT_passes_data(LancerViewLayerPanel, bpy.types.Panel):
    bl_label = "Data"
    bl_parent_id = "LANCER_VIEWLAYER_PT_passes"

    def draw(self, context):
        layer, own = context.view_layer, context.scene.lancer
        whole = self._column()
        column = whole.column(heading="Include", align=True)
        for name in _DATA:
            row = column.row()
            row.active = name != "vector" or not blurs_motion(context.scene, layer)
            row.prop(layer, "use_pass_" + name)
        setting(column, "denoising_store_passes", getattr(layer, "cycles", None), text="Denoising Data")
        column.prop(own, "use_pass_albedo")
        column = whole.column(heading="Accuracy", align=True)
        column.prop(own, "use_pass_error")
        for name, text in _WORK:
            setting(column, name, getattr(layer, "cycles", None), text=text)
        column = whole.column(heading="Indexes", align=True)
        for name in _INDEXES:
            column.prop(layer, "use_pass_" + name)
        whole.prop(layer, "pass_alpha_threshold")


class LANCER_VIEWLAYER_PT_passes_light(LancerViewLayerPanel, bpy.types.Panel):
    bl_label = "Light"
    bl_parent_id = "LANCER_VIEWLAYER_PT_passes"

    def draw(self, context):
        layer = context.view_layer
        empty = EMPTY_PASSES[context.scene.lancer.integrator]

        def switch(name, source, text):
            row = column.row()
            row.active = source not in empty
            row.prop(layer, "use_pass_" + name, text=text)

        whole = self._column()
        for component in _COMPONENTS:
            column = whole.column(heading=component.capitalize(), align=True)
            for part in ("direct", "indirect", "color"):
                name = f"{component}_{part}"
                switch(name, Pass[name.upper()], part.capitalize())
        column = whole.column(heading="Other", align=True)
        switch("emit", Pass.EMISSION, "Emission")
        switch("environment", Pass.ENVIRONMENT, "Environment")
        switch("ambient_occlusion", Pass.AMBIENT_OCCLUSION, "Ambient Occlusion")
        setting(column, "use_pass_shadow_catcher", getattr(layer, "cycles", None), text="Shadow Catcher")


class LANCER_VIEWLAYER_PT_passes_cryptomatte(LancerViewLayerPanel, bpy.types.Panel):
    bl_label = "Cryptomatte"
    bl_parent_id = "LANCER_VIEWLAYER_PT_passes"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layer = context.view_layer
        whole = self._column()
        column = whole.column(heading="Include", align=True)
        for name in _CRYPTOMATTES:
            column.prop(layer, "use_pass_cryptomatte_" + name, text=name.capitalize())
        column = whole.column()
        column.active = any(getattr(layer, "use_pass_cryptomatte_" + name) for name in _CRYPTOMATTES)
        column.prop(layer, "pass_cryptomatte_depth", text="Levels")


class LANCER_VIEWLAYER_PT_passes_aov(LancerViewLayerPanel, bpy.types.Panel):
    bl_label = "Shader AOV"
    bl_parent_id = "LANCER_VIEWLAYER_PT_passes"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layer = context.view_layer
        row = self._column().row()
        row.template_list("VIEWLAYER_UL_aov", "aovs", layer, "aovs", layer, "active_aov_index", rows=3)
        buttons = row.column(align=True)
        buttons.operator("scene.view_layer_add_aov", icon="ADD", text="")
        buttons.operator("scene.view_layer_remove_aov", icon="REMOVE", text="")
        if layer.active_aov is not None and not layer.active_aov.is_valid:
            self.layout.label(text="Another pass has this name", icon="ERROR")


class LANCER_VIEWLAYER_PT_passes_lightgroups(LancerViewLayerPanel, bpy.types.Panel):
    bl_label = "Light Groups"
    bl_parent_id = "LANCER_VIEWLAYER_PT_passes"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layer = context.view_layer
        row = self._column().row()
        row.template_list("UI_UL_list", "lightgroups", layer, "lightgroups", layer, "active_lightgroup_index", rows=3)
        column = row.column()
        buttons = column.column(align=True)
        buttons.operator("scene.view_layer_add_lightgroup", icon="ADD", text="")
        buttons.operator("scene.view_layer_remove_lightgroup", icon="REMOVE", text="")
        column.separator()
        column.menu("VIEWLAYER_MT_lightgroup_sync", icon="DOWNARROW_HLT", text="")


class LANCER_VIEWLAYER_PT_filter(LancerViewLayerPanel, bpy.types.Panel):
    bl_label = "Filter"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layer = context.view_layer
        whole = self._column()
        column = whole.column(heading="Include", align=True)
        column.prop(layer, "use_sky", text="Environment")
        column.prop(layer, "use_solid", text="Surfaces")
        column = whole.column(heading="Use", align=True)
        column.active = context.scene.render.use_motion_blur
        column.prop(layer, "use_motion_blur", text="Motion Blur")
        column = whole.column(align=True)
        column.active = context.scene.lancer.use_denoising
        setting(column, "use_denoising", getattr(layer, "cycles", None), text="Denoising")


class LANCER_VIEWLAYER_PT_override(LancerViewLayerPanel, bpy.types.Panel):
    bl_label = "Override"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layer = context.view_layer
        column = self._column()
        column.prop(layer, "material_override", text="Material")
        setting(column, "world_override", layer, text="World")
        column.prop(layer, "samples")


CLASSES = (
    LANCER_VIEWLAYER_PT_passes,
    LANCER_VIEWLAYER_PT_passes_data,
    LANCER_VIEWLAYER_PT_passes_light,
    LANCER_VIEWLAYER_PT_passes_cryptomatte,
    LANCER_VIEWLAYER_PT_passes_aov,
    LANCER_VIEWLAYER_PT_passes_lightgroups,
    LANCER_VIEWLAYER_PT_filter,
    LANCER_VIEWLAYER_PT_override,
)
