"""Panels: Lancer's own, one file for each tab of the Properties editor, and Blender's panels that Lancer adopts."""

import bpy

from ..host.registering import add_all
from . import (
    adopted,
    bake,
    camera,
    check,
    described,
    film,
    light,
    light_paths,
    material,
    messages,
    motion,
    objects,
    performance,
    resume,
    sampling,
    simplify,
    uses,
    view_layer,
    world,
)

CLASSES = (
    *sampling.CLASSES,
    *light_paths.CLASSES,
    *simplify.CLASSES,
    *motion.RENDER_CLASSES,
    *film.CLASSES,
    *performance.CLASSES,
    *resume.CLASSES,
    *bake.CLASSES,
    *messages.CLASSES,
    *uses.CLASSES,
    *check.CLASSES,
    *view_layer.CLASSES,
    *world.CLASSES,
    *objects.CLASSES,
    *motion.OBJECT_CLASSES,
    *camera.CLASSES,
    *light.CLASSES,
    *material.CLASSES,
)


def register():
    add_all(CLASSES, bpy.utils.register_class, bpy.utils.unregister_class)
    adopted.adopt()


def unregister():
    described.forget()
    adopted.release()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
