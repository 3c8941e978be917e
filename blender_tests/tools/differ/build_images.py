"""Records of images as Blender's data; pixels come of seeds, so that a scene is short in print."""

import os
import tempfile

import bpy
import numpy as np

from scenes.parity import avi, image_files, images, png

# Files of a sequence or of tiles, by number; and frames of a movie.
_NUMBERS = {"SEQUENCE": (1, 2, 3), "TILED": (1001, 1002, 1011)}
_FRAMES = 3
# Texels of a picture in the texture cache for each that it would have: smaller ones have a single level.
_ENLARGED = 64


def is_cached(fields):
    """Whether an image is in the texture cache, where the running Blender has one."""
    return fields.get("cached", False) and bpy.app.version >= (5, 2)


def _pixels(fields, number=0):
    """Return the pixels of an image, or those of one of its files or frames."""
    width, height = fields["size"]
    source = np.random.default_rng(fields["seed"] + 100 * number)
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
    times = _ENLARGED if is_cached(fields) else fields.get("enlarged", 1)
    return pixels.repeat(times, 0).repeat(times, 1)


def build_image(name, fields):
    space = images.LINEAR if fields["space"] == "Linear" else fields["space"]
    try:
        return _build(name, fields, space)
    except TypeError:
        # A space that this Blender lacks.
        return _build(name, fields, "sRGB")


def _build(name, fields, space):
    pixels, kind, alpha_mode = _pixels(fields), fields["format"], fields.get("alpha_mode", "STRAIGHT")
    if kind == "FLOAT":
        # Another colour space or alpha mode takes the pixels away from an image that is in no file.
        return images.image(name, pixels, space, is_float=True, alpha_mode=alpha_mode, pack=False)
    source = fields.get("source", "FILE")
    if source == "MOVIE":
        image = _movie(fields)
    elif source != "FILE":
        image = _of_many_files(fields, source)
    elif kind == "BYTE":
        image = images.image(name, pixels, "Non-Color")
    else:
        image = bpy.data.images.load(_write(os.path.join(bpy.app.tempdir, name), pixels, kind, fields.get("grey")))
    image.colorspace_settings.name, image.alpha_mode = space, alpha_mode
    return image


def _movie(fields):
    path = os.path.join(tempfile.mkdtemp(dir=bpy.app.tempdir), "movie.avi")
    with open(path, "wb") as file:
        file.write(avi.encode([_pixels(fields, number)[..., :3] for number in range(_FRAMES)]))
    return bpy.data.images.load(path)


def _of_many_files(fields, source):
    folder, numbers = tempfile.mkdtemp(dir=bpy.app.tempdir), _NUMBERS[source]
    for number in numbers:
        stem = os.path.join(folder, f"part.{number:04}")
        path = _write(stem, _pixels(fields, number), fields["format"], fields.get("grey"))
    image = bpy.data.images.load(path.replace(f"{numbers[-1]:04}", f"{numbers[0]:04}"))
    image.source = source
    if source == "TILED":
        image.filepath = image.filepath.replace(str(numbers[0]), "<UDIM>")
        for number in numbers[1:]:
            image.tiles.new(number)
    return image


def _write(stem, pixels, kind, is_grey):
    """Store pixels in a file of the format, and return its path."""
    if kind == "PNG8":
        with open(f"{stem}.png", "wb") as file:
            file.write(png.encode(pixels[::-1]))
        return f"{stem}.png"
    used = pixels[..., :1] if is_grey else pixels[..., :3] if kind == "HDR" else pixels
    return image_files.write({"PNG16": "PNG"}.get(kind, kind), stem, used)
