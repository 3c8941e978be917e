"""Image files of more than eight bits: Cycles interpolates the stored values and decodes sRGB afterwards."""

import os

import bpy
import numpy as np

from . import image_files, images
from .boards import set_board, size_of, tile_mesh
from .catalogue import case, variants
from .nodes import material, world
from .stages import camera, card

FORMATS = {"png": "PNG", "tiff": "TIFF", "exr": "OPEN_EXR"}
ALPHA_MODES = {"straight": "STRAIGHT", "premultiplied": "PREMUL", "packed": "CHANNEL_PACKED", "none": "NONE"}
OLD_HDR = (
    "Debian's OpenImageIO decodes RGBE bytes half a step, 0.2 to 0.4 %, brighter than Blender; the sRGB curve makes this 0.9 %"
)


def _coarse(low=0.0, high=1.0, channels=3, seed=3):
    """Few texels with very different values: between them, encoded and linear interpolation differ most."""
    return np.random.default_rng(seed).uniform(low, high, (5, 7, channels))


def _shown(scene, image, alpha=False, **props):
    """Shows the image as emission; alpha: mixed with another shader by the image's alpha."""

    def build(nodes):
        picture = nodes.add("ShaderNodeTexImage", props={"image": image, **props})
        light = nodes.add("ShaderNodeEmission", Color=picture.outputs["Color"])
        if not alpha:
            return light
        mix = nodes.add("ShaderNodeMixShader", picture.outputs["Alpha"])
        nodes.link(nodes.add("ShaderNodeEmission", Color=(0.1, 0.1, 0.4)), mix.inputs[1])
        nodes.link(light, mix.inputs[2])
        return mix

    return card(scene, material(build))


@variants(
    values={
        "png": ("PNG", {"quick": True}),
        "tiff": "TIFF",
        "exr": ("OPEN_EXR", {"quick": True}),
        "hdr": ("HDR", {"blender3": ((0.009, 0.02), OLD_HDR)}),
    }
)
def image_depth(scene, kind):
    _shown(scene, image_files.from_file(kind, _coarse()))


@variants(values={"closest": "Closest", "cubic": "Cubic", "smart": "Smart"})
def image_depth_interpolation(scene, interpolation):
    _shown(scene, image_files.from_file("PNG", _coarse()), interpolation=interpolation)


@variants(values={"repeat": "REPEAT", "extend": "EXTEND", "clip": "CLIP", "mirror": ("MIRROR", {"since": (3, 5)})})
def image_depth_extension(scene, extension):
    thing = _shown(scene, image_files.from_file("PNG", _coarse(channels=4)), alpha=True, extension=extension)
    for item in thing.data.uv_layers.active.data:
        item.uv = (item.uv[0] * 2.3 - 0.65, item.uv[1] * 2.3 - 0.65)


@variants(
    values={
        f"{name}_{space}": (kind, value)
        for name, kind in FORMATS.items()
        for space, value in {"raw": "Non-Color", "linear": images.LINEAR, "filmic": "Filmic sRGB"}.items()
    }
)
def image_depth_colorspace(scene, choice):
    kind, space = choice
    _shown(scene, image_files.from_file(kind, _coarse(), space))


def _veil(kind):
    """Returns an image with alpha, premultiplied where the format is."""
    pixels = _coarse(0.1, 1.0, channels=4)
    if kind == "OPEN_EXR":
        pixels[..., :3] *= pixels[..., 3:]
    return pixels


@variants(
    values={
        f"{name}_{mode}{suffix}": (kind, value, linked, space)
        for name, kind in FORMATS.items()
        for mode, value in ALPHA_MODES.items()
        for suffix, linked, space in (("", True, "sRGB"), ("_unlinked", False, "sRGB"), ("_linear", True, images.LINEAR))
        if kind != "TIFF" or mode == "straight"
    }
)
def image_depth_alpha(scene, choice):
    kind, mode, linked, space = choice
    image = image_files.from_file(kind, _veil(kind), space)
    image.alpha_mode = mode
    _shown(scene, image, linked)


@case()
def image_depth_beyond(scene):
    """Encoded values below 0 and above 1."""
    _shown(scene, image_files.from_file("OPEN_EXR", _coarse(-0.5, 2.5)))


@variants(values={f"{k}_{mode}": (kind, value) for k, kind in FORMATS.items() for mode, value in ALPHA_MODES.items()})
def image_depth_packed(scene, choice):
    """A file packed in the .blend, which Blender decodes before Cycles interpolates."""
    kind, mode = choice
    image = image_files.from_file(kind, _veil(kind))
    image.alpha_mode = mode
    image.pack()
    _shown(scene, image, alpha=True)


@variants(values=ALPHA_MODES)
def image_bytes_packed(scene, mode):
    image = images.from_file("Bytes", _coarse(0.1, 1.0, channels=4))
    image.alpha_mode = mode
    image.pack()
    _shown(scene, image, alpha=True)


