"""Scenes that both engines render to the same colours from one sample: even glow, each surface filling whole pixels."""

import functools
from collections import Counter

import bpy
import numpy as np
import stage

RED, GREEN, BLUE, GREY = (0.75, 0.125, 0.0625), (0.125, 0.5, 0.25), (0.0, 0.25, 1.0), (0.25, 0.25, 0.25)
# The picture has 16 x 8 pixels of 1 m.
WIDTH, HEIGHT = 16, 8


def by_both(case):
    """Let a case that takes an engine return its results by Cycles and by Lancer."""

    @functools.wraps(case)
    def compared(*arguments):
        return {engine: case(engine, *arguments) for engine in ("CYCLES", "LANCER")}

    return compared


def begin(engine):
    """Return a scene of a grey sky, seen from above."""
    scene = stage.empty(WIDTH, HEIGHT, 1, engine)
    furnish(scene, engine)
    return scene


def furnish(scene, engine, sky=GREY):
    """Give a scene of the same file the engine, the picture's size, a camera and a sky."""
    bpy.context.window.scene = scene
    render = scene.render
    render.engine = engine
    render.resolution_x, render.resolution_y, render.resolution_percentage = WIDTH, HEIGHT, 100
    render.threads_mode, render.threads = "FIXED", 2
    render.dither_intensity = 0.0
    scene.view_settings.view_transform = "Standard"
    scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = 1, False, False
    scene.cycles.pixel_filter_type = "BOX"
    own = scene.lancer
    own.quality, own.samples, own.target_error, own.use_denoising, own.pixel_filter = "CUSTOM", 1, 0.0, False, "BOX"
    stage.sky(sky)
    return stage.camera((0, 0, 5), (0, 0, 0), type="ORTHO", ortho_scale=float(WIDTH))


def patch(color, left, bottom, width=4, height=4, name="Patch", collection=None):
    """Return a glowing rectangle whose lower left corner lies at a pixel."""
    x, y = left - WIDTH / 2, bottom - HEIGHT / 2
    corners = [(x, y, 0), (x + width, y, 0), (x + width, y + height, 0), (x, y + height, 0)]
    item = stage.mesh(name, corners, [(0, 1, 2, 3)], stage.shader("ShaderNodeEmission", name, Color=color, Strength=1.0))
    if collection is not None:
        bpy.context.scene.collection.objects.unlink(item)
        collection.objects.link(item)
    return item


def second_layer(scene):
    """Add a view layer without what a collection has; return the collection."""
    only = bpy.data.collections.new("Only in the first")
    scene.collection.children.link(only)
    second = scene.view_layers.new("Second")
    second.layer_collection.children[only.name].exclude = True
    return only


def as_file(scene, kind="OPEN_EXR"):
    """Let a scene be written as a PNG file, or an EXR file of full floats."""
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "IMAGE"
    image.file_format, image.color_mode = kind, "RGBA"
    image.color_depth = "32" if kind == "OPEN_EXR" else "8"


def colors(picture):
    """Return the colours of a picture, rounded, with the pixels that show each, as {"r g b a": count}."""
    rows = np.round(np.asarray(picture, np.float64).reshape(-1, picture.shape[-1]), 4)
    return dict(Counter(" ".join(f"{x:g}" for x in row) for row in rows))


def first_red(picture):
    columns = np.nonzero(picture[0, :, 0] > 0.5)[0]
    return int(columns[0]) if len(columns) else None
