"""The sky: uniform, an image, rotated, with a sun of one pixel, and none."""

import bpy
import numpy as np

from .. import parts
from . import images
from .catalogue import case, variants
from .nodes import shader, world
from .stages import ball, camera, floor


def _things(scene, mirror=True):
    """A matt and a mirroring ball on a floor, with much of the sky in view."""
    floor(scene, size=6.0)
    ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5)), radius=0.7, location=(-0.9, 0, 0.7))
    if mirror:
        steel = shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.0)
        ball(scene, steel, radius=0.7, location=(0.9, 0, 0.7))
    camera(scene, (0, -4.5, 1.6), (0, 0, 0.9))


@variants(values={"plain": (1.0, {"quick": True}), "strong": 3.0})
def world_color(scene, strength):
    _things(scene)
    world(scene, lambda nodes: nodes.add("ShaderNodeBackground", Color=(0.3, 0.5, 0.9), Strength=strength))


@case(bounces=1)
def world_none(scene):
    """Without a sky, only the lamp emits."""
    _things(scene, mirror=False)
    scene.world = None
    parts.add_light(scene, "Lamp", "POINT", 200.0, (1, -2, 3), shadow_soft_size=0.3)


@case(bounces=1)
def world_without_surface(scene):
    _things(scene, mirror=False)
    result = bpy.data.worlds.new("World")
    parts.enable_nodes(result).nodes.new("ShaderNodeOutputWorld")
    scene.world = result
    parts.add_light(scene, "Lamp", "POINT", 200.0, (1, -2, 3), shadow_soft_size=0.3)


def _heaven(width=64, height=32, sun=0.0):
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    pixels = np.ones((height, width, 4))
    pixels[..., 0] = 0.2 + 0.8 * y
    pixels[..., 1] = 0.3 + 0.3 * np.cos(2 * np.pi * x) ** 2
    pixels[..., 2] = 0.9 - 0.5 * np.sin(np.pi * y) * (x > 0.5)
    if sun:
        pixels[int(0.7 * height), int(0.6 * width), :3] = sun
    return images.image("Heaven", pixels, images.LINEAR, is_float=True, pack=False)


def _pictured(scene, image, rotation=None, projection="EQUIRECTANGULAR", strength=1.0, scale=(1, 1, 1)):
    def build(nodes):
        picture = nodes.add("ShaderNodeTexEnvironment", props={"image": image, "projection": projection})
        if rotation is not None:
            where = nodes.add("ShaderNodeTexCoord").outputs["Generated"]
            nodes.link(nodes.add("ShaderNodeMapping", Vector=where, Rotation=rotation, Scale=scale), picture.inputs["Vector"])
        return nodes.add("ShaderNodeBackground", Color=picture.outputs["Color"], Strength=strength)

    world(scene, build)


@case(bounces=1)
def world_and_lamp_hidden_from_shadows(scene):
    floor(scene, size=6.0)
    thing = ball(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5)))
    thing.visible_shadow = False
    _pictured(scene, _heaven())
    parts.add_light(scene, "Lamp", "POINT", 200.0, (1, -2, 3), shadow_soft_size=0.5)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


@case(quick=True)
def world_equirectangular(scene):
    _things(scene)
    _pictured(scene, _heaven())


@variants(values={"turned": (0.0, 0.0, 1.1), "tipped": (0.7, 0.4, 1.9)})
def world_mapping(scene, rotation):
    _things(scene)
    _pictured(scene, _heaven(), rotation)


@case()
def world_mapping_scaled(scene):
    _things(scene)
    _pictured(scene, _heaven(), (0.2, 0.0, 0.5), scale=(1.0, 2.0, 0.7))


@case()
def world_hot_pixel(scene):
    """One pixel of the sky gives most of the light."""
    _things(scene, mirror=False)
    _pictured(scene, _heaven(128, 64, sun=2000.0), (0.0, 0.0, 0.8))


