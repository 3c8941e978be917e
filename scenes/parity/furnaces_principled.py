"""Principled under a uniform white sky, at five angles and four roughnesses."""

from .catalogue import case, variants
from .nodes import shader, with_socket
from .plates import SIZE, set_plates
from .reasons import CLEAR_COAT3, CLEAR_COAT3_TOLD

_PRINCIPLED = "ShaderNodeBsdfPrincipled"
_INPUTS = {
    "default": {},
    "metal": {"Metallic": 1.0},
    "half_metal": {"Metallic": 0.5},
    "black": {"Base_Color": (0.0, 0.0, 0.0)},
    "glass": {"Transmission_Weight": 1.0},
    "half_glass": {"Transmission_Weight": 0.5},
    "coat": ({"Coat_Weight": 1.0}, {"blender3": ((0.033, 0.065), CLEAR_COAT3, CLEAR_COAT3_TOLD)}),
    "specular": {"Specular_IOR_Level": 1.0},
    "anisotropic": {"Metallic": 1.0, "Anisotropic": 0.7},
}


@variants("FURNACE", values=_INPUTS, size=SIZE, bounces=1)
def furnace_principled(scene, inputs):
    inputs = {"Base_Color": (0.8, 0.5, 0.2), **inputs}
    set_plates(scene, lambda roughness: shader(_PRINCIPLED, Roughness=roughness, **inputs))


@case("FURNACE", size=SIZE, bounces=1, needs=with_socket(_PRINCIPLED, "Sheen Roughness"))
def furnace_principled_sheen(scene):
    set_plates(
        scene,
        lambda roughness: shader(
            _PRINCIPLED, Base_Color=(0.2, 0.2, 0.2), Sheen_Weight=1.0, Sheen_Roughness=roughness, Specular_IOR_Level=0.0
        ),
    )


@case("FURNACE", size=SIZE, bounces=1, needs=with_socket(_PRINCIPLED, "Coat Roughness"))
def furnace_principled_coat_roughness(scene):
    set_plates(
        scene, lambda roughness: shader(_PRINCIPLED, Base_Color=(0.8, 0.5, 0.2), Coat_Weight=1.0, Coat_Roughness=roughness)
    )
