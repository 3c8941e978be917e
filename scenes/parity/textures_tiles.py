"""Tiles of images, missing files and unsaved pixels: where Cycles shows a picture, magenta or nothing."""

import os
import shutil
import tempfile

import bpy
import numpy as np

from . import image_files
from .boards import set_board, size_of, tile_mesh
from .catalogue import case, variants
from .nodes import find


def _file(kind, name, seed=3):
    pixels = np.random.default_rng(seed).uniform(0.3, 0.8, (3, 4, 4))
    return image_files.write(kind, os.path.join(bpy.app.tempdir, name), pixels)


def _lost(name="lost.png"):
    image = bpy.data.images.new(name, 4, 4)
    image.source, image.filepath = "FILE", os.path.join(bpy.app.tempdir, f"nowhere_{name}")
    return image


def _lost_as(source):
    def make():
        image = _lost(f"lost_{source}.png")
        image.source = source
        return image

    return make


def _lost_tiles():
    return _tiled((1001, 1002), ())


def _no_picture():
    path = os.path.join(bpy.app.tempdir, "text.png")
    with open(path, "w", encoding="utf-8") as file:
        file.write("no picture")
    image = bpy.data.images.load(path)
    return image


_LOST = {
    "file": _lost,
    "text": _no_picture,
    "sequence": _lost_as("SEQUENCE"),
    "movie": _lost_as("MOVIE"),
    "tiles": _lost_tiles,
}


def _of(image, output, scale=None, offset=-0.4, **props):
    """value of a tile; scale: of the map, which begins at the offset, beyond the borders of the image."""

    def value(nodes):
        node = nodes.add("ShaderNodeTexImage", props={"image": image, **props})
        if scale is not None:
            uv = nodes.add("ShaderNodeTexCoord").outputs["UV"]
            move = nodes.add("ShaderNodeMapping", Vector=uv, Location=(offset, offset, 0.0), Scale=(scale, scale, 1.0))
            nodes.link(move, find(node.inputs, "Vector"))
        return node.outputs[output]

    return value


def _in_wide_gamut(image):
    """Copies whose colours are converted to the working space."""
    copies = image.copy(), image.copy()
    for copy, mode in zip(copies, ("STRAIGHT", "CHANNEL_PACKED"), strict=True):
        copy.alpha_mode = mode
        copy.colorspace_settings.name = "Filmic sRGB"
    return copies


@variants(values=_LOST, size=size_of(20), bounces=0, quick=True)
def image_lost(scene, make):
    """Colour and alpha of an image without pixels: by extension, by projection, by alpha mode and as data."""
    mesh, image = tile_mesh(), make()
    plain, data, packed = (image.copy() for _ in range(3))
    plain.alpha_mode, packed.alpha_mode = "NONE", "CHANNEL_PACKED"
    data.colorspace_settings.name = "Non-Color"
    others = plain, data, packed, *_in_wide_gamut(image)
    tiles = [(mesh, _of(image, output, 1.8, extension="CLIP")) for output in ("Color", "Alpha")]
    tiles += [(mesh, _of(image, output, 1.8, extension="EXTEND")) for output in ("Color", "Alpha")]
    tiles += [(mesh, _of(image, "Color", 1.8, projection=kind)) for kind in ("BOX", "SPHERE", "TUBE")]
    tiles += [(mesh, _of(image, "Color", 1.8, extension="CLIP", projection=kind)) for kind in ("BOX", "SPHERE", "TUBE")]
    tiles += [(mesh, _of(other, output)) for other in others for output in ("Color", "Alpha")]
    set_board(scene, tiles)


def _tiled(numbers, files, generated=()):
    """An image with tiles of these numbers, some of which have files and some are filled without a file."""
    path = os.path.join(tempfile.mkdtemp(dir=bpy.app.tempdir), "tiles.<UDIM>.png")
    for number in files:
        shutil.move(_file("PNG", f"tile{number}", number), path.replace("<UDIM>", str(number)))
    if generated:
        image = bpy.data.images.new("Tiles", 8, 6, alpha=True, tiled=True)
    else:
        image = bpy.data.images.load(path.replace("<UDIM>", str(files[0]))) if files else _lost("tiles.png")
        image.source, image.filepath = "TILED", path
    for number in set(numbers) - {tile.number for tile in image.tiles}:
        image.tiles.new(number)
    for tile in [tile for tile in image.tiles if tile.number not in numbers]:
        image.tiles.remove(tile)
    for turn, number in enumerate(generated):
        image.tiles.active = image.tiles.get(number)
        with bpy.context.temp_override(edit_image=image):
            kind = ("BLANK", "COLOR_GRID", "UV_GRID")[turn % 3]
            bpy.ops.image.tile_fill(color=(0.8, 0.3, 0.1, 0.5), generated_type=kind, width=8, height=6 + turn)
    return image


