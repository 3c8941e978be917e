"""Image textures: projections, borders, interpolation, colour, alpha, and sources of pixels."""

import os

import bpy
import numpy as np

from .. import parts
from . import images, png
from .catalogue import case, variants
from .nodes import material
from .stages import ball, camera, card, sky


def _picture(nodes, image, vector=None, output="Color", **props):
    node = nodes.add("ShaderNodeTexImage", props={"image": image, **props})
    if vector is not None:
        nodes.link(vector, node.inputs["Vector"])
    return node.outputs[output]


def _matt(nodes, color):
    return nodes.add("ShaderNodeBsdfDiffuse", Color=color)


def _stretched(nodes, scale):
    """Returns UV coordinates that extend beyond both borders of the image."""
    uv = nodes.add("ShaderNodeTexCoord").outputs["UV"]
    return nodes.add("ShaderNodeMapping", Vector=uv, Location=((1 - scale) / 2,) * 3, Scale=(scale,) * 3)


@case(quick=True)
def image_flat(scene):
    card(scene, material(lambda nodes: _matt(nodes, _picture(nodes, images.gradient()))))


@variants(values={"sharp": 0.0, "blended": 0.5})
def image_box(scene, blend):
    def build(nodes):
        where = nodes.add("ShaderNodeTexCoord").outputs["Generated"]
        props = {"projection": "BOX", "projection_blend": blend}
        return _matt(nodes, _picture(nodes, images.gradient(), where, **props))

    parts.place(scene, "Cube", parts.cube_mesh("Cube", 1.6), material(build), rotation=(0.3, 0.5, 0.4))
    ball(scene, material(build), radius=0.9, location=(1.9, 0.5, 0))
    sky(scene, (0.8, 0.8, 0.8), 1.0)
    camera(scene, (0.8, -5, 1.5), (0.8, 0, 0))


@variants(values={"sphere": "SPHERE", "tube": "TUBE"})
def image_round(scene, projection):
    def build(nodes):
        where = nodes.add("ShaderNodeTexCoord").outputs["Generated"]
        return _matt(nodes, _picture(nodes, images.gradient(), where, projection=projection))

    ball(scene, material(build)).rotation_euler = (0.2, 0.3, 0.5)
    sky(scene, (0.8, 0.8, 0.8), 1.0)
    camera(scene, (0, -3.6, 2.6), (0, 0, 1))


@variants(values={"color": "Color", "alpha": ("Alpha", {"quick": True})}, bounces=0)
def image_missing_clipped(scene, output):
    """Magenta where the map is within its borders, and nothing beyond them."""
    card(scene, material(lambda nodes: _matt(nodes, _picture(nodes, None, _stretched(nodes, 2.0), output, extension="CLIP"))))


@variants(values={"repeat": "REPEAT", "extend": "EXTEND", "clip": "CLIP", "mirror": ("MIRROR", {"since": (3, 5)})})
def image_extension(scene, extension):
    def build(nodes):
        where = _stretched(nodes, 2.3)
        picture = nodes.add("ShaderNodeTexImage", props={"image": images.gradient(), "extension": extension}, Vector=where)
        mix = nodes.add("ShaderNodeMixShader", picture.outputs["Alpha"])
        nodes.link(nodes.add("ShaderNodeEmission", Color=(0.1, 0.1, 0.4)), mix.inputs[1])
        nodes.link(_matt(nodes, picture.outputs["Color"]), mix.inputs[2])
        return mix

    card(scene, material(build))


@variants(values={"linear": "Linear", "closest": "Closest", "cubic": "Cubic", "smart": "Smart"})
def image_interpolation(scene, interpolation):
    def build(nodes):
        return _matt(nodes, _picture(nodes, images.gradient(), interpolation=interpolation))

    card(scene, material(build))


@variants(values={"srgb": "sRGB", "raw": "Non-Color", "linear": images.LINEAR})
def image_colorspace(scene, colorspace):
    card(scene, material(lambda nodes: _matt(nodes, _picture(nodes, images.gradient(colorspace=colorspace)))))


@case(since=(4, 0))
def image_colorspace_other(scene):
    """A colour space with other primaries, which only Blender can convert."""
    card(scene, material(lambda nodes: _matt(nodes, _picture(nodes, images.gradient(colorspace="Linear DCI-P3 D65")))))


def _veil():
    pixels = images.gradient_pixels()
    pixels[..., 3] = np.linspace(0.1, 1.0, pixels.shape[1])
    return pixels


@variants(
    values={
        "straight": "STRAIGHT",
        "premultiplied": "PREMUL",
        "packed": "CHANNEL_PACKED",
        "none": "NONE",
    }
)
def image_alpha(scene, mode):
    def build(nodes):
        image = images.from_file("Veil", _veil())
        image.alpha_mode = mode
        picture = nodes.add("ShaderNodeTexImage", props={"image": image})
        mix = nodes.add("ShaderNodeMixShader", picture.outputs["Alpha"])
        nodes.link(nodes.add("ShaderNodeEmission", Color=(0.1, 0.1, 0.4)), mix.inputs[1])
        nodes.link(_matt(nodes, picture.outputs["Color"]), mix.inputs[2])
        return mix

    card(scene, material(build))


