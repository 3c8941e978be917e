"""In a real window: images of every kind that is read from files, and the threads that read them.

Started by window_case.py. Each image covers its own part of the picture, so that the picture shows the image's colour.
"""

import json
import os
import threading

import bpy
import numpy as np
import stage

from addon.export import colorspace, image_sources

_SIZE = 256
# Colours as bytes: two tiles, the second frame of a sequence, premultiplied bytes, a colour space that is not a curve.
# test_window.py has the same first ones.
TILES, FRAME, PREMULTIPLIED, FILMIC = ((60, 120, 180), (180, 60, 120)), (120, 180, 60), (90, 30, 60), (100, 150, 200)


def _file(folder, name, color, alpha=1.0):
    image = bpy.data.images.new("written", _SIZE, _SIZE, alpha=True)
    image.pixels.foreach_set(np.tile(np.array([*(c / 255.0 for c in color), alpha], np.float32), _SIZE * _SIZE))
    image.filepath_raw, image.file_format = os.path.join(folder, name), "PNG"
    image.save()
    bpy.data.images.remove(image)
    return os.path.join(folder, name)


def _show(image, x, width=1.0):
    material = stage.shader("ShaderNodeEmission", image.name)
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    tree.links.new(node.outputs["Color"], tree.nodes["Emission"].inputs["Color"])
    item = stage.mesh(image.name, [(x, 0, 0), (x + width, 0, 0), (x + width, 1, 0), (x, 1, 0)], [(0, 1, 2, 3)], material)
    layer = item.data.uv_layers.new()
    for loop, uv in zip(layer.data, ((0, 0), (width, 0), (width, 1), (0, 1)), strict=True):
        loop.uv = uv
    return node


def build(folder):
    """Build five squares in a row, seen from above."""
    for number, color in zip((1001, 1002), TILES, strict=True):
        _file(folder, f"tile.{number}.png", color)
    tiled = bpy.data.images.load(os.path.join(folder, "tile.1001.png"))
    tiled.source, tiled.filepath = "TILED", os.path.join(folder, "tile.<UDIM>.png")
    if len(tiled.tiles) < 2:
        tiled.tiles.new(1002)
    _show(tiled, 0.0, 2.0)
    for frame, color in ((1, (0, 0, 0)), (2, FRAME)):
        _file(folder, f"frame_{frame}.png", color)
    sequence = bpy.data.images.load(os.path.join(folder, "frame_1.png"))
    sequence.source = "SEQUENCE"
    user = _show(sequence, 2.0).image_user
    user.frame_duration, user.frame_start = 2, 1
    multiplied = bpy.data.images.load(_file(folder, "multiplied.png", PREMULTIPLIED, 0.5))
    multiplied.alpha_mode = "PREMUL"
    _show(multiplied, 3.0)
    filmic = bpy.data.images.load(_file(folder, "filmic.png", FILMIC))
    filmic.colorspace_settings.name = "Filmic sRGB"
    _show(filmic, 4.0)
    scene = bpy.context.scene
    camera = stage.camera((2.5, 0.5, 1), (2.5, 0.5, 0), type="ORTHO", ortho_scale=5.0)
    camera.rotation_euler = (0, 0, 0)
    scene.frame_set(2)
    scene.render.engine = "LANCER"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 50, 10, 100
    scene.lancer.quality, scene.lancer.samples = "CUSTOM", 1


def _count():
    return sum(image.type not in ("RENDER_RESULT", "COMPOSITING") for image in bpy.data.images)


def watch(say):
    """Log the thread of all work on Blender's data and of all reading, and the number of images that it has added."""
    before = _count()

    def watched(name, work):
        def done(*arguments):
            here = threading.current_thread() is threading.main_thread()
            say(f"{name}-by-{'main' if here else 'render'}-adds-{_count() - before}")
            return work(*arguments)

        return done

    for name in ("_load", "_write"):
        setattr(colorspace, name, watched(name.strip("_"), getattr(colorspace, name)))
    image_sources.read_texels = watched("read", image_sources.read_texels)


def _save(folder, name):
    """Save the render result, which the window shows."""
    settings = bpy.context.scene.render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    bpy.data.images["Render Result"].save_render(os.path.join(folder, name))


def compare(folder):
    """Write the colours of the five squares in the window's picture, and their largest difference from a script's render."""
    _save(folder, "window.exr")
    bpy.ops.render.render()
    _save(folder, "script.exr")
    seen = []
    for name in ("window.exr", "script.exr"):
        image = bpy.data.images.load(os.path.join(folder, name))
        width, height = image.size
        pixels = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(pixels)
        seen.append(pixels.reshape(height, width, 4)[:, :, :3])
    colors = seen[0][5, 5::10].tolist()
    with open(os.path.join(folder, "colors.json"), "w", encoding="utf-8") as file:
        json.dump({"colors": colors, "difference": float(np.abs(seen[0] - seen[1]).max())}, file)
