"""Images in the texture cache of Blender 5.2: the level that a ray reads, from what its pixel sees there.

Each picture shows the fourth power of random texels, whose mean tells how many of them a level has averaged.
"""

import os

import bpy
import numpy as np

from .. import parts
from . import image_files, images
from .catalogue import case, variants
from .nodes import material, shader, world
from .stages import add_uv, ball, camera, displace, sky

_NEW = (5, 2)


def _texels(side=512, seed=1, channels=4):
    pixels = np.ones((side, side, channels))
    pixels[..., :3] = np.random.default_rng(seed).uniform(0.0, 1.0, (side, side, 1))
    return pixels


def _file(name="Cached", pixels=None, colorspace="Non-Color"):
    """Cycles takes a file of the cache for that of another image of the same name and second: sizes have names of their own."""
    pixels = _texels() if pixels is None else pixels
    return images.from_file(f"{name}{pixels.shape[1]}x{pixels.shape[0]}", pixels, colorspace)


def _cache(scene):
    scene.render.use_texture_cache = scene.render.use_auto_generate_texture_cache = True


def _glow(nodes, value):
    """Shines by the fourth power of a value."""
    power = nodes.add("ShaderNodeMath", value, 4.0, props={"operation": "POWER"})
    return nodes.add("ShaderNodeEmission", Strength=power)


def _picture(nodes, image, vector=None, **props):
    node = nodes.add("ShaderNodeTexImage", props={"image": image, **props})
    if vector is not None:
        nodes.link(vector, node.inputs["Vector"])
    return node


def _field(scene, surface, size=40.0, repeats=8.0):
    """A plane to the horizon."""
    _cache(scene)
    thing = parts.place(scene, "Field", parts.plane_mesh("Field", size), surface)
    add_uv(thing.data, repeats)
    scene.world = None
    camera(scene, (0, -6, 1.5), (0, 0, 0.5))
    return thing


@variants(values={"linear": "Linear", "closest": "Closest", "cubic": "Cubic"}, since=_NEW, bounces=0)
def image_cached(scene, interpolation):
    _field(scene, material(lambda nodes: _glow(nodes, _picture(nodes, _file(), interpolation=interpolation).outputs["Color"])))


@variants(values={"repeat": "REPEAT", "extend": "EXTEND", "clip": "CLIP", "mirror": "MIRROR"}, since=_NEW, bounces=0)
def image_cached_extension(scene, extension):
    """An image beside its borders. Its colour and alpha are shown."""

    def build(nodes):
        uv = nodes.add("ShaderNodeTexCoord").outputs["UV"]
        where = nodes.add("ShaderNodeMapping", Vector=uv, Location=(-0.9, -0.6, 0.0), Scale=(2.8, 2.8, 1.0))
        picture = _picture(nodes, _file(), where, extension=extension)
        mix = nodes.add("ShaderNodeMixShader", picture.outputs["Alpha"])
        nodes.link(nodes.add("ShaderNodeEmission", Color=(0.1, 0.1, 0.4)), mix.inputs[1])
        nodes.link(_glow(nodes, picture.outputs["Color"]), mix.inputs[2])
        return mix

    _field(scene, material(build), repeats=1.0)


@variants(values={"odd": (333, 201), "narrow": (1024, 40), "small": (63, 40), "one_level": (64, 64)}, since=_NEW, bounces=0)
def image_cached_side(scene, size):
    pixels = _texels(1024)[: size[1], : size[0]]
    _field(scene, material(lambda nodes: _glow(nodes, _picture(nodes, _file(pixels=pixels)).outputs["Color"])))


def _veiled(alpha_mode):
    pixels = _texels()
    pixels[..., 3] = np.random.default_rng(2).uniform(0.0, 1.0, pixels.shape[:2]) ** 3
    if alpha_mode == "PREMUL":
        pixels[..., :3] *= pixels[..., 3:]
    image = _file(f"Veiled{alpha_mode}", pixels, "sRGB")
    image.alpha_mode = alpha_mode
    return image


