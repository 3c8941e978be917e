"""Scenes by name, for tests, benchmark and README: `import scenes; scenes.load("balls")`.

A builder fills the current, empty Blender scene and works in Blender 3.4 to 5.2, with or without the engine registered.
The judge of pictures in scenes.parity needs no Blender, so this package imports bpy only inside the functions that build."""

import importlib

# The module and the function of each scene.
BUILDERS = {
    "showcase": "showcase.build",
    "balls": "spheres.build_balls",
    "balls_exact": "spheres.build_balls_exact",
    "coated": "spheres.build_coated",
    "spheres600": "spheres.build_spheres600",
    "default_cube": "rooms.build_default_cube",
    "cornell": "rooms.build_cornell",
    "room": "rooms.build_room",
    "triangle": "rooms.build_triangle",
    "daylight": "rooms.build_daylight",
    "glass_metal": "vitrine.build",
    "product": "vitrine.build_product",
    "wax": "wax.build",
    "sun": "sun.build",
    "lights2": "lamps.build_lights2",
    "lights200": "lamps.build_lights200",
    "lights10k": "lamps.build_lights10k",
    "models": "outdoors.build_models",
    "textured": "outdoors.build_textured",
    "leaves": "outdoors.build_leaves",
    "foliage": "outdoors.build_foliage",
    "runner": "moving.build_runner",
    "flight": "moving.build_flight",
    "sixty_nodes": "graphs.build_sixty_nodes",
    "procedural_floor": "graphs.build_procedural_floor",
    "lab": "lab.build",
    "million": "heavy.build_million",
    "head": "heavy.build_head",
    "instances": "heavy.build_instances",
    "terrain": "heavy.build_terrain",
    "crowd": "heavy.build_crowd",
}


def load(name):
    """Opens an empty file, builds the named scene in it and returns the scene."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return build(name)


def build(name):
    """Builds the named scene into the current scene, which should be empty, and returns it."""
    import bpy

    module, function = BUILDERS[name].split(".")
    scene = bpy.context.scene
    getattr(importlib.import_module(f".{module}", __package__), function)(scene)
    return scene
