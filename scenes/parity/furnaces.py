"""Every lobe in an even white light: one picture of five angles (from left) by four roughnesses (from below)."""

import math

from mathutils import Euler, Vector

from .. import parts
from .catalogue import case, variants
from .nodes import shader, with_node, with_socket

_ANGLES = (0, 20, 45, 65, 80)
_ROUGHNESS = (0.1, 0.3, 0.6, 1.0)
_TILES = {roughness: _ANGLES for roughness in _ROUGHNESS}
# Under this name the node of all glossy lobes exists in every version.
_GLOSSY = "ShaderNodeBsdfAnisotropic"
_PRINCIPLED = "ShaderNodeBsdfPrincipled"


def _size(tiles):
    return 16 * max(len(angles) for angles in tiles.values()), 16 * len(tiles)


_SIZE = _size(_TILES)


def _furnace(scene, make, tiles=_TILES):
    """make(roughness) gives a material; tiles tells the angles of each roughness.

    The plates fill the tiles of an orthographic picture, and stand so far behind one another that they hardly meet. Where a
    row has fewer of them the sky shows.
    """
    columns, rows = max(len(angles) for angles in tiles.values()), len(tiles)
    for row, (roughness, angles) in enumerate(tiles.items()):
        surface = make(roughness)
        for column, angle in enumerate(angles):
            turn = math.radians(angle)
            # Stretched by what leaning shortens it.
            plate = parts.place(
                scene,
                f"Plate {angle} {roughness}",
                parts.plane_mesh("Plate", 1.0),
                surface,
                Vector((column + 0.5, row + 0.5, -50.0 * (column + row * columns))),
                (1.0, 1.0 / math.cos(turn), 1.0),
            )
            plate.rotation_euler = Euler((turn, 0, 0))
    parts.set_world(scene, (1, 1, 1))
    eye = parts.add_camera(scene, (columns / 2, rows / 2, 20), (columns / 2, rows / 2, 0))
    eye.rotation_euler = (0, 0, 0)
    eye.data.type, eye.data.ortho_scale, eye.data.clip_end = "ORTHO", max(columns, rows), 5000.0


_CLOSURES = {
    "diffuse": ("ShaderNodeBsdfDiffuse", {}, {"Color": (0.8, 0.8, 0.8)}),
    "ggx": (_GLOSSY, {"distribution": "GGX"}, {"Anisotropy": 0.0, "Color": (0.8, 0.8, 0.8)}),
    "beckmann": (_GLOSSY, {"distribution": "BECKMANN"}, {"Anisotropy": 0.0, "Color": (0.8, 0.8, 0.8)}),
    "multiple": (_GLOSSY, {"distribution": "MULTI_GGX"}, {"Anisotropy": 0.0, "Color": (0.8, 0.5, 0.2)}),
    "glass": ("ShaderNodeBsdfGlass", {"distribution": "GGX"}, {"Color": (0.8, 0.8, 0.8), "IOR": 1.5}),
    "glass_multiple": ("ShaderNodeBsdfGlass", {"distribution": "MULTI_GGX"}, {"Color": (0.8, 0.8, 0.8), "IOR": 1.5}),
    "glass_beckmann": ("ShaderNodeBsdfGlass", {"distribution": "BECKMANN"}, {"Color": (0.8, 0.8, 0.8), "IOR": 1.5}),
    "refraction": ("ShaderNodeBsdfRefraction", {"distribution": "GGX"}, {"Color": (0.8, 0.8, 0.8), "IOR": 1.5}),
    "refraction_beckmann": ("ShaderNodeBsdfRefraction", {"distribution": "BECKMANN"}, {"Color": (0.8, 0.8, 0.8), "IOR": 1.5}),
    "metallic": ("ShaderNodeBsdfMetallic", {}, {"Base_Color": (0.9, 0.6, 0.3), "Edge_Tint": (0.4, 0.6, 0.9)}),
    "metallic_physical": (
        "ShaderNodeBsdfMetallic",
        {"fresnel_type": "PHYSICAL_CONDUCTOR"},
        {"IOR": (0.18, 0.42, 1.37), "Extinction": (3.42, 2.35, 1.77)},
    ),
    "sheen": ("ShaderNodeBsdfSheen", {}, {"Color": (0.8, 0.8, 0.8)}),
    "anisotropic": (_GLOSSY, {"distribution": "GGX"}, {"Anisotropy": 0.7, "Rotation": 0.1, "Color": (0.8, 0.8, 0.8)}),
    "anisotropic_beckmann": (_GLOSSY, {"distribution": "BECKMANN"}, {"Anisotropy": 0.7, "Color": (0.8, 0.8, 0.8)}),
    "anisotropic_multiple": (_GLOSSY, {"distribution": "MULTI_GGX"}, {"Anisotropy": -0.6, "Color": (0.8, 0.5, 0.2)}),
}


