"""Motion blur: the shutter in the Render tab, steps of time in the tabs of objects and cameras."""

import bpy

from .panel import LancerPanel, setting


class LANCER_RENDER_PT_motion_blur(LancerPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        scene = context.scene
        render, cycles = scene.render, getattr(scene, "cycles", None)
        column = self._column(animated=True)
        column.active = render.use_motion_blur
        setting(column, "motion_blur_position", render, cycles, text="Position")
        column.prop(render, "motion_blur_shutter")
        if setting(column, "rolling_shutter_type", cycles, text="Rolling Shutter"):
            row = column.row()
            row.active = cycles.rolling_shutter_type != "NONE"
            row.prop(cycles, "rolling_shutter_duration", text="Duration")


class LANCER_RENDER_PT_shutter_curve(LancerPanel, bpy.types.Panel):
    bl_label = "Shutter Curve"
    bl_context = "render"
    bl_parent_id = "LANCER_RENDER_PT_motion_blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        render = context.scene.render
        column = self.layout.column()
        column.active = render.use_motion_blur
        column.template_curve_mapping(render, "motion_blur_shutter_curve")
        row = column.row(align=True)
        for icon, shape in (
            ("SMOOTHCURVE", "SMOOTH"),
            ("SPHERECURVE", "ROUND"),
            ("ROOTCURVE", "ROOT"),
            ("SHARPCURVE", "SHARP"),
            ("LINCURVE", "LINE"),
            ("NOCURVE", "MAX"),
        ):
            row.operator("render.shutter_curve_preset", icon=icon, text="").shape = shape


class LANCER_OBJECT_PT_motion_blur(LancerPanel, bpy.types.Panel):
    """Switches of objects are those of Cycles, an add-on that may be disabled: then all objects are blurred."""

    bl_label = "Motion Blur"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}
    _MOVES = {"MESH", "CURVE", "SURFACE", "FONT", "META", "CAMERA", "EMPTY"}

    @classmethod
    def poll(cls, context):
        thing = context.object
        return super().poll(context) and thing is not None and thing.type in cls._MOVES and hasattr(thing, "cycles")

    def draw_header(self, context):
        self.layout.active = context.scene.render.use_motion_blur
        self.layout.prop(context.object.cycles, "use_motion_blur", text="")

    def draw(self, context):
        thing = context.object
        column = self._column()
        column.active = context.scene.render.use_motion_blur and thing.cycles.use_motion_blur
        column.prop(thing.cycles, "motion_steps", text="Steps")
        if thing.type not in {"CAMERA", "EMPTY"}:
            column.prop(thing.cycles, "use_deform_motion", text="Deformation")


RENDER_CLASSES = (LANCER_RENDER_PT_motion_blur, LANCER_RENDER_PT_shutter_curve)
OBJECT_CLASSES = (LANCER_OBJECT_PT_motion_blur,)
