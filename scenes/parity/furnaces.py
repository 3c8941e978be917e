"""Every lobe in an even white light: one picture of five angles (from left) by four roughnesses (from below)."""

import math

from mathutils import Euler, Vector

from .. import parts
from .catalogue import case, variants
from .nodes import shader, with_node, with_socket

_ANGLES = (0, 20, 45, 65, 80)
_ROUGHNESS = (0.1, 0.3, 0.6, 1.0)
_TILE = 16
_SIZE = (_TILE * len(_ANGLES), _TILE * len(_ROUGHNESS))
# Under this name the node of all glossy lobes exists in every version.
_GLOSSY = "ShaderNodeBsdfAnisotropic"
_PRINCIPLED = "ShaderNodeBsdfPrincipled"


def _furnace(scene, make):
    """make(roughness) gives a material.

    The plates fill the tiles of an orthographic picture, and stand so far behind one another that they hardly meet.
    """
    for row, roughness in enumerate(_ROUGHNESS):
        surface = make(roughness)
        for column, angle in enumerate(_ANGLES):
            turn = math.radians(angle)
            # Stretched by what leaning shortens it.
            plate = parts.place(
                scene,
                f"Plate {angle} {roughness}",
                parts.plane_mesh("Plate", 1.0),
                surface,
                Vector((column + 0.5, row + 0.5, -50.0 * (column + row * len(_ANGLES)))),
                (1.0, 1.0 / math.cos(turn), 1.0),
            )
            plate.rotation_euler = Euler((turn, 0, 0))
    parts.set_world(scene, (1, 1, 1))
    columns, rows = len(_ANGLES), len(_ROUGHNESS)
    eye = parts.add_camera(scene, (columns / 2, rows / 2, 20), (columns / 2, rows / 2, 0))
    eye.rotation_euler = (0, 0, 0)
    eye.data.type, eye.data.ortho_scale, eye.data.clip_end = "ORTHO", max(columns, rows), 5000.0


_CLOSURES = {
    "diffuse": ("ShaderNodeBsdfDiffuse", {}, {"Color": (0.8, 0.8, 0.8)}),
    "ggx": (_GLOSSY, {"distribution": "GGX"}, {"Anisotropy": 0.0, "Color": (0.8, 0.8, 0.8)}),
    "beckmann": (_GLOSSY, {"distribution": "BECKMANN"}, {"Anisotropy": 0.0, "Color": (0.8, 0.8, 0.8)}),
    "ashikhmin": (_GLOSSY, {"distribution": "ASHIKHMIN_SHIRLEY"}, {"Anisotropy": 0.0, "Color": (0.8, 0.8, 0.8)}),
    "multiple": (_GLOSSY, {"distribution": "MULTI_GGX"}, {"Anisotropy": 0.0, "Color": (0.8, 0.5, 0.2)}),
    "glass": ("ShaderNodeBsdfGlass", {"distribution": "GGX"}, {"Color": (0.8, 0.8, 0.8), "IOR": 1.5}),
    "glass_multiple": ("ShaderNodeBsdfGlass", {"distribution": "MULTI_GGX"}, {"Color": (0.8, 0.8, 0.8), "IOR": 1.5}),
    "refraction": ("ShaderNodeBsdfRefraction", {"distribution": "GGX"}, {"Color": (0.8, 0.8, 0.8), "IOR": 1.5}),
    "metallic": ("ShaderNodeBsdfMetallic", {}, {"Base_Color": (0.9, 0.6, 0.3), "Edge_Tint": (0.4, 0.6, 0.9)}),
    "sheen": ("ShaderNodeBsdfSheen", {}, {"Color": (0.8, 0.8, 0.8)}),
}


_LOOSER = {
    "ashikhmin": {
        "limit": (0.04, 0.45),
        "reason": "Cycles' sampler of this lobe mirrors about half vectors that face away, which brightens rough surfaces at "
        "grazing angles under a sky; under lamps both agree",
    },
    "sheen": {
        "limit": (0.03, 0.4),
        "reason": "smooth cloth seen steeply reflects a thousandth of the light and less; our table of it is within 0.0002 of "
        "white there, a large share of nearly nothing",
    },
}


@variants(
    "FURNACE",
    values={name: (value, {"needs": with_node(value[0]), **_LOOSER.get(name, {})}) for name, value in _CLOSURES.items()},
    size=_SIZE,
    bounces=1,
)
def furnace(scene, value):
    kind, props, inputs = value
    _furnace(scene, lambda roughness: shader(kind, props, Roughness=roughness, **inputs))


_INPUTS = {
    "default": {},
    "metal": {"Metallic": 1.0},
    "black": {"Base_Color": (0.0, 0.0, 0.0)},
    "glass": {"Transmission_Weight": 1.0},
    "coat": {"Coat_Weight": 1.0},
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
