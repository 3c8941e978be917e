"""Every closure's lobe under a uniform white sky, at five angles and four roughnesses."""

import math
from types import MappingProxyType

import bpy
from mathutils import Euler

from .. import parts
from .catalogue import case, variants
from .nodes import shader, with_node
from .plates import ANGLES, ROUGHNESS, SIZE, TILES, set_plates, size_of
from .reasons import BECKMANN3, WALK3, WALK3_TOLD

# Under this name the node of all glossy lobes exists in every version.
_GLOSSY = "ShaderNodeBsdfAnisotropic"
_PRINCIPLED = "ShaderNodeBsdfPrincipled"

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


# Angles at which Cycles' fit of Beckmann's masking deviates: for smoother surfaces and steeper angles it is exact.
_FITTED = {0.3: (80,), 0.6: (65, 80), 1.0: (45, 65, 80)}
_EXACT = {roughness: tuple(a for a in ANGLES if a not in _FITTED.get(roughness, ())) for roughness in ROUGHNESS}
_WALTER = {
    "limit": (0.003, 0.0035),
    "reason": "Cycles divides by a facet's probability from Walter's fit of the masking, with errors up to 0.31 %; Lancer "
    "divides by the probability with which facets are sampled",
}


_DRAWN_WITHOUT_MASK = (
    "Cycles 3 samples stretched facets of Beckmann without masking: brighter under a sky. Under a sun both agree "
    "(sun_on_anisotropic_beckmann)"
)
_STRETCHED_TOLD = "anisotropic Beckmann follows its model"
_TABLE3 = {"blender3": ((0.003, 0.008), BECKMANN3)}
# Differences of Blender 3 in both parts.
_EXACT3 = {"anisotropic_beckmann": {"blender3": ((0.07, 0.30), _DRAWN_WITHOUT_MASK, _STRETCHED_TOLD)}}
_FITTED3 = {
    "anisotropic_beckmann": {"blender3": ((0.14, 0.70), _DRAWN_WITHOUT_MASK, _STRETCHED_TOLD)},
    "beckmann": _TABLE3,
    "glass_beckmann": _TABLE3,
    "refraction_beckmann": _TABLE3,
}


def _closures(names, tiles, blender3=MappingProxyType({}), **fields):
    """Returns the closures' values with the fields of their scenes."""
    fields["size"] = size_of(tiles)
    return {
        name: (_CLOSURES[name], {"needs": with_node(_CLOSURES[name][0]), **fields, **blender3.get(name, {})}) for name in names
    }


_BECKMANN = tuple(name for name in _CLOSURES if "beckmann" in name)


def _closure(scene, value, tiles):
    kind, props, inputs = value
    set_plates(scene, lambda roughness: shader(kind, props, Roughness=roughness, **inputs), tiles)


_MULTIPLE = tuple(name for name in _CLOSURES if "multiple" in name)
# Blender 3 simulates a random walk between facets: a visible difference for rough surfaces, and for surfaces seen along the
# normal.
_WALKED = {0.1: (0,), 0.3: (0, 80), 0.6: ANGLES, 1.0: ANGLES}
_STRAIGHT = {0.1: ANGLES[1:], 0.3: ANGLES[1:-1]}
_COMPENSATED = _STRAIGHT if bpy.app.version < (4, 0) else TILES


@variants("FURNACE", values=_closures([n for n in _CLOSURES if n not in _BECKMANN + _MULTIPLE], TILES), bounces=1)
def furnace(scene, value):
    _closure(scene, value, TILES)


_STRETCHED3 = {"anisotropic_multiple": {"blender3": ((0.007, 0.03), WALK3, WALK3_TOLD)}}


@variants("FURNACE", values=_closures(_MULTIPLE, _COMPENSATED, _STRETCHED3), bounces=1)
def furnace_compensated(scene, value):
    _closure(scene, value, _COMPENSATED)


@variants(
    "FURNACE",
    values=_closures(_MULTIPLE, _WALKED),
    bounces=1,
    until=(4, 0),
    limit=(0.1, 0.64),
    reason=WALK3,
    announced=WALK3_TOLD,
)
def furnace_walked(scene, value):
    _closure(scene, value, _WALKED)


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
    size=SIZE,
    bounces=0,
)
def sun_on(scene, value):
    """The same plates, lit from one direction only: the value of a lobe, without its sampling."""
    _closure(scene, value, TILES)
    _one_sun(scene, (0.9, 0.4, 0))


def _one_sun(scene, turn):
    parts.set_world(scene, (0, 0, 0))
    parts.add_light(scene, "Sun", "SUN", math.pi, (0, 0, 30), angle=0.0).rotation_euler = Euler(turn)
    for thing in scene.objects:
        if thing.type == "MESH":
            thing.visible_shadow = False


