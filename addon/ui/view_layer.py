"""The View Layer tab: passes, filters and overrides."""

import bpy

from ..bindings.enums import Pass
from ..export.unsupported import EMPTY_PASSES
from .panel import LancerPanel, setting

_DATA = ("z", "mist", "position", "normal", "uv")
_INDEXES = ("object_index", "material_index")
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
            column.prop(layer, "use_pass_" + name)
        setting(column, "denoising_store_passes", getattr(layer, "cycles", None), text="Denoising Data")
        column.prop(own, "use_pass_albedo")
        column = whole.column(heading="Accuracy", align=True)
        column.prop(own, "use_pass_error")
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
    LANCER_VIEWLAYER_PT_filter,
    LANCER_VIEWLAYER_PT_override,
)