@variants(values=ALPHA_MODES)
def image_depth_painted(scene, mode):
    """Float values without a file, with the colour space sRGB."""
    _shown(scene, images.image("Painted", _veil("OPEN_EXR"), "sRGB", is_float=True, alpha_mode=mode, pack=False), alpha=True)


@variants(values=ALPHA_MODES)
def image_bytes_painted(scene, mode):
    _shown(scene, images.image("Painted", _coarse(0.1, 1.0, channels=4), alpha_mode=mode, pack=False), alpha=True)


@case()
def image_depth_grey(scene):
    """One channel."""
    _shown(scene, image_files.from_file("TIFF", _coarse(channels=1)))


@variants(values={"png": "PNG", "exr": "OPEN_EXR"})
def image_depth_udim(scene, kind):
    for number in (1001, 1002):
        path = image_files.write(kind, os.path.join(bpy.app.tempdir, f"tile.{number}"), _coarse(seed=number))
    image = image_files.load(path.replace("1002", "<UDIM>"), "sRGB")
    image.source = "TILED"
    if image.tiles.get(1002) is None:
        image.tiles.new(1002)
    thing = _shown(scene, image)
    for item in thing.data.uv_layers.active.data:
        item.uv = (item.uv[0] * 2.0, item.uv[1])


@case()
def image_depth_sequence(scene):
    for frame in (1, 2):
        path = image_files.write("PNG", os.path.join(bpy.app.tempdir, f"deep_{frame:04}"), _coarse(seed=frame))
    image = image_files.load(path.replace("0002", "0001"), "sRGB")
    image.source = "SEQUENCE"
    thing = _shown(scene, image)
    user = next(node for node in thing.active_material.node_tree.nodes if node.type == "TEX_IMAGE").image_user
    user.frame_duration, user.frame_start, user.frame_offset, user.use_auto_refresh = 2, 1, 0, True
    scene.frame_set(2)


# Channels of files with layers: the usual ones, four of which the first is no colour, three axes, and one number.
_LAYERS = {
    "combined": [*(f"View.Combined.{shade}" for shade in "RGBA"), "View.Depth.Z"],
    "occlusion": [*(f"View.AO.{shade}" for shade in "RGB"), *(f"View.Combined.{shade}" for shade in "RGBA")],
    "axes": [*(f"View.Normal.{axis}" for axis in "XYZ"), *(f"View.Other.{shade}" for shade in "RGB")],
    "grey": ["A.Depth.Z", "B.Depth.Z"],
    "mixed": ["R", "G", "B", "A", "Mask.R"],
}


def _layers(name, space="sRGB"):
    pixels = _coarse(0.1, 1.0, channels=len(_LAYERS[name]))
    path = image_files.write_layers(
        os.path.join(bpy.app.tempdir, name), {channel: pixels[..., number] for number, channel in enumerate(_LAYERS[name])}
    )
    return image_files.load(path, space)


def _of_image(image, output):
    return lambda nodes: nodes.add("ShaderNodeTexImage", props={"image": image}).outputs[output]


@case(size=size_of(2 * len(_LAYERS)), bounces=0, quick=True)
def image_layers(scene):
    """Colour and alpha of files with layers: Cycles shows the first four channels, whatever they are."""
    mesh = tile_mesh()
    pictures = [_layers(name) for name in _LAYERS]
    set_board(scene, [(mesh, _of_image(image, output)) for image in pictures for output in ("Color", "Alpha")])


@case(size=size_of(6), bounces=0, quick=True)
def image_layers_packed(scene):
    """Packed files of layers, of which Cycles shows the pass Combined or the only one."""
    tiles = []
    for name in ("combined", "occlusion", "grey"):
        image = _layers(name)
        image.pack()
        tiles += [(tile_mesh(), _of_image(image, output)) for output in ("Color", "Alpha")]
    set_board(scene, tiles)


@variants(values={"png": "PNG", "exr": "OPEN_EXR"})
def world_depth(scene, kind):
    """A sky of few texels, encoded in sRGB."""
    image = image_files.from_file(kind, _coarse())

    def build(nodes):
        picture = nodes.add("ShaderNodeTexEnvironment", props={"image": image})
        return nodes.add("ShaderNodeBackground", Color=picture.outputs["Color"])

    world(scene, build)
    camera(scene, (0, 0, 0), (0.3, 1, 0.2), lens=14.0)


@variants(values={"bytes": 8, "deep": 16}, since=(5, 0))
def image_working_space(scene, depth):
    """Where the working space needs a matrix besides sRGB's curve, texels are converted before interpolation."""
    bpy.ops.wm.set_working_color_space(working_space="ACEScg", convert_colors=False)
    _shown(scene, images.from_file("Bytes", _coarse()) if depth == 8 else image_files.from_file("PNG", _coarse()))
