"""The World tab."""

import bpy

from ..export.world import CUBE_SIDES
from .panel import LancerPanel, light_group, nodes_of, setting, uses_classic


class LancerWorldPanel(LancerPanel):
    bl_context = "world"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.world is not None


class LANCER_WORLD_PT_preview(LancerWorldPanel, bpy.types.Panel):
    """The preview of the world, which Blender shows only for Cycles."""

    bl_label = "Preview"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.template_preview(context.world)


class LANCER_WORLD_PT_surface(LancerWorldPanel, bpy.types.Panel):
    bl_label = "Surface"

    def draw(self, context):
        world = context.world
        column = self._column(animated=True)
        column.prop(world.lancer, "use_cube")
        if world.lancer.use_cube:
            column.prop(world.lancer, "cube_strength")
            for side in CUBE_SIDES:
                column.template_ID(world.lancer, side, open="image.open", text=world.lancer.bl_rna.properties[side].name)
        elif bpy.app.version < (5, 0) and not world.use_nodes:
            column.prop(world, "use_nodes", icon="NODETREE")
            column.prop(world, "color")
        else:
            nodes_of(column, world.node_tree, "Surface")


class LANCER_WORLD_PT_mist(LancerWorldPanel, bpy.types.Panel):
    """Replaces EEVEE's panel, which would appear before the surface."""

    bl_label = "Mist Pass"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        mist = context.world.mist_settings
        column = self._column(animated=True)
        for name in ("start", "depth", "falloff"):
            column.prop(mist, name)


class LANCER_WORLD_PT_ambient_occlusion(LancerWorldPanel, bpy.types.Panel):
    bl_label = "Ambient Occlusion"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self._column(animated=True).prop(context.world.light_settings, "distance")


class LANCER_WORLD_PT_ray_visibility(LancerWorldPanel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and hasattr(context.world, "cycles_visibility")

    def draw(self, context):
        column = self._column()
        for name in ("camera", "diffuse", "glossy", "transmission"):
            column.prop(context.world.cycles_visibility, name)


class LANCER_WORLD_PT_settings(LancerWorldPanel, bpy.types.Panel):
    bl_label = "Settings"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        column = self._column()
        light_group(column, context.world, context.view_layer)
        # The switches belong to Cycles, an add-on that may be disabled.
        cycles = getattr(context.world, "cycles", None)
        if cycles is None:
            return
        setting(column, "sampling_method", cycles, text="Sampling")
        row = column.row()
        row.active = cycles.sampling_method == "MANUAL"
        setting(row, "sample_map_resolution", cycles)
        setting(column, "max_bounces", cycles)


class LANCER_WORLD_PT_classic(LancerWorldPanel, bpy.types.Panel):
    bl_label = "Classic"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        own = context.world.lancer
        column = self._column(animated=True)
        column.active = uses_classic(context.scene)
        column.prop(own, "use_ambient_color")
        if own.use_ambient_color:
            column.prop(own, "ambient_color", text="Color")


CLASSES = (
    LANCER_WORLD_PT_preview,
    LANCER_WORLD_PT_surface,
    LANCER_WORLD_PT_mist,
    LANCER_WORLD_PT_ambient_occlusion,
    LANCER_WORLD_PT_ray_visibility,
    LANCER_WORLD_PT_settings,
    LANCER_WORLD_PT_classic,
)
