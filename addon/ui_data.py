"""Panels of objects, materials, lights and the world."""

import bpy

from .export.describe import describe_material
from .export.world import CUBE_SIDES
from .ui_lines import sentence
from .ui_render import LancerPanel

_LIGHT_SIZES = {
    "POINT": ("shadow_soft_size", "use_soft_falloff"),
    "SPOT": ("shadow_soft_size", "use_soft_falloff", "spot_size", "spot_blend", "show_cone"),
    "SUN": ("angle",),
    "AREA": ("shape", "size", "size_y", "spread"),
}


def _uses_classic(scene):
    return scene.lancer.integrator == "CLASSIC"


class LANCER_OBJECT_PT_surface(LancerPanel, bpy.types.Panel):
    bl_label = "Lancer"
    bl_context = "object"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object is not None and context.object.type == "MESH"

    def draw(self, context):
        column = self._column()
        column.prop(context.object.lancer, "shape")
        row = column.row()
        row.active = context.object.lancer.shape == "MESH"
        row.prop(context.object.lancer, "shading")


class LANCER_MATERIAL_PT_surface(LancerPanel, bpy.types.Panel):
    bl_label = "Surface"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.material is not None

    def draw(self, context):
        material = context.material
        own = material.lancer
        column = self._column()
        column.prop(own, "model")
        if own.model == "NODES":
            self._draw_nodes(context, column, material)
        else:
            column.prop(own, "kd")
            column.prop(own, "darkness" if own.model == "MINNAERT" else "ks")
            if own.model == "KD_KS":
                column.prop(own, "roughness")
                column.prop(own, "ior")
            elif own.model != "MINNAERT":
                column.prop(own, "shininess")
        row = column.row()
        row.active = _uses_classic(context.scene)
        row.prop(own, "ka")

    @staticmethod
    def _draw_nodes(context, column, material):
        if bpy.app.version < (5, 0) and not material.use_nodes:
            column.prop(material, "use_nodes", icon="NODETREE")
            column.prop(material, "diffuse_color", text="Color")
            return
        output = material.node_tree.get_output_node("CYCLES")
        if output is None:
            column.label(text="No output node", icon="ERROR")
        else:
            column.template_node_view(material.node_tree, output, output.inputs["Surface"])
        for line in describe_material(material):
            sentence(column, context, line)


class LANCER_DATA_PT_light(LancerPanel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.light is not None

    def draw(self, context):
        light = context.light
        self.layout.row().prop(light, "type", expand=True)
        column = self._column()
        column.prop(light, "color")
        column.prop(light, "energy", text="Strength" if light.type == "SUN" else "Power")
        for name in ("exposure", "normalize"):
            if hasattr(light, name):
                column.prop(light, name)
        if hasattr(light, "use_temperature"):
            column.prop(light, "use_temperature")
            if light.use_temperature:
                column.prop(light, "temperature")
        column.separator()
        for name in _LIGHT_SIZES[light.type]:
            if name == "size_y" and light.shape not in ("RECTANGLE", "ELLIPSE"):
                continue
            if hasattr(light, name):
                column.prop(light, name)
        column.separator()
        # Cycles' own switch in the versions that have it, where use_shadow is EEVEE's.
        cycles = getattr(light, "cycles", None)
        if hasattr(cycles, "cast_shadow"):
            column.prop(cycles, "cast_shadow")
        else:
            column.prop(light, "use_shadow", text="Cast Shadow")


class LANCER_DATA_PT_classic_light(LancerPanel, bpy.types.Panel):
    bl_label = "Classic"
    bl_context = "data"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.light is not None

    def draw(self, context):
        own = context.light.lancer
        column = self._column()
        column.active = _uses_classic(context.scene)
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


class LANCER_WORLD_PT_surface(LancerPanel, bpy.types.Panel):
    bl_label = "Surface"
    bl_context = "world"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.world is not None

    def draw(self, context):
        world = context.world
        column = self._column()
        column.prop(world.lancer, "use_cube")
        if world.lancer.use_cube:
            column.prop(world.lancer, "cube_strength")
            for side in CUBE_SIDES:
                column.template_ID(world.lancer, side, open="image.open", text=world.lancer.bl_rna.properties[side].name)
            return
        output = None
        if world.node_tree is not None and (bpy.app.version >= (5, 0) or world.use_nodes):
            output = world.node_tree.get_output_node("CYCLES")
        if output is not None:
            column.template_node_view(world.node_tree, output, output.inputs["Surface"])
        else:
            column.prop(world, "color")


class LANCER_WORLD_PT_classic(LancerPanel, bpy.types.Panel):
    bl_label = "Classic"
    bl_context = "world"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.world is not None

    def draw(self, context):
        own = context.world.lancer
        column = self._column()
        column.active = _uses_classic(context.scene)
        column.prop(own, "use_ambient_color")
        if own.use_ambient_color:
            column.prop(own, "ambient_color", text="Color")


CLASSES = (
    LANCER_OBJECT_PT_surface,
    LANCER_MATERIAL_PT_surface,
    LANCER_DATA_PT_light,
    LANCER_DATA_PT_classic_light,
    LANCER_WORLD_PT_surface,
    LANCER_WORLD_PT_classic,
)
