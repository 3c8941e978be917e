"""The Material tab."""

import bpy

from .. import engine
from ..measure import node_lines
from ..measure.node_speed import slowness
from .described import described
from .panel import LancerPanel, nodes_of, setting, uses_classic
from .sentences import sentence


class LancerMaterialPanel(LancerPanel):
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        material = context.material
        return super().poll(context) and material is not None and material.grease_pencil is None


def _has_nodes(material):
    """Whether the material is rendered by its nodes."""
    return material.lancer.model == "NODES" and (bpy.app.version >= (5, 0) or material.use_nodes)


class LANCER_MATERIAL_PT_surface(LancerMaterialPanel, bpy.types.Panel):
    bl_label = "Surface"

    def draw(self, context):
        material = context.material
        own = material.lancer
        column = self._column(animated=True)
        column.prop(own, "model")
        if _has_nodes(material):
            nodes_of(column, material.node_tree, "Surface")
        elif own.model == "NODES":
            column.prop(material, "use_nodes", icon="NODETREE")
            column.prop(material, "diffuse_color", text="Color")
        else:
            column.prop(own, "kd")
            column.prop(own, "darkness" if own.model == "MINNAERT" else "ks")
            if own.model == "KD_KS":
                column.prop(own, "roughness")
                column.prop(own, "ior")
            elif own.model != "MINNAERT":
                column.prop(own, "shininess")
        row = column.row()
        row.active = uses_classic(context.scene)
        row.prop(own, "ka")


class LancerNodesPanel(LancerMaterialPanel):
    """Of a material with nodes."""

    bl_parent_id = "LANCER_MATERIAL_PT_surface"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and _has_nodes(context.material)


class LANCER_MATERIAL_PT_rendered(LancerNodesPanel, bpy.types.Panel):
    bl_label = "As Rendered"

    def draw(self, context):
        column = self.layout.column(align=True)
        found = described(context.material, context.scene.frame_current).description
        for line in found.losses:
            sentence(column, context, line, "ERROR")
        for line in found.lobes:
            sentence(column, context, line)


class LANCER_MATERIAL_PT_costs(LancerNodesPanel, bpy.types.Panel):
    bl_label = "What Its Nodes Cost"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        column = self.layout.column(align=True)
        use = described(context.material, context.scene.frame_current).use
        for line in node_lines.lines(use, slowness(), engine.last_statistics.get(context.scene.name)):
            sentence(column, context, line)


class LANCER_MATERIAL_PT_displacement(LancerMaterialPanel, bpy.types.Panel):
    bl_label = "Displacement"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and _has_nodes(context.material)

    def draw(self, context):
        nodes_of(self._column(), context.material.node_tree, "Displacement")


class LANCER_MATERIAL_PT_settings(LancerMaterialPanel, bpy.types.Panel):
    bl_label = "Settings"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        material = context.material
        cycles = getattr(material, "cycles", None)
        column = self._column()
        column.prop(material, "pass_index")
        column.separator()
        setting(column, "displacement_method", material, cycles, text="Displacement")
        # Blender 3.5 replaced the switch by an enum.
        if not setting(column, "emission_sampling", cycles):
            setting(column, "sample_as_light", cycles, text="Multiple Importance")
        setting(column, "use_transparent_shadow", cycles, material)
        setting(column, "use_bump_map_correction", cycles)


CLASSES = (
    LANCER_MATERIAL_PT_surface,
    LANCER_MATERIAL_PT_rendered,
    LANCER_MATERIAL_PT_costs,
    LANCER_MATERIAL_PT_displacement,
    LANCER_MATERIAL_PT_settings,
)