@variants(
    "EXACT",
    values={
        "refraction": ("ShaderNodeBsdfRefraction", {"distribution": "GGX"}, {"IOR": 1.45}),
        "refraction_beckmann": ("ShaderNodeBsdfRefraction", {"distribution": "BECKMANN"}, {"IOR": 1.45}),
        "refraction_thinner": ("ShaderNodeBsdfRefraction", {"distribution": "GGX"}, {"IOR": 0.7}),
        "glass": ("ShaderNodeBsdfGlass", {"distribution": "GGX"}, {"IOR": 1.45}),
        "principled_glass": (_PRINCIPLED, {}, {"Transmission_Weight": 1.0, "IOR": 1.45}),
    },
    size=SIZE,
    bounces=0,
)
def sun_behind(scene, value):
    """The same plates with an oblique sun behind them, in a direction that most facets do not refract to the viewer."""
    _closure(scene, value, TILES)
    _one_sun(scene, (math.pi - 0.6, 0.3, 0))


# Where velvet reflects at most a ten thousandth of the light, too few samples find light to measure its albedo.
_VELVET = {0.1: ANGLES[-1:], 0.3: ANGLES[-2:], 0.6: ANGLES, 1.0: ANGLES}


@case("FURNACE", size=size_of(_VELVET), bounces=1, since=(4, 0))
def furnace_sheen_ashikhmin(scene):
    props = {"distribution": "ASHIKHMIN"}
    set_plates(scene, lambda r: shader("ShaderNodeBsdfSheen", props, Roughness=r, Color=(0.8, 0.8, 0.8)), _VELVET)


@case("FURNACE", size=size_of({1.0: ANGLES}), bounces=1)
def furnace_translucent(scene):
    set_plates(scene, lambda _: shader("ShaderNodeBsdfTranslucent", Color=(0.8, 0.8, 0.8)), {1.0: ANGLES})


# Seen from the denser side, smooth surfaces reflect all light beyond 50 degrees; the last angle shows only the light that rough
# facets transmit.
_SAME_SIDE = "Cycles 3 also counts refraction that ends on the viewer's side of the surface, which is impossible inside glass"
_INSIDE = {0.1: ANGLES[:3], 0.3: ANGLES[:3], 0.6: ANGLES[:4], 1.0: ANGLES}
_INSIDE_EXACT = {roughness: tuple(a for a in angles if a in _EXACT[roughness]) for roughness, angles in _INSIDE.items()}
_INSIDE_FITTED = {0.6: (65,), 1.0: (45, 65, 80)}


def _inside(scene, kind, distribution, tiles):
    set_plates(scene, lambda r: shader(kind, {"distribution": distribution}, Roughness=r, Color=(1, 1, 1), IOR=1.3), tiles)
    for thing in scene.objects:
        if thing.type == "MESH":
            thing.data.flip_normals()


@variants(
    "FURNACE",
    values={
        "glass": ("ShaderNodeBsdfGlass", {"blender3": ((0.003, 0.006), _SAME_SIDE)}),
        "refraction": ("ShaderNodeBsdfRefraction", {"blender3": ((0.018, 0.26), _SAME_SIDE)}),
    },
    size=size_of(_INSIDE),
    bounces=1,
)
def furnace_inside(scene, kind):
    _inside(scene, kind, "GGX", _INSIDE)


@variants(
    "FURNACE",
    values={
        "exact": (_INSIDE_EXACT, {"size": size_of(_INSIDE_EXACT), "blender3": ((0.003, 0.012), _SAME_SIDE)}),
        "fitted": (_INSIDE_FITTED, {"size": size_of(_INSIDE_FITTED), "blender3": ((0.19, 0.86), _SAME_SIDE), **_WALTER}),
    },
    bounces=1,
)
def furnace_inside_beckmann(scene, tiles):
    _inside(scene, "ShaderNodeBsdfRefraction", "BECKMANN", tiles)


_PHONG = {0.1: ANGLES, 0.3: ANGLES, 0.6: ANGLES[:-1], 1.0: ANGLES[:-2]}
_PHONG_GRAZING = {0.6: ANGLES[-1:], 1.0: ANGLES[-2:]}


def _phong(scene, tiles):
    inputs = {"Anisotropy": 0.0, "Color": (0.8, 0.8, 0.8)}
    set_plates(scene, lambda r: shader(_GLOSSY, {"distribution": "ASHIKHMIN_SHIRLEY"}, Roughness=r, **inputs), tiles)


@case("FURNACE", size=size_of(_PHONG), bounces=1)
def furnace_ashikhmin(scene):
    _phong(scene, _PHONG)


@case(
    "FURNACE",
    size=size_of(_PHONG_GRAZING),
    bounces=1,
    announced="Ashikhmin-Shirley follows its model",
    limit=(0.16, 0.42),
    reason="Cycles' sampler of this lobe mirrors about half vectors that face away, which brightens rough surfaces at grazing "
    "angles under a sky; the values agree, as under lamps, and Lancer's result is their integral",
)
def furnace_ashikhmin_grazing(scene):
    _phong(scene, _PHONG_GRAZING)