# Borders of tiles are borders of pixels, also in the small pictures of `make test`: their place within one gives no noise.
_MAP = 8 / 3, -1 / 3
_TILED = {
    "whole": ((1001, 1002, 1011, 1012), (1001, 1002, 1011, 1012), ()),
    "holes": ((1001, 1002, 1011, 1013), (1001, 1011), ()),
    "unlisted": ((1001, 1012), (1001, 1002, 1011, 1012), ()),
    "first_lost": ((1001, 1002, 1012), (1002, 1012), ()),
    "first_unlisted": ((1002, 1012), (1002, 1012), ()),
    "first_alone": ((1001,), (1001,), ()),
    "generated": ((1001, 1002, 1011), (), (1001, 1002, 1011)),
    "empty": ((1001, 1002, 1011), (), (1001, 1011)),
}


@variants(values=_TILED, size=size_of(8), bounces=0, quick=True)
def image_tiles(scene, choice):
    """Colour and alpha over four tiles and around them, by extension, interpolation and projection."""
    mesh, image = tile_mesh(), _tiled(*choice)
    tiles = [(mesh, _of(image, output, *_MAP, extension="REPEAT")) for output in ("Color", "Alpha")]
    tiles += [(mesh, _of(image, output, *_MAP, extension="CLIP")) for output in ("Color", "Alpha")]
    tiles += [(mesh, _of(image, "Color", *_MAP, extension="EXTEND", interpolation=kind)) for kind in ("Linear", "Cubic")]
    tiles += [(mesh, _of(image, "Color", *_MAP, projection=kind)) for kind in ("TUBE", "SPHERE")]
    set_board(scene, tiles)


_BOXES = ("whole", "first_lost", "first_unlisted", "first_alone")


@case(size=size_of(8), bounces=0, quick=True)
def image_tiles_box(scene):
    """Tiles from the sides of a box, of which Cycles shows the first alone."""
    mesh = tile_mesh()
    images = [_tiled(*_TILED[name]) for name in _BOXES]
    tiles = [(mesh, _of(image, "Color", *_MAP, projection="BOX")) for image in images]
    tiles += [(mesh, _of(image, "Color", *_MAP, projection="BOX", extension="CLIP")) for image in images]
    set_board(scene, tiles)


def _painted_file(kind):
    image = bpy.data.images.load(_file(kind, "stroke"))
    image.pixels[0:8] = (0.9, 0.1, 0.1, 1.0) * 2
    image.update()
    return image


def _painted_packed():
    image = bpy.data.images.load(_file("PNG", "stroke"))
    image.pack()
    image.pixels[0:8] = (0.9, 0.1, 0.1, 1.0) * 2
    image.update()
    return image


def _painted_generated():
    image = bpy.data.images.new("Grid", 8, 8)
    image.generated_type = "COLOR_GRID"
    image.pixels[0:8] = (0.9, 0.1, 0.1, 1.0) * 2
    image.update()
    return image


def _painted_tiles():
    image = _tiled((1001, 1002), (1001, 1002))
    image.pixels[0:8] = (0.9, 0.1, 0.1, 1.0) * 2
    image.update()
    return image


def _deleted():
    image = bpy.data.images.load(_file("PNG", "deleted"))
    image.pixels[0]
    os.remove(image.filepath)
    return image


def _painted_deleted():
    image = _painted_file("PNG")
    os.remove(image.filepath)
    return image


_UNSAVED = {
    "file": lambda: _painted_file("PNG"),
    "deep": lambda: _painted_file("EXR 32"),
    "packed": _painted_packed,
    "tiles": _painted_tiles,
    "generated": _painted_generated,
    "deleted": _deleted,
    "painted_deleted": _painted_deleted,
}


@variants(values=_UNSAVED, size=size_of(2), bounces=0, quick=True)
def image_unsaved(scene, make):
    """Strokes that no file has, and pixels whose file is gone."""
    mesh, image = tile_mesh(), make()
    set_board(scene, [(mesh, _of(image, output, interpolation="Closest")) for output in ("Color", "Alpha")])
