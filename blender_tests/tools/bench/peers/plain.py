"""Materials, textures and the world of a snapshot, reduced to the models that all renderers share."""

from dataclasses import dataclass

import numpy as np

from addon.bindings.enums import (
    AlphaMode,
    Coordinate,
    Environment,
    LobeKind,
    MathOperation,
    NodeKind,
    Projection,
    Transfer,
)
from addon.bindings.shading import NodeRef

from . import Cannot

_IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@dataclass(frozen=True)
class Texture:
    """An image at the mesh's UV coordinates, repeated."""

    image: int


@dataclass(frozen=True)
class Surface:
    """model: "diffuse", "principled", "glass" (smooth), "mirror" (smooth, coloured), "course" (Kd, Ks) or "black"."""

    model: str
    color: object = (0.8, 0.8, 0.8)  # three numbers, or a Texture
    metallic: float = 0.0
    roughness: float = 0.5  # Blender's: alpha is its square
    ior: float = 1.5
    transmission: float = 0.0
    emission: tuple = (0.0, 0.0, 0.0)
    cut_out: Texture | None = None  # where its alpha is below 1, light passes through
    specular: tuple = (0.0, 0.0, 0.0)  # Ks of the course's model


def read_surface(material):
    """Return a material of a single lobe as a Surface; raises Cannot for all others."""
    who = f"material '{material.name}'"
    if any(_number(value, who) != 0.0 for value in (material.holdout,)) or material.displacement != (0.0, 0.0, 0.0):
        raise Cannot(f"{who} is a holdout or displaced")
    if material.normal != (0.0, 0.0, 0.0):
        raise Cannot(f"{who} has a bump or normal map")
    emission = _color(material.emission, who)
    cut_out = _cut_out(material, who)
    if not material.lobes:
        return Surface("black", emission=emission, cut_out=cut_out)
    if len(material.lobes) > 1:
        return _course(material, who)
    lobe = material.lobes[0]
    if (
        isinstance(lobe.weight, NodeRef)
        and cut_out is None
        or not isinstance(lobe.weight, NodeRef)
        and set(lobe.weight) != {1.0}
    ):
        raise Cannot(f"{who} is part of a mix")
    common = {"emission": emission, "cut_out": cut_out}
    if lobe.kind == LobeKind.PRINCIPLED:
        return _principled(lobe.principled, material, who, common)
    color = _color_or_texture(lobe.color, material, who)
    if lobe.kind == LobeKind.LAMBERT or lobe.kind == LobeKind.DIFFUSE and lobe.roughness == 0.0:
        return Surface("diffuse", color, **common)
    if lobe.kind == LobeKind.GLASS and lobe.roughness == 0.0:
        return Surface("glass", color, ior=_number(lobe.ior, who), **common)
    if lobe.kind in (LobeKind.GLOSSY, LobeKind.MIRROR) and lobe.roughness == 0.0:
        return Surface("mirror", color, **common)
    if lobe.kind == LobeKind.GLOSSY:
        return Surface("principled", color, metallic=1.0, roughness=_number(lobe.roughness, who), **common)
    raise Cannot(f"{who} has a lobe of kind {LobeKind(lobe.kind).name}")


def _principled(values, material, who, common):
    for name in ("anisotropic", "coat", "sheen", "diffuse_roughness"):
        if _number(getattr(values, name), who) != 0.0:
            raise Cannot(f"{who} uses {name}")
    common["emission"] = tuple(a + b for a, b in zip(common["emission"], _color(values.emission, who), strict=True))
    color = _color_or_texture(values.base_color, material, who)
    metallic, roughness = _number(values.metallic, who), _number(values.roughness, who)
    transmission, specular = _number(values.transmission, who), _number(values.specular, who)
    if metallic == 0.0 and transmission == 0.0 and specular == 0.0:
        return Surface("diffuse", color, **common)
    if roughness == 0.0 and metallic == 1.0:
        return Surface("mirror", color, **common)
    if roughness == 0.0 and transmission == 1.0 and metallic == 0.0:
        return Surface("glass", color, ior=_number(values.ior, who), **common)
    if specular != 0.5:
        raise Cannot(f"{who} has a Specular IOR Level of {specular:g}")
    ior = _number(values.ior, who)
    return Surface("principled", color, metallic, roughness, ior, transmission, **common)


