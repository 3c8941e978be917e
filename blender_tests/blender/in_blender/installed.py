"""A render by an installed add-on, inside a Blender."""

import os
import sys

import bpy


def render(module, folder):
    """Render and return the release and the library of the add-on with that module's name. folder: for the picture."""
    scene = bpy.context.scene
    scene.render.engine = "LANCER"
    scene.lancer.quality, scene.lancer.samples = "CUSTOM", 1
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.filepath = os.path.join(folder, "picture.png")
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(scene.render.filepath)
    brightest = max(value for i, value in enumerate(picture.pixels) if i % 4 < 3)
    bpy.data.images.remove(picture)
    os.remove(scene.render.filepath)
    abi = sys.modules[module + ".bindings.abi"]
    return {
        "release": sys.modules[module].VERSION,
        "library": abi.load_library().lancer_version().decode(),
        "file": abi.library_path(),
        "lit": brightest > 0.0,
    }
