"""In a real window: F12 renders meshes that are in Edit mode, without leaving it. Started by window_case.py."""

import json
import os

import bpy
import edit_cases
import stage

_boxes = []


def build():
    """Build the scene of edit_cases, before the window has opened."""
    scene = bpy.context.scene
    scene.render.engine = "LANCER"
    scene.render.resolution_x = scene.render.resolution_y = edit_cases.SIZE
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    scene.world = None
    own = scene.lancer
    own.quality, own.samples, own.pixel_filter = "CUSTOM", 1, "BOX"
    _boxes[:] = edit_cases.fill(scene)[2:]


def edit():
    """Enter Edit mode as a user does, with three objects, and move two of them."""
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        edit_cases.edit(*_boxes)


def compare(folder):
    """Write the lit pixels of the window's picture, its largest difference from Cycles', and the mode of each object."""
    result = bpy.data.images["Render Result"]
    settings = bpy.context.scene.render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    path = os.path.join(folder, "window.exr")
    result.save_render(path)
    ours = stage.pixels(path)
    bpy.context.scene.render.engine = "CYCLES"
    told = edit_cases.told(ours, stage.picture(bpy.context.scene))
    told["mode"] = [item.mode for item in _boxes]
    with open(os.path.join(folder, "edited.json"), "w", encoding="utf-8") as file:
        json.dump(told, file)