@case()
def image_alpha_unlinked(scene):
    """The colour of an image with alpha."""
    card(scene, material(lambda nodes: _matt(nodes, _picture(nodes, images.from_file("Veil", _veil())))))


@case()
def image_alpha_clips(scene):
    """Holes cut by an image's alpha, and their shadow."""

    def build(nodes):
        pixels = images.checker_pixels()
        pixels[..., 3] = pixels[..., 0] > 0.4
        picture = nodes.add("ShaderNodeTexImage", props={"image": images.image("Holes", pixels), "interpolation": "Closest"})
        mix = nodes.add("ShaderNodeMixShader", picture.outputs["Alpha"])
        nodes.link(nodes.add("ShaderNodeBsdfTransparent"), mix.inputs[1])
        nodes.link(nodes.add("ShaderNodeBsdfDiffuse", Color=(0.7, 0.3, 0.2)), mix.inputs[2])
        return mix

    card(scene, material(build), 2.0)
    floor_material = material(lambda nodes: nodes.add("ShaderNodeBsdfDiffuse", Color=(0.6, 0.6, 0.6)))
    parts.place(scene, "Under", parts.plane_mesh("Under", 8.0), floor_material, (0, 0, -0.6))
    parts.add_light(scene, "Sun", "SUN", 3.0, (1, 0.5, 2), angle=0.0)


@case()
def image_file(scene):
    card(scene, material(lambda nodes: _matt(nodes, _picture(nodes, images.from_file("File", images.gradient_pixels())))))


@case()
def image_generated(scene):
    def build(nodes):
        image = bpy.data.images.new("Grid", 64, 64)
        image.generated_type = "COLOR_GRID"
        return _matt(nodes, _picture(nodes, image))

    card(scene, material(build))


@case(quick=True)
def image_float(scene):
    """Values below 0 and above 1 in single precision."""
    pixels = images.gradient_pixels()
    pixels[..., :3] = 2.5 * pixels[..., :3] - 0.2

    def build(nodes):
        image = images.image("Float", pixels, images.LINEAR, is_float=True, pack=False)
        return nodes.add("ShaderNodeEmission", Color=_picture(nodes, image))

    card(scene, material(build))


@case()
def image_udim(scene):
    folder = bpy.app.tempdir
    for number, turn in ((1001, 0), (1002, 1), (1011, 2)):
        pixels = np.rot90(images.gradient_pixels(12, 12), turn)[..., :3]
        with open(os.path.join(folder, f"tile.{number}.png"), "wb") as file:
            file.write(png.encode(pixels[::-1]))

    def build(nodes):
        image = bpy.data.images.load(os.path.join(folder, "tile.<UDIM>.png"))
        image.source = "TILED"
        for number in (1002, 1011):
            if image.tiles.get(number) is None:
                image.tiles.new(number)
        return _matt(nodes, _picture(nodes, image))

    thing = card(scene, material(build))
    # Two by two tiles; the fourth is missing.
    for item in thing.data.uv_layers.active.data:
        item.uv = item.uv * 2.0


@case()
def image_sequence(scene):
    folder = bpy.app.tempdir
    for frame in (1, 2, 3):
        with open(os.path.join(folder, f"frame_{frame:04}.png"), "wb") as file:
            file.write(png.encode(np.rot90(images.gradient_pixels(12, 12), frame)[..., :3]))

    def build(nodes):
        image = bpy.data.images.load(os.path.join(folder, "frame_0001.png"))
        image.source = "SEQUENCE"
        node = nodes.add("ShaderNodeTexImage", props={"image": image})
        user = node.image_user
        user.frame_duration, user.frame_start, user.frame_offset, user.use_auto_refresh = 3, 1, 0, True
        return _matt(nodes, node.outputs["Color"])

    card(scene, material(build))
    scene.frame_set(2)


@case()
def image_large(scene):
    """An image finer than the picture: many texels in each pixel."""
    source = np.random.default_rng(7)
    pixels = np.ones((512, 512, 4))
    pixels[..., :3] = source.uniform(0.0, 1.0, (512, 512, 3))
    card(scene, material(lambda nodes: _matt(nodes, _picture(nodes, images.image("Fine", pixels)))))


@case()
def image_roughness(scene):
    """An image as the roughness."""

    def build(nodes):
        rough = _picture(nodes, images.gradient(colorspace="Non-Color"))
        return nodes.add("ShaderNodeBsdfGlossy", props={"distribution": "GGX"}, Color=(0.8, 0.8, 0.8), Roughness=rough)

    card(scene, material(build))
    parts.add_light(scene, "Lamp", "AREA", 60.0, (0, 2, 2), size=2.0)