# Where Cycles' fit of Beckmann's masking shows: for smoother surfaces and steeper angles it is exact.
_FITTED = {0.3: (80,), 0.6: (65, 80), 1.0: (45, 65, 80)}
_EXACT = {roughness: tuple(a for a in _ANGLES if a not in _FITTED.get(roughness, ())) for roughness in _ROUGHNESS}
_WALTER = {
    "limit": (0.003, 0.0035),
    "reason": "Cycles divides by the chance of a facet as Walter's fit of the masking tells it, which is up to 0.31 % off; "
    "ours is the one that the facets are really drawn with",
}


_DRAWN_WITHOUT_MASK = (
    "Cycles 3 draws stretched facets of Beckmann as if none were hidden: brighter under a sky. Under a sun both agree "
    "(sun_on_anisotropic_beckmann)"
)
_WALK = (
    "Cycles 3 walks from facet to facet at random; the compensated lobe of Blender 4 stands in, and does not know the stretch"
)
_WALK_TOLD = "Multiscatter GGX is computed as in Blender 4"
_TABLE = (
    "Cycles 3 draws Beckmann's facets by a table that it interpolates, up to 0.74 % off under a sky; under a sun both agree "
    "(sun_on_beckmann)"
)
_TABLE3 = {"blender3": ((0.003, 0.008), _TABLE)}
# What Blender 3 does differently: in the furnace, and in both parts of Beckmann's.
_BLENDER3 = {
    "multiple": {"blender3": ((0.065, 0.64), _WALK, _WALK_TOLD)},
    "glass_multiple": {"blender3": ((0.034, 0.36), _WALK, _WALK_TOLD)},
    "anisotropic_multiple": {"blender3": ((0.105, 0.49), _WALK, _WALK_TOLD)},
}
_EXACT3 = {"anisotropic_beckmann": {"blender3": ((0.07, 0.30), _DRAWN_WITHOUT_MASK)}}
_FITTED3 = {
    "anisotropic_beckmann": {"blender3": ((0.14, 0.70), _DRAWN_WITHOUT_MASK)},
    "beckmann": _TABLE3,
    "glass_beckmann": _TABLE3,
    "refraction_beckmann": _TABLE3,
}


def _closures(names, tiles, blender3, **fields):
    """Their values with the fields that each scene has of its own."""
    fields["size"] = _size(tiles)
    return {
        name: (_CLOSURES[name], {"needs": with_node(_CLOSURES[name][0]), **fields, **blender3.get(name, {})}) for name in names
    }


_BECKMANN = tuple(name for name in _CLOSURES if "beckmann" in name)


def _closure(scene, value, tiles):
    kind, props, inputs = value
    _furnace(scene, lambda roughness: shader(kind, props, Roughness=roughness, **inputs), tiles)


@variants("FURNACE", values=_closures([name for name in _CLOSURES if name not in _BECKMANN], _TILES, _BLENDER3), bounces=1)
def furnace(scene, value):
    _closure(scene, value, _TILES)


@variants("FURNACE", values=_closures(_BECKMANN, _EXACT, _EXACT3), bounces=1)
def furnace_exact(scene, value):
    _closure(scene, value, _EXACT)


@variants("FURNACE", values=_closures(_BECKMANN, _FITTED, _FITTED3, **_WALTER), bounces=1)
def furnace_fitted(scene, value):
    _closure(scene, value, _FITTED)


@variants(
    "EXACT",
    values={
        "beckmann": _CLOSURES["beckmann"],
        "anisotropic_beckmann": _CLOSURES["anisotropic_beckmann"],
        "principled_coat": (_PRINCIPLED, {}, {"Base_Color": (0.8, 0.5, 0.2), "Coat_Weight": 1.0}),
    },
    size=_SIZE,
    bounces=0,
)
def sun_on(scene, value):
    """The same plates, lit from one direction only: what a lobe is worth, whoever draws it."""
    _closure(scene, value, _TILES)
    parts.set_world(scene, (0, 0, 0))
    light = parts.add_light(scene, "Sun", "SUN", math.pi, (0, 0, 30), angle=0.0)
    light.rotation_euler = Euler((0.9, 0.4, 0))
    for thing in scene.objects:
        if thing.type == "MESH":
            thing.visible_shadow = False


# Where velvet reflects a ten thousandth of the light and less, too few samples meet it to tell its albedo.
_VELVET = {0.1: _ANGLES[-1:], 0.3: _ANGLES[-2:], 0.6: _ANGLES, 1.0: _ANGLES}


@case("FURNACE", size=_size(_VELVET), bounces=1, since=(4, 0))
def furnace_sheen_ashikhmin(scene):
    props = {"distribution": "ASHIKHMIN"}
    _furnace(scene, lambda r: shader("ShaderNodeBsdfSheen", props, Roughness=r, Color=(0.8, 0.8, 0.8)), _VELVET)


@case("FURNACE", size=_size({1.0: _ANGLES}), bounces=1)
def furnace_translucent(scene):
    _furnace(scene, lambda _: shader("ShaderNodeBsdfTranslucent", Color=(0.8, 0.8, 0.8)), {1.0: _ANGLES})


