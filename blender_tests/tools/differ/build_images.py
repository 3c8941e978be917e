"""Records of images as Blender's data; pixels come of seeds, so that a scene is short in print."""

import os

import bpy
import numpy as np

from scenes.parity import image_files, images, png


def _pixels(fields):
    width, height = fields["size"]
    source = np.random.default_rng(fields["seed"])
    pixels = np.ones((height, width, 4))
    pixels[..., :3] = source.uniform(0.05, 0.95, (height, width, 3))
    if "peak" in fields:
        # Few neighbours are as unlike as noise: a sky is smooth, but for its sun.
        x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
        pixels[..., 0], pixels[..., 1], pixels[..., 2] = 0.2 + 0.7 * y, 0.5 + 0.4 * np.sin(2 * np.pi * x), 0.8 - 0.5 * x
        pixels[int(0.7 * height), int(pixels[0, 0, 0] * width) % width, :3] *= fields["peak"]
    if fields.get("alpha", "none") == "smooth":
        pixels[..., 3] = source.uniform(0.0, 1.0, (height, width))
    elif fields.get("alpha", "none") == "cut":
        pixels[..., 3] = source.uniform(0.0, 1.0, (height, width)) < 0.5
    return pixels


def build_image(name, fields):
    pixels, kind = _pixels(fields), fields["format"]
    space = images.LINEAR if fields["space"] == "Linear" else fields["space"]
    if kind in ("BYTE", "FLOAT"):
        image = images.image(name, pixels, "Non-Color", is_float=kind == "FLOAT", pack=kind == "BYTE")
    else:
        stem = os.path.join(bpy.app.tempdir, name)
        if kind == "PNG8":
            path = f"{stem}.png"
            with open(path, "wb") as file:
                file.write(png.encode(pixels[::-1]))
        else:
            used = pixels[..., :1] if fields.get("grey") else pixels[..., :3] if kind == "HDR" else pixels
            path = image_files.write({"PNG16": "PNG"}.get(kind, kind), stem, used)
        image = bpy.data.images.load(path)
    try:
        image.colorspace_settings.name = space
    except TypeError:
        # A space that this Blender lacks.
        image.colorspace_settings.name = "sRGB"
    image.alpha_mode = fields.get("alpha_mode", "STRAIGHT")
    return image
