"""Panels: Lancer's own, and Blender's that Lancer takes over while it is registered."""

import bpy

from . import engine, ui_check, ui_data, ui_render, ui_uses
from .registering import add_all

_ID = engine.LancerRenderEngine.bl_idname
_CLASSES = (*ui_render.CLASSES, *ui_uses.CLASSES, *ui_check.CLASSES, *ui_data.CLASSES)

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
    "SCENE_PT_audio",
    "TEXTURE_PT_preview",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
    "WORLD_PT_preview",
}


def _compatible_panels():
    """Blender's panels that any engine may show."""
    for panel in bpy.types.Panel.__subclasses__():
        if "BLENDER_RENDER" in getattr(panel, "COMPAT_ENGINES", ()) and panel.__name__ not in _EXCLUDED:
            yield panel


def register():
    add_all(_CLASSES, bpy.utils.register_class, bpy.utils.unregister_class)
    for panel in _compatible_panels():
        panel.COMPAT_ENGINES.add(_ID)


def unregister():
    for panel in bpy.types.Panel.__subclasses__():
        if panel not in _CLASSES and _ID in getattr(panel, "COMPAT_ENGINES", ()):
            panel.COMPAT_ENGINES.discard(_ID)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