@variants(values={"straight": "STRAIGHT", "premultiplied": "PREMUL", "packed": "CHANNEL_PACKED"}, since=_NEW, bounces=0)
def image_cached_alpha(scene, mode):
    """sRGB with alpha: colours are averaged decoded, and as much as their alpha."""

    def build(nodes):
        picture = _picture(nodes, _veiled(mode))
        light = nodes.add("ShaderNodeCombineXYZ", picture.outputs["Color"], picture.outputs["Alpha"], 0.0)
        color = nodes.add("ShaderNodeVectorMath", light, (3.0, 3.0, 3.0), props={"operation": "POWER"})
        return nodes.add("ShaderNodeEmission", Color=color)

    _field(scene, material(build))


@variants(values={"png_16": "PNG", "exr_16": "EXR 16", "exr_32": "EXR 32"}, since=_NEW, bounces=0)
def image_cached_depth(scene, kind):
    image = image_files.from_file(kind, _texels(channels=3)[..., :3], "Non-Color", name="Deep")
    _field(scene, material(lambda nodes: _glow(nodes, _picture(nodes, image).outputs["Color"])))


@variants(values={"srgb": "sRGB", "linear": images.LINEAR, "other": "Linear DCI-P3 D65"}, since=_NEW, bounces=0)
def image_cached_space(scene, space):
    _field(scene, material(lambda nodes: _glow(nodes, _picture(nodes, _file(colorspace=space)).outputs["Color"])))


def _coordinates(nodes, output):
    return nodes.add("ShaderNodeTexCoord").outputs[output]


def _mapped(kind):
    def where(nodes):
        uv = _coordinates(nodes, "Generated")
        fields = {"Rotation": (0.2, 0.1, 0.6), "Scale": (6.0, 9.0, 3.0), "Location": (0.2, 0.3, 0.0)}
        if kind in ("VECTOR", "NORMAL"):
            del fields["Location"]
        if kind == "TEXTURE":
            fields["Scale"] = (0.15, 0.1, 0.4)
        return nodes.add("ShaderNodeMapping", props={"vector_type": kind}, Vector=uv, **fields)

    return where


def _maths(operation, *more):
    def where(nodes):
        scaled = nodes.add(
            "ShaderNodeVectorMath", _coordinates(nodes, "Object"), (0.3, 0.4, 0.5), props={"operation": "MULTIPLY"}
        )
        return nodes.add("ShaderNodeVectorMath", scaled, *more, props={"operation": operation})

    return where


def _distorted(nodes):
    noise = nodes.add("ShaderNodeTexNoise", Vector=_coordinates(nodes, "Generated"), Scale=3.0)
    shift = nodes.add("ShaderNodeVectorMath", noise.outputs["Color"], (0.5, 0.5, 0.5), props={"operation": "SUBTRACT"})
    scaled = nodes.add("ShaderNodeVectorMath", _coordinates(nodes, "UV"), (8.0, 8.0, 8.0), props={"operation": "MULTIPLY"})
    return nodes.add("ShaderNodeVectorMath", scaled, shift, props={"operation": "ADD"})


def _by_channels(nodes):
    parts_ = nodes.add("ShaderNodeSeparateXYZ", _coordinates(nodes, "Object"))
    return nodes.add("ShaderNodeCombineXYZ", parts_.outputs["Y"], parts_.outputs["X"], 0.0)


def _by_numbers(nodes):
    """Cycles follows no arithmetic of numbers: the image is read in full size."""
    parts_ = nodes.add("ShaderNodeSeparateXYZ", _coordinates(nodes, "Object"))
    half = nodes.add("ShaderNodeMath", parts_.outputs["X"], 0.5, props={"operation": "MULTIPLY"})
    return nodes.add("ShaderNodeCombineXYZ", half, 0.3, 0.0)


def _rotated(nodes):
    """Cycles follows no rotation."""
    return nodes.add("ShaderNodeVectorRotate", Vector=_coordinates(nodes, "Object"), Angle=0.5)


