"""The Data tab of a lamp."""

import bpy

from .panel import LancerPanel, nodes_of, setting, uses_classic


class LancerLightPanel(LancerPanel):
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.light is not None


def _is_portal(light):
    return light.type == "AREA" and getattr(getattr(light, "cycles", None), "is_portal", False)


class LANCER_DATA_PT_light(LancerLightPanel, bpy.types.Panel):
    bl_label = "Light"

    def draw(self, context):
        light = context.light
        self.layout.row().prop(light, "type", expand=True)
        column = self._column(animated=True)
        if hasattr(light, "use_temperature"):
            column.prop(light, "use_temperature", text="Temperature")
            row = column.row()
            row.active = light.use_temperature
            row.prop(light, "temperature", text="Kelvin")
        column.prop(light, "color", text="Tint" if getattr(light, "use_temperature", False) else "Color")
        column.prop(light, "energy", text="Strength" if light.type == "SUN" else "Power")
        for name in ("exposure", "normalize"):
            setting(column, name, light)
        column.separator()
        if light.type in ("POINT", "SPOT"):
            column.prop(light, "shadow_soft_size", text="Radius")
            setting(column, "use_soft_falloff", light)
        elif light.type == "SUN":
            column.prop(light, "angle")
        else:
            column.prop(light, "shape")
            sides = column.column(align=True)
            if light.shape in ("RECTANGLE", "ELLIPSE"):
                sides.prop(light, "size", text="Size X")
                sides.prop(light, "size_y", text="Y")
            else:
                sides.prop(light, "size")


class LANCER_DATA_PT_beam_shape(LancerLightPanel, bpy.types.Panel):
    bl_label = "Beam Shape"
    bl_parent_id = "LANCER_DATA_PT_light"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.light.type in ("SPOT", "AREA")

    def draw(self, context):
        light = context.light
        column = self._column(animated=True)
        if light.type == "SPOT":
            column.prop(light, "spot_size", text="Angle")
            column.prop(light, "spot_blend", text="Blend", slider=True)
            column.prop(light, "show_cone")
        else:
            column.prop(light, "spread")


class LANCER_DATA_PT_light_settings(LancerLightPanel, bpy.types.Panel):
    bl_label = "Settings"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        light = context.light
        cycles = getattr(light, "cycles", None)
        column = self._column()
        row = column.row()
        row.active = not _is_portal(light)
        # Prefer Cycles' own switch in the versions that have it, in which use_shadow is EEVEE's.
        if not setting(row, "cast_shadow", cycles):
            row.prop(light, "use_shadow", text="Cast Shadow")
        setting(column, "max_bounces", cycles)
        if light.type == "AREA":
            setting(column, "is_portal", cycles, text="Portal")


class LANCER_DATA_PT_light_nodes(LancerLightPanel, bpy.types.Panel):
    bl_label = "Nodes"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and not _is_portal(context.light)

    def draw(self, context):
        light = context.light
        column = self._column()
        if bpy.app.version < (5, 2) and not light.use_nodes:
            column.prop(light, "use_nodes", icon="NODETREE")
        else:
            nodes_of(column, light.node_tree, "Surface")


class LANCER_DATA_PT_classic_light(LancerLightPanel, bpy.types.Panel):
    bl_label = "Classic"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        own = context.light.lancer
        column = self._column(animated=True)
        column.active = uses_classic(context.scene)
        column.prop(own, "falloff")
        row = column.row()
        row.enabled = own.falloff not in ("PHYSICAL", "CONSTANT")
        row.prop(own, "radius")
        column.prop(own, "use_ambient")
        column.prop(own, "use_separate_colors")
        if own.use_separate_colors:
            column.prop(own, "ambient_color")
            column.prop(own, "diffuse_color")
            column.prop(own, "specular_color")


CLASSES = (
    LANCER_DATA_PT_light,
    LANCER_DATA_PT_beam_shape,
    LANCER_DATA_PT_light_settings,
    LANCER_DATA_PT_light_nodes,
    LANCER_DATA_PT_classic_light,
)
