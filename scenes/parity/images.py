"""Synthetic images: every pixel has a different value, and no edge resembles its opposite."""

import os

import bpy
import numpy as np

from . import png

LINEAR = "Linear Rec.709" if bpy.app.version >= (4, 0) else "Linear"


def image(name, pixels, colorspace="sRGB", is_float=False, alpha_mode="STRAIGHT", pack=True):
    """Returns an image of (height, width, 4) values as stored; row 0 is the lowest."""
    height, width = pixels.shape[:2]
    result = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    result.colorspace_settings.name = colorspace
    result.alpha_mode = alpha_mode
    result.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    result.update()
    if pack:
        result.pack()
    return result


def gradient_pixels(width=16, height=12):
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    pixels = np.stack([x, y, 0.5 + 0.4 * np.cos(7 * x) * np.sin(5 * y), np.ones_like(x)], axis=-1)
    # A mark in one corner reveals mirrored and rotated images.
    pixels[: height // 4, : width // 4, :3] = (0.9, 0.9, 0.1)
    return pixels


def checker_pixels(cells=8, dark=0.15, bright=0.9):
    x, y = np.meshgrid(np.arange(cells), np.arange(cells))
    value = np.where((x + y) % 2 == 0, dark, bright) * (0.6 + 0.4 * x / cells)
    return np.stack([value, value, value, np.ones_like(value)], axis=-1)


def gradient(name="Gradient", **fields):
    return image(name, gradient_pixels(), **fields)


def checker(name="Checker", **fields):
    return image(name, checker_pixels(), **fields)


def from_file(name, pixels, colorspace="sRGB"):
    """Returns the pixels as an image loaded from a PNG file."""
    path = os.path.join(bpy.app.tempdir, f"{name}.png")
    with open(path, "wb") as file:
        file.write(png.encode(pixels[::-1]))
    result = bpy.data.images.load(path)
    result.colorspace_settings.name = colorspace
    return result
