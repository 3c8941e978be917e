"""Blender's own panels that Lancer shows: those for all engines except panels without effect, and some of EEVEE's.

Panels of the Cycles add-on are not adopted, since they exist only while it is enabled.
"""

import bpy

from .panel import ID, LancerPanel

# Panels of EEVEE that apply to Lancer unchanged.
_OF_EEVEE = {
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "EEVEE_MATERIAL_PT_context_material",
    "MATERIAL_PT_preview",
}
# Panels that Lancer replaces by its own.
_REPLACED = {
    "DATA_PT_area",
    "DATA_PT_light",
    "DATA_PT_spot",
    "NODE_DATA_PT_light",
    "NODE_DATA_PT_spot",
    "OBJECT_PT_light_linking",
    "OBJECT_PT_shading",
    "OBJECT_PT_shadow_linking",
    "RENDER_PT_simplify",
    "RENDER_PT_simplify_greasepencil",
    "RENDER_PT_simplify_render",
    "RENDER_PT_simplify_viewport",
}
# Panels without effect: Freestyle, volumes and hair.
_WITHOUT_EFFECT = {
    "DATA_PT_volume_render",
    "MATERIAL_PT_freestyle_line",
    "PARTICLE_PT_hair_shape",
    "PARTICLE_PT_render_path",
    "PARTICLE_PT_render_path_timing",
    "RENDER_PT_freestyle",
}


def _adopts(panel):
    name = panel.__name__
    if name in _OF_EEVEE:
        return True
    if name in _REPLACED or name in _WITHOUT_EFFECT or name.startswith("VIEWLAYER_PT_freestyle"):
        return False
    return "BLENDER_RENDER" in getattr(panel, "COMPAT_ENGINES", ())


def adopt():
    for panel in bpy.types.Panel.__subclasses__():
        if _adopts(panel):
            panel.COMPAT_ENGINES.add(ID)


def release():
    """Release all adopted panels. Lancer's own share their engines, also those that the running Blender does not show."""
    for panel in bpy.types.Panel.__subclasses__():
        if not issubclass(panel, LancerPanel) and ID in getattr(panel, "COMPAT_ENGINES", ()):
            panel.COMPAT_ENGINES.discard(ID)
