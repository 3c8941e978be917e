"""The Object tab: exact shape, shading, light linking and ray visibility."""

import bpy

from .panel import LancerPanel, light_group, setting

_SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
_RAYS = ("camera", "diffuse", "glossy", "transmission", "shadow")


class LancerObjectPanel(LancerPanel):
    """A panel of objects with a surface."""

    bl_context = "object"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object is not None and context.object.type in _SURFACES


class LANCER_OBJECT_PT_shading(LancerObjectPanel, bpy.types.Panel):
    bl_label = "Shading"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        own = context.object.lancer
        column = self._column()
        column.prop(own, "shape")
        row = column.row()
        row.active = own.shape == "MESH"
        row.prop(own, "shading")


class LANCER_OBJECT_PT_shadow_terminator(LancerObjectPanel, bpy.types.Panel):
    bl_label = "Shadow Terminator"
    bl_parent_id = "LANCER_OBJECT_PT_shading"

    def draw(self, context):
        thing = context.object
        column = self._column()
        setting(column, "shadow_terminator_geometry_offset", thing, getattr(thing, "cycles", None), text="Geometry Offset")


class LANCER_OBJECT_PT_subdivision(LancerObjectPanel, bpy.types.Panel):
    """Settings that Blender's own panel of the modifier shows for Cycles alone."""

    bl_label = "Adaptive Subdivision"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and cls._owner(context.object) is not None

    @staticmethod
    def _owner(thing):
        """Return what has the settings, the last modifier, or before 5.0 Cycles' settings of the object; else None."""
        last = thing.modifiers[-1] if thing.modifiers else None
        if last is None or last.type != "SUBSURF":
            return None
        return last if hasattr(last, "use_adaptive_subdivision") else getattr(thing, "cycles", None)

    def draw_header(self, context):
        self.layout.prop(self._owner(context.object), "use_adaptive_subdivision", text="")

    def draw(self, context):
        owner = self._owner(context.object)
        column = self._column()
        if hasattr(owner, "adaptive_space"):
            column.prop(owner, "adaptive_space")
            in_pixels = owner.adaptive_space == "PIXEL"
            column.prop(owner, "adaptive_pixel_size" if in_pixels else "adaptive_object_edge_length")
        else:
            column.prop(owner, "dicing_rate")


class LANCER_OBJECT_PT_light_group(LancerPanel, bpy.types.Panel):
    bl_label = "Light Group"
    bl_context = "object"
    bl_parent_id = "OBJECT_PT_visibility"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object is not None and context.object.type in {*_SURFACES, "LIGHT"}

    def draw(self, context):
        light_group(self._column(), context.object, context.view_layer)


class LANCER_OBJECT_PT_simplify(LancerObjectPanel, bpy.types.Panel):
    """Settings of Cycles, which Lancer follows."""

    bl_label = "Culling and Fast GI"
    bl_parent_id = "OBJECT_PT_visibility"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and hasattr(context.object, "cycles")

    def draw(self, context):
        scene, own = context.scene, context.object.cycles
        for kind in ("camera", "distance"):
            column = self._column()
            column.active = scene.render.use_simplify and getattr(scene.cycles, f"use_{kind}_cull")
            column.prop(own, f"use_{kind}_cull")
        column = self._column()
        column.active = scene.cycles.use_fast_gi
        column.prop(own, "ao_distance", text="AO Distance")


class LANCER_OBJECT_PT_ray_visibility(LancerPanel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_context = "object"
    bl_parent_id = "OBJECT_PT_visibility"

    @classmethod
    def poll(cls, context):
        thing = context.object
        if not super().poll(context) or thing is None:
            return False
        # The visibility of an instancer also limits that of its instances.
        return thing.type in {*_SURFACES, "LIGHT"} or thing.is_instancer

    def draw(self, context):
        thing = context.object
        column = self._column()
        for ray in _RAYS:
            # Lamps are no occluders.
            if not (ray == "shadow" and thing.type == "LIGHT"):
                column.prop(thing, f"visible_{ray}", text=ray.capitalize())
        column = self._column().column(heading="Mask")
        column.active = context.scene.lancer.integrator == "PATH"
        setting(column, "is_shadow_catcher", thing)


class LancerLinkingPanel(LancerPanel):
    """A collection of the objects that a lamp or an emitting object lights, or that block its light."""

    bl_context = "object"
    bl_parent_id = "OBJECT_PT_visibility"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        thing = context.object
        return super().poll(context) and thing is not None and thing.type in {*_SURFACES, "LIGHT"}

    def draw(self, context):
        linking = context.object.light_linking
        column = self._column()
        column.template_ID(linking, self.member, new=f"object.light_linking_{self.member}_new")
        if getattr(linking, self.member) is None:
            return
        row = self.layout.row()
        column = row.column()
        column.template_light_linking_collection(row, linking, self.member)
        column = row.column(align=True)
        column.operator(f"object.light_linking_{self.others}_link", icon="ADD", text="").link_state = "INCLUDE"
        column.operator("object.light_linking_unlink_from_collection", icon="REMOVE", text="")
        self.layout.operator(f"object.light_linking_{self.others}_select")


class LANCER_OBJECT_PT_light_linking(LancerLinkingPanel, bpy.types.Panel):
    bl_label = "Light Linking"
    member, others = "receiver_collection", "receivers"


class LANCER_OBJECT_PT_shadow_linking(LancerLinkingPanel, bpy.types.Panel):
    bl_label = "Shadow Linking"
    member, others = "blocker_collection", "blockers"


CLASSES = (
    LANCER_OBJECT_PT_shading,
    LANCER_OBJECT_PT_shadow_terminator,
    LANCER_OBJECT_PT_subdivision,
    LANCER_OBJECT_PT_ray_visibility,
    LANCER_OBJECT_PT_light_group,
    LANCER_OBJECT_PT_simplify,
)
# Blender has light linking since 4.0.
if "light_linking" in bpy.types.Object.bl_rna.properties:
    CLASSES += (LANCER_OBJECT_PT_light_linking, LANCER_OBJECT_PT_shadow_linking)
