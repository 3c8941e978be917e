"""Panels: Lancer's own, and Blender's that Lancer takes over while it is registered."""

import bpy

from . import engine
from .export.describe import describe_material
from .export.world import CUBE_SIDES

_ID = engine.LancerRenderEngine.bl_idname

# Blender's panels for things that Lancer shows otherwise or does not have.
_EXCLUDED = {
    "DATA_PT_light",
    "DATA_PT_spot",
    "DATA_PT_EEVEE_light",
    "MATERIAL_PT_custom_props",
    "MATERIAL_PT_preview",
    "NODE_DATA_PT_light",
    "NODE_DATA_PT_spot",
    "RENDER_PT_freestyle",
    "RENDER_PT_gpencil",
    "RENDER_PT_simplify",
    "SCENE_PT_audio",
    "TEXTURE_PT_preview",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
    "WORLD_PT_preview",
}


def _uses_classic(scene):
    return scene.lancer.integrator == "CLASSIC"


class _LancerPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {_ID}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def _column(self):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


class LANCER_RENDER_PT_sampling(_LancerPanel, bpy.types.Panel):
    bl_label = "Sampling"
    bl_context = "render"

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(settings, "integrator")
        column.prop(settings, "quality")
        column.prop(settings, "samples")
        column.prop(settings, "time_limit")
        column.prop(settings, "seed")
        column.prop(settings, "use_animated_seed")


class LANCER_RENDER_PT_light_paths(_LancerPanel, bpy.types.Panel):
    bl_label = "Light Paths"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(settings, "max_bounces")
        column.prop(settings, "transparent_bounces")
        row = column.row()
        row.active = settings.integrator == "PATH"
        row.prop(settings, "clamp_indirect")
        row = column.column()
        row.active = settings.integrator == "CLASSIC"
        row.prop(settings, "contribution_threshold")
        row.prop(settings, "environment_reflections")


class LANCER_RENDER_PT_film(_LancerPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings = context.scene.lancer
        column = self._column()
        column.prop(context.scene.render, "film_transparent", text="Transparent")
        glass = column.column()
        glass.active = context.scene.render.film_transparent
        glass.prop(settings, "film_transparent_glass")
        row = glass.row()
        row.active = settings.film_transparent_glass
        row.prop(settings, "film_transparent_roughness")
        column.prop(settings, "pixel_filter")
        row = column.row()
        row.active = settings.pixel_filter == "BLACKMAN_HARRIS"
        row.prop(settings, "filter_width")


class LANCER_RENDER_PT_performance(_LancerPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        render = context.scene.render
        column = self._column()
        column.prop(render, "threads_mode")
        row = column.row()
        row.enabled = render.threads_mode == "FIXED"
        row.prop(render, "threads")
        column.prop(context.scene.lancer, "accelerator")
        column.prop(context.scene.lancer, "features")


class LANCER_RENDER_PT_messages(_LancerPanel, bpy.types.Panel):
    bl_label = "Messages of the Last Render"
    bl_context = "render"

    def draw(self, context):
        lines = engine.last_messages.get(context.scene.name)
        column = self.layout.column(align=True)
        statistics = engine.last_statistics.get(context.scene.name)
        if statistics is not None:
            column.label(text=f"{statistics['samples']} samples, {statistics['seconds']:.1f} s")
            column.label(text=f"{statistics['rays_per_second'] / 1e6:.2f} M rays/s, {statistics['instruction_set']}")
            column.label(text=f"Uses: {statistics['features']}")
        if lines is None:
            column.label(text="Nothing rendered yet")
        elif not lines:
            column.label(text="All of the scene was rendered as it is", icon="CHECKMARK")
        for line in lines or ():
            column.label(text=line, icon="ERROR")


class LANCER_VIEWLAYER_PT_passes(_LancerPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        layer = context.view_layer
        column = self._column()
        for name in ("z", "mist", "position", "normal", "uv", "object_index", "material_index"):
            column.prop(layer, "use_pass_" + name)
        light = self._column()
        light.active = context.scene.lancer.integrator == "PATH"
        for component in ("diffuse", "glossy", "transmission"):
            row = light.row(heading=component.capitalize(), align=True)
            for part in ("direct", "indirect", "color"):
                row.prop(layer, f"use_pass_{component}_{part}", text=part.capitalize(), toggle=True)
        for name in ("emit", "environment", "ambient_occlusion"):
            light.prop(layer, "use_pass_" + name)
        column = self._column()
        if hasattr(layer, "cycles"):
            column.prop(layer.cycles, "denoising_store_passes", text="Denoising Data")
        column.prop(context.scene.lancer, "use_pass_albedo")
        column.prop(layer, "pass_alpha_threshold")


class LANCER_OBJECT_PT_surface(_LancerPanel, bpy.types.Panel):
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


class LANCER_MATERIAL_PT_surface(_LancerPanel, bpy.types.Panel):
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
            self._draw_nodes(column, material)
        else:
            column.prop(own, "kd")
            column.prop(own, "ks")
            if own.model == "KD_KS":
                column.prop(own, "roughness")
                column.prop(own, "ior")
            else:
                column.prop(own, "shininess")
        row = column.row()
        row.active = _uses_classic(context.scene)
        row.prop(own, "ka")

    @staticmethod
    def _draw_nodes(column, material):
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
            column.label(text=line)


class LANCER_DATA_PT_light(_LancerPanel, bpy.types.Panel):
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


class LANCER_DATA_PT_classic_light(_LancerPanel, bpy.types.Panel):
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
        column.prop(own, "use_separate_colors")
        if own.use_separate_colors:
            column.prop(own, "ambient_color")
            column.prop(own, "diffuse_color")
            column.prop(own, "specular_color")


class LANCER_WORLD_PT_surface(_LancerPanel, bpy.types.Panel):
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


_LIGHT_SIZES = {
    "POINT": ("shadow_soft_size", "use_soft_falloff"),
    "SPOT": ("shadow_soft_size", "use_soft_falloff", "spot_size", "spot_blend", "show_cone"),
    "SUN": ("angle",),
    "AREA": ("shape", "size", "size_y", "spread"),
}

_CLASSES = (
    LANCER_RENDER_PT_sampling,
    LANCER_RENDER_PT_light_paths,
    LANCER_RENDER_PT_film,
    LANCER_RENDER_PT_performance,
    LANCER_RENDER_PT_messages,
    LANCER_VIEWLAYER_PT_passes,
    LANCER_OBJECT_PT_surface,
    LANCER_MATERIAL_PT_surface,
    LANCER_DATA_PT_light,
    LANCER_DATA_PT_classic_light,
    LANCER_WORLD_PT_surface,
)


def _compatible_panels():
    """Blender's panels that any engine may show."""
    for panel in bpy.types.Panel.__subclasses__():
        if "BLENDER_RENDER" in getattr(panel, "COMPAT_ENGINES", ()) and panel.__name__ not in _EXCLUDED:
            yield panel


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    for panel in _compatible_panels():
        panel.COMPAT_ENGINES.add(_ID)


def unregister():
    for panel in bpy.types.Panel.__subclasses__():
        if panel not in _CLASSES and _ID in getattr(panel, "COMPAT_ENGINES", ()):
            panel.COMPAT_ENGINES.discard(_ID)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