def _normal(nodes):
    """Enlarged, so that single texels do not show that normals differ in their last digits."""
    return nodes.add("ShaderNodeVectorMath", _coordinates(nodes, "Normal"), (5.0, 5.0, 5.0), props={"operation": "MULTIPLY"})


_COORDINATES = {
    "generated": lambda nodes: _coordinates(nodes, "Generated"),
    "object": lambda nodes: _coordinates(nodes, "Object"),
    "camera": lambda nodes: _coordinates(nodes, "Camera"),
    "window": lambda nodes: _coordinates(nodes, "Window"),
    "reflection": lambda nodes: _coordinates(nodes, "Reflection"),
    "normal": _normal,
    "position": lambda nodes: nodes.add("ShaderNodeNewGeometry").outputs["Position"],
    "incoming": lambda nodes: nodes.add("ShaderNodeNewGeometry").outputs["Incoming"],
    "point": _mapped("POINT"),
    "texture": _mapped("TEXTURE"),
    "vector": _mapped("VECTOR"),
    "normal_mapping": _mapped("NORMAL"),
    "sine": _maths("SINE"),
    "fraction": _maths("FRACTION"),
    "normalized": _maths("NORMALIZE"),
    "crossed": _maths("CROSS_PRODUCT", (1.0, 2.0, 3.0)),
    "reflected": _maths("REFLECT", (1.0, 2.0, 3.0)),
    "divided": _maths("DIVIDE", (0.3, 0.2, 0.1)),
    "distorted": _distorted,
    "channels": _by_channels,
    "numbers": _by_numbers,
    "rotated": _rotated,
}


@variants(values=_COORDINATES, since=_NEW, bounces=0)
def image_cached_by(scene, where):
    """A ball whose texels are smaller than its pixels."""
    _cache(scene)
    thing = ball(scene, material(lambda nodes: _glow(nodes, _picture(nodes, _file(), where(nodes)).outputs["Color"])))
    thing.rotation_euler = (0.2, 0.3, 0.5)
    scene.world = None
    camera(scene, (0, -3.6, 2.6), (0, 0, 1))


@variants(values={"box": "BOX", "sphere": "SPHERE", "tube": "TUBE"}, since=_NEW, bounces=0)
def image_cached_projection(scene, projection):
    def build(nodes):
        props = {"projection": projection, "projection_blend": 0.3}
        return _glow(nodes, _picture(nodes, _file(), _coordinates(nodes, "Generated"), **props).outputs["Color"])

    _cache(scene)
    ball(scene, material(build)).rotation_euler = (0.2, 0.3, 0.5)
    scene.world = None
    camera(scene, (0, -3.6, 2.6), (0, 0, 1))


@variants(values={"equirectangular": "EQUIRECTANGULAR", "mirror_ball": "MIRROR_BALL"}, since=_NEW, bounces=2)
def image_cached_sky(scene, projection):
    """The camera sees averaged texels; other rays see them as sharp as the map by which Cycles samples them."""
    _cache(scene)

    def build(nodes):
        picture = nodes.add("ShaderNodeTexEnvironment", props={"image": _file("Sky", _texels(1024)), "projection": projection})
        power = nodes.add("ShaderNodeMath", picture.outputs["Color"], 4.0, props={"operation": "POWER"})
        return nodes.add("ShaderNodeBackground", Strength=power)

    world(scene, build)
    ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5)), radius=0.7, location=(-0.9, 0, 0.7))
    ball(scene, shader("ShaderNodeBsdfGlossy", Roughness=0.0), radius=0.7, location=(0.9, 0, 0.7))
    camera(scene, (0, -4.5, 1.6), (0, 0, 0.9))


