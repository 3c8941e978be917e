"""Scenes by name, for tests, benchmark and README: `import scenes; scenes.load("balls")`.

A builder fills the current, empty Blender scene and works in Blender 3.4 to 5.2, with or without the engine registered.
"""

import bpy

from . import heavy, lab, rooms, showcase, spheres

BUILDERS = {
    "showcase": showcase.build,
    "balls": spheres.build_balls,
    "spheres600": spheres.build_spheres600,
    "default_cube": rooms.build_default_cube,
    "cornell": rooms.build_cornell,
    "lab": lab.build,
    "million": heavy.build_million,
    "instances": heavy.build_instances,
}


def load(name):
    """Starts an empty file, builds the named scene in it and returns it."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return build(name)


def build(name):
    """Builds the named scene into the current scene, which should be empty, and returns it."""
    scene = bpy.context.scene
    BUILDERS[name](scene)
    return scene