def _course(material, who):
    """Return Kd and Ks of the course: a Lambert lobe, and the specular lobes."""
    kinds = {lobe.kind for lobe in material.lobes}
    matt = [lobe for lobe in material.lobes if lobe.kind == LobeKind.LAMBERT]
    shiny = [lobe for lobe in material.lobes if lobe.kind == LobeKind.BECKMANN]
    if not kinds <= {LobeKind.LAMBERT, LobeKind.BECKMANN, LobeKind.MIRROR} or len(matt) != 1 or len(shiny) != 1:
        raise Cannot(f"{who} mixes {len(material.lobes)} lobes")
    # The course's roughness is alpha, not its square root.
    roughness = _number(shiny[0].roughness, who) ** 0.5
    ior = _number(shiny[0].ior, who)
    return Surface("course", matt[0].color, roughness=roughness, ior=ior, specular=shiny[0].color)


def _number(value, who):
    if isinstance(value, NodeRef):
        raise Cannot(f"{who} takes a number from nodes")
    return float(value)


def _color(value, who):
    if isinstance(value, NodeRef):
        raise Cannot(f"{who} shines with a texture")
    return tuple(value)


def _color_or_texture(value, material, who):
    return _texture(value.node, material.nodes, who) if isinstance(value, NodeRef) else tuple(value)


def _texture(number, nodes, who):
    node = nodes[number]
    plain = node.kind == NodeKind.IMAGE and node.option == Projection.FLAT and node.image_count == 1
    source = nodes[node.inputs[0].node] if plain and isinstance(node.inputs[0], NodeRef) else None
    if source is None or source.kind != NodeKind.COORDINATE or source.option != Coordinate.UV or source.name:
        raise Cannot(f"{who} has nodes beside an image on the UV map")
    return Texture(node.image)


def _cut_out(material, who):
    """Return the texture whose alpha cuts out the surface: transparency is 1 - alpha."""
    passed = material.transmittance
    if not isinstance(passed, NodeRef):
        if set(passed) != {0.0}:
            raise Cannot(f"{who} is transparent")
        return None
    nodes = material.nodes
    rest = nodes[passed.node]
    if rest.kind == NodeKind.MATH and rest.option == MathOperation.SUBTRACT and rest.inputs[0] == 1.0:
        alpha = nodes[rest.inputs[1].node] if isinstance(rest.inputs[1], NodeRef) else None
        # A node that adds 0 clamps.
        if alpha is not None and alpha.kind == NodeKind.MATH and alpha.option == MathOperation.ADD and alpha.inputs[1] == 0.0:
            alpha = nodes[alpha.inputs[0].node] if isinstance(alpha.inputs[0], NodeRef) else None
        if alpha is not None and alpha.kind == NodeKind.ALPHA:
            return _texture(alpha.inputs[0].node, nodes, who)
    raise Cannot(f"{who} is transparent by nodes")


def read_world(world):
    """Return (radiance, None), or (None, image number) of an equirectangular image without rotation."""
    if world.hidden_from:
        raise Cannot("the world is hidden from some rays")
    if not isinstance(world.radiance, NodeRef):
        return tuple(world.radiance), None
    node = world.nodes[world.radiance.node]
    if node.kind == NodeKind.ENVIRONMENT and node.option == Environment.EQUIRECTANGULAR and node.image_count == 1:
        source = world.nodes[node.inputs[0].node]
        if source.kind == NodeKind.COORDINATE and source.matrix == _IDENTITY:
            return None, node.image
    raise Cannot("the world has nodes beside one equirectangular image")


def texels(image):
    """Return linear floats (height, width, channels); row 0 is the bottom row."""
    values = image.texels.astype(np.float32)
    if image.texels.dtype != np.float32:
        values /= float(np.iinfo(image.texels.dtype).max)
    if image.transfer == Transfer.SRGB:
        color = values[..., :3]
        values[..., :3] = np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)
    if image.alpha == AlphaMode.NONE:
        values = values[..., :3]
    return values


def is_black(color):
    return not isinstance(color, Texture) and not any(color)