_SURFACES = {
    "mirror": lambda: shader("ShaderNodeBsdfGlossy", Roughness=0.0),
    "gloss": lambda: shader("ShaderNodeBsdfGlossy", Roughness=0.2),
    "matt": lambda: shader("ShaderNodeBsdfDiffuse"),
    "glass": lambda: shader("ShaderNodeBsdfGlass", Roughness=0.0),
    "rough_glass": lambda: shader("ShaderNodeBsdfGlass", Roughness=0.1),
    "plastic": lambda: shader("ShaderNodeBsdfPrincipled", Roughness=0.1),
    "transparent": lambda: shader("ShaderNodeBsdfTransparent"),
    "wax": lambda: shader("ShaderNodeSubsurfaceScattering", Radius=(0.1, 0.1, 0.1)),
}


@variants(values=_SURFACES, since=_NEW, bounces=4)
def image_cached_seen(scene, surface):
    """A shining wall, in mirrors, through glass and by its light on matt surfaces."""
    _cache(scene)
    glow = material(lambda nodes: _glow(nodes, _picture(nodes, _file()).outputs["Color"]), "Wall")
    wall = parts.place(scene, "Wall", parts.plane_mesh("Wall", 12.0), glow, (0, 3, 0), rotation=(np.pi / 2, 0, 0))
    add_uv(wall.data, 4.0)
    back = parts.place(scene, "Back", parts.plane_mesh("Back", 12.0), glow, (0, -8, 0), rotation=(np.pi / 2, 0, 0))
    add_uv(back.data, 4.0)
    ball(scene, surface())
    scene.world = None
    camera(scene, (0, -4.2, 1.6), (0, 0, 1))


@case(since=_NEW, bounces=0)
def image_cached_packed(scene):
    """A packed image has no file: Cycles reads it in full size."""
    image = images.image("Packed", _texels(128), "Non-Color")
    _field(scene, material(lambda nodes: _glow(nodes, _picture(nodes, image).outputs["Color"])))


@case(since=_NEW, bounces=0)
def image_cached_not_made(scene):
    """Cycles makes no file of the cache: it reads the image in full size."""
    _field(scene, material(lambda nodes: _glow(nodes, _picture(nodes, _file(pixels=_texels(128))).outputs["Color"])))
    scene.render.use_auto_generate_texture_cache = False


@case(since=_NEW, bounces=0)
def image_cached_before(scene):
    """The file of the cache is there from an earlier render: Cycles reads it though it would make none."""
    surface = material(lambda nodes: _glow(nodes, _picture(nodes, _file("Before")).outputs["Color"]))
    _field(scene, surface)
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x = scene.render.resolution_y = 8
    bpy.ops.render.render()
    scene.render.use_auto_generate_texture_cache = False


@case(since=_NEW, bounces=0)
def image_cached_tiles(scene):
    stem = os.path.join(bpy.app.tempdir, "Tiled.")
    for number in (1001, 1002):
        image_files.write("PNG", f"{stem}{number}", _texels(256, number)[..., :3])
    image = bpy.data.images.load(f"{stem}1001.png")
    image.source, image.filepath = "TILED", f"{stem}<UDIM>.png"
    image.colorspace_settings.name = "Non-Color"
    if 1002 not in [tile.number for tile in image.tiles]:
        image.tiles.new(1002)

    def build(nodes):
        where = nodes.add("ShaderNodeMapping", Vector=_coordinates(nodes, "UV"), Scale=(2.0, 1.0, 1.0))
        return _glow(nodes, _picture(nodes, image, where).outputs["Color"])

    _field(scene, material(build), size=12.0, repeats=1.0)


@case(since=_NEW, bounces=2)
def image_cached_normal_map(scene):
    """Levels of normals are flatter: the mirrored sky shows their slope."""

    def build(nodes):
        pixels = _texels(512)
        pixels[..., :2] = 0.5 + 0.25 * (np.random.default_rng(4).uniform(0.0, 1.0, (512, 512, 2)) - 0.5)
        pixels[..., 2] = 1.0
        picture = _picture(nodes, _file("Normals", pixels))
        normal = nodes.add("ShaderNodeNormalMap", Color=picture.outputs["Color"])
        return nodes.add("ShaderNodeBsdfGlossy", Roughness=0.3, Normal=normal)

    _field(scene, material(build), size=12.0, repeats=2.0)
    sky(scene, (0.2, 0.2, 0.2), 1.0)
    parts.add_light(scene, "Lamp", "POINT", 300.0, (1, 2, 3), shadow_soft_size=0.3)