@case(quick=True, bounces=1)
def world_on_coarse_shapes(scene):
    """Smooth cones of few faces under a sky with a bright spot: their normals let light shine from behind the faces."""
    spot = np.full((8, 16, 4), 0.2)
    spot[5, 3, :3] = spot[2, 12, :3] = 8.0
    image = images.image("Spot", spot, images.LINEAR, is_float=True, pack=False)
    _pictured(scene, image)
    matt, gloss = shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.7, 0.6)), shader("ShaderNodeBsdfGlossy", Roughness=0.5)
    for number, material in enumerate((matt, gloss)):
        mesh = parts.lathe_mesh(f"Cone {number}", [(0.0, -1.0), (1.0, -1.0), (0.0, 1.0)], segments=6)
        parts.place(scene, f"Cone {number}", mesh, material, (2.2 * number - 1.1, 0, 0), rotation=(0.3, 0.2, 0.4))
    camera(scene, (0, -5.5, 1.6), (0, 0, 0))


@case()
def world_mirror_ball(scene):
    _things(scene)
    _pictured(scene, _heaven(32, 32), projection="MIRROR_BALL")


@case()
def world_seam_and_pole(scene):
    """Views of the zenith and the seam of an image with few texels: interpolation across the borders."""
    scene.world = None
    _pictured(scene, _heaven(8, 4), strength=0.8)
    camera(scene, (0, 0, 0), (-0.4, 0.02, 1), lens=10.0)


@variants(values={name: name for name in ("camera", "diffuse", "glossy", "transmission", "shadow")})
def world_invisible_to(scene, ray):
    """The sky hidden from one kind of ray. The switch for shadows has no effect: the sky casts no shadow."""
    _things(scene)
    glass = shader("ShaderNodeBsdfRefraction", Color=(1, 1, 1), Roughness=0.0, IOR=1.3)
    parts.place(scene, "Pane", parts.plane_mesh("Pane", 1.2), glass, (0, -0.9, 0.9), rotation=(1.4, 0, 0))
    world(scene, lambda nodes: nodes.add("ShaderNodeBackground", Color=(0.3, 0.5, 0.9), Strength=1.0))
    setattr(scene.world.cycles_visibility, ray, False)


@case()
def world_nodes_computed(scene):
    _things(scene)

    def build(nodes):
        color = nodes.add("ShaderNodeRGB")
        color.outputs[0].default_value = (1.0, 0.7, 0.5, 1.0)
        return nodes.add("ShaderNodeBackground", Color=color, Strength=nodes.add("ShaderNodeMath", 0.3, 0.4))

    world(scene, build)


_GLASS = {
    "glass": ("ShaderNodeBsdfGlass", {"Roughness": 0.0}),
    "rough": ("ShaderNodeBsdfGlass", {"Roughness": 0.4}),
    "refraction": ("ShaderNodeBsdfRefraction", {"Roughness": 0.0}),
    "principled": ("ShaderNodeBsdfPrincipled", {"Roughness": 0.1, "Transmission_Weight": 1.0}),
}


def _missing(nodes):
    picture = nodes.add("ShaderNodeTexEnvironment")
    image = bpy.data.images.new("Lost", 4, 4)
    image.source, image.filepath = "FILE", "//nowhere.hdr"
    picture.image = image
    return picture


_SKIES = {
    "plain": lambda nodes: (0.9, 0.1, 0.9),
    "missing": _missing,
    "empty": lambda nodes: nodes.add("ShaderNodeTexEnvironment"),
    "pictured": lambda nodes: nodes.add("ShaderNodeTexEnvironment", props={"image": _even()}),
}


def _even():
    """Returns an image of one colour."""
    return images.image("Even", np.tile((0.9, 0.1, 0.9, 1.0), (4, 8, 1)), images.LINEAR, is_float=True, pack=False)


@variants(
    "LOBES",
    values={
        f"{kind}_{sky}": (kind, sky) for kind in _GLASS for sky in _SKIES if sky in ("plain", "missing") or kind == "glass"
    },
    bounces=4,
)
def world_glass_without_shadow(scene, choice):
    """A sampled sky behind glass without shadows: light samples pass the glass, in addition to refracted light."""
    kind, sky = choice
    floor(scene, size=6.0)
    node, inputs = _GLASS[kind]
    ball(scene, shader(node, **inputs), radius=0.8, location=(0, 0, 0.8)).visible_shadow = False
    world(scene, lambda nodes: nodes.add("ShaderNodeBackground", Color=_SKIES[sky](nodes)))
    scene.world.cycles.sampling_method, scene.world.cycles.sample_map_resolution = "MANUAL", 64
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.6), lens=60.0)