# Seen from the denser side smooth surfaces reflect all light beyond 50 degrees; the last angle shows what facets still pass.
_SAME_SIDE = (
    "Cycles 3 counts refraction that ends on the viewer's side of the surface, too, which light inside a glass cannot do"
)
_INSIDE = {0.1: _ANGLES[:3], 0.3: _ANGLES[:3], 0.6: _ANGLES[:4], 1.0: _ANGLES}
_INSIDE_EXACT = {roughness: tuple(a for a in angles if a in _EXACT[roughness]) for roughness, angles in _INSIDE.items()}
_INSIDE_FITTED = {0.6: (65,), 1.0: (45, 65, 80)}


def _inside(scene, kind, distribution, tiles):
    _furnace(scene, lambda r: shader(kind, {"distribution": distribution}, Roughness=r, Color=(1, 1, 1), IOR=1.3), tiles)
    for thing in scene.objects:
        if thing.type == "MESH":
            thing.data.flip_normals()


@variants(
    "FURNACE",
    values={
        "glass": ("ShaderNodeBsdfGlass", {"blender3": ((0.003, 0.006), _SAME_SIDE)}),
        "refraction": ("ShaderNodeBsdfRefraction", {"blender3": ((0.018, 0.26), _SAME_SIDE)}),
    },
    size=_size(_INSIDE),
    bounces=1,
)
def furnace_inside(scene, kind):
    _inside(scene, kind, "GGX", _INSIDE)


@variants(
    "FURNACE",
    values={
        "exact": (_INSIDE_EXACT, {"size": _size(_INSIDE_EXACT), "blender3": ((0.003, 0.012), _SAME_SIDE)}),
        "fitted": (_INSIDE_FITTED, {"size": _size(_INSIDE_FITTED), "blender3": ((0.19, 0.86), _SAME_SIDE), **_WALTER}),
    },
    bounces=1,
)
def furnace_inside_beckmann(scene, tiles):
    _inside(scene, "ShaderNodeBsdfRefraction", "BECKMANN", tiles)


_PHONG = {0.1: _ANGLES, 0.3: _ANGLES, 0.6: _ANGLES[:-1], 1.0: _ANGLES[:-2]}
_PHONG_GRAZING = {0.6: _ANGLES[-1:], 1.0: _ANGLES[-2:]}


def _phong(scene, tiles):
    inputs = {"Anisotropy": 0.0, "Color": (0.8, 0.8, 0.8)}
    _furnace(scene, lambda r: shader(_GLOSSY, {"distribution": "ASHIKHMIN_SHIRLEY"}, Roughness=r, **inputs), tiles)


@case("FURNACE", size=_size(_PHONG), bounces=1)
def furnace_ashikhmin(scene):
    _phong(scene, _PHONG)


@case(
    "FURNACE",
    size=_size(_PHONG_GRAZING),
    bounces=1,
    limit=(0.16, 0.42),
    reason="Cycles' sampler of this lobe mirrors about half vectors that face away, which brightens rough surfaces at grazing "
    "angles under a sky; the values agree, as under lamps, and ours is their integral",
)
def furnace_ashikhmin_grazing(scene):
    _phong(scene, _PHONG_GRAZING)


_CLEAR_COAT = (
    "Cycles 3 weighs what the base throws by a chance of the clear coat that its sampler does not have, and loses a part of it "
    "under a sky; under a sun both agree (sun_on_principled_coat)"
)
_INPUTS = {
    "default": {},
    "metal": {"Metallic": 1.0},
    "half_metal": {"Metallic": 0.5},
    "black": {"Base_Color": (0.0, 0.0, 0.0)},
    "glass": {"Transmission_Weight": 1.0},
    "half_glass": {"Transmission_Weight": 0.5},
    "coat": ({"Coat_Weight": 1.0}, {"blender3": ((0.033, 0.065), _CLEAR_COAT)}),
    "specular": {"Specular_IOR_Level": 1.0},
    "anisotropic": {"Metallic": 1.0, "Anisotropic": 0.7},
}


@variants("FURNACE", values=_INPUTS, size=_SIZE, bounces=1)
def furnace_principled(scene, inputs):
    inputs = {"Base_Color": (0.8, 0.5, 0.2), **inputs}
    _furnace(scene, lambda roughness: shader(_PRINCIPLED, Roughness=roughness, **inputs))


@case("FURNACE", size=_SIZE, bounces=1, needs=with_socket(_PRINCIPLED, "Sheen Roughness"))
def furnace_principled_sheen(scene):
    _furnace(
        scene,
        lambda roughness: shader(
            _PRINCIPLED, Base_Color=(0.2, 0.2, 0.2), Sheen_Weight=1.0, Sheen_Roughness=roughness, Specular_IOR_Level=0.0
        ),
    )


@case("FURNACE", size=_SIZE, bounces=1, needs=with_socket(_PRINCIPLED, "Coat Roughness"))
def furnace_principled_coat_roughness(scene):
    _furnace(
        scene, lambda roughness: shader(_PRINCIPLED, Base_Color=(0.8, 0.5, 0.2), Coat_Weight=1.0, Coat_Roughness=roughness)
    )