@case(since=_NEW, bounces=2)
def image_cached_bump(scene):
    def build(nodes):
        picture = _picture(nodes, _file("Heights"))
        normal = nodes.add("ShaderNodeBump", Strength=0.3, Distance=0.02, Height=picture.outputs["Color"])
        return nodes.add("ShaderNodeBsdfDiffuse", Normal=normal)

    _field(scene, material(build), size=12.0, repeats=1.0)
    parts.add_light(scene, "Lamp", "SUN", 3.0, (3, 2, 2))


@case(since=_NEW, bounces=1, transparent_bounces=4)
def image_cached_holes(scene):
    """Holes by an image, and their shadow."""
    _cache(scene)

    def build(nodes):
        pixels = _texels()
        pixels[..., 3] = np.random.default_rng(5).uniform(0.0, 1.0, pixels.shape[:2])
        picture = _picture(nodes, _file("Holes", pixels))
        power = nodes.add("ShaderNodeMath", picture.outputs["Alpha"], 3.0, props={"operation": "POWER"})
        mix = nodes.add("ShaderNodeMixShader", power)
        nodes.link(nodes.add("ShaderNodeBsdfTransparent"), mix.inputs[1])
        nodes.link(nodes.add("ShaderNodeBsdfDiffuse", Color=(0.7, 0.3, 0.2)), mix.inputs[2])
        return mix

    thing = parts.place(scene, "Veil", parts.plane_mesh("Veil", 3.0), material(build), (0, 0, 1.2), rotation=(0.3, 0.1, 0.0))
    add_uv(thing.data, 2.0)
    parts.place(scene, "Floor", parts.plane_mesh("Floor", 8.0), shader("ShaderNodeBsdfDiffuse"))
    parts.add_light(scene, "Lamp", "POINT", 300.0, (1, -2, 4), shadow_soft_size=0.5)
    scene.world = None
    camera(scene)


@case(since=_NEW, bounces=0)
def image_cached_displacement(scene):
    """A surface moved by a level as coarse as its triangles."""
    _cache(scene)

    def build(nodes):
        where = nodes.add("ShaderNodeNewGeometry").outputs["Position"]
        height = _picture(nodes, _file("Heights")).outputs["Color"]
        power = nodes.add("ShaderNodeMath", height, 4.0, props={"operation": "POWER"})
        moved = nodes.add("ShaderNodeDisplacement", Height=power, Midlevel=0.0, Scale=1.0)
        lift = nodes.add("ShaderNodeSeparateXYZ", where).outputs["Z"]
        return nodes.add("ShaderNodeEmission", Strength=lift), moved

    surface = material(build)
    displace(surface, "DISPLACEMENT")
    mesh = parts.mesh_from_points(
        "Grid",
        [(0.1 * x - 2.0, 0.1 * y - 2.0, 0.0) for y in range(41) for x in range(41)],
        [(y * 41 + x, y * 41 + x + 1, y * 41 + x + 42, y * 41 + x + 41) for y in range(40) for x in range(40)],
    )
    thing = parts.place(scene, "Grid", mesh, surface)
    add_uv(thing.data)
    scene.world = None
    camera(scene, (0, -2.0, 6.0), (0, 0, 0))


@case(since=_NEW, bounces=0)
def image_cached_orthographic(scene):
    _field(scene, material(lambda nodes: _glow(nodes, _picture(nodes, _file()).outputs["Color"])), size=8.0, repeats=2.0)
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 6.0


@case(since=_NEW, bounces=0)
def image_cached_panorama(scene):
    _field(scene, material(lambda nodes: _glow(nodes, _picture(nodes, _file()).outputs["Color"])))
    scene.camera.data.type, scene.camera.data.panorama_type = "PANO", "EQUIRECTANGULAR"
