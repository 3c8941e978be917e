"""The Principled node, one input at a time, on a ball in a small studio."""

import math

import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import material, principled, with_socket
from .reasons import CLEAR_COAT3, CLEAR_COAT3_TOLD, WALK3, WALK3_TOLD
from .stages import open_air, studio

_RED = (0.8, 0.2, 0.1)
_GOLD = (0.9, 0.6, 0.2)
_KIND = "ShaderNodeBsdfPrincipled"


@case("LOBES", quick=True)
def principled_default(scene):
    studio(scene, principled(), caustics=True)


@variants("LOBES", values={"smooth": 0.0, "low": 0.15, "middle": 0.5, "full": 1.0})
def principled_dielectric(scene, roughness):
    studio(scene, principled(Base_Color=_RED, Roughness=roughness))


@variants("LOBES", values={"smooth": 0.0, "low": 0.15, "middle": (0.5, {"quick": True}), "full": 1.0})
def principled_metal(scene, roughness):
    studio(scene, principled(Base_Color=_GOLD, Metallic=1.0, Roughness=roughness))


@case("LOBES")
def principled_half_metal(scene):
    studio(scene, principled(Base_Color=_GOLD, Metallic=0.5, Roughness=0.3))


@variants(
    "LOBES",
    values={
        "single": "GGX",
        "multiple": (
            "MULTI_GGX",
            {
                "blender3": (
                    (0.025, 0.13),
                    WALK3,
                    WALK3_TOLD,
                )
            },
        ),
    },
)
def principled_distribution(scene, distribution):
    def build(nodes):
        props = {"distribution": distribution}
        return nodes.add(_KIND, props=props, Base_Color=_GOLD, Metallic=0.7, Roughness=0.7)

    studio(scene, material(build))


@variants("LOBES", values={"none": 0.0, "full": 1.0})
def principled_specular(scene, level):
    studio(scene, principled(Base_Color=_RED, Roughness=0.3, Specular_IOR_Level=level))


@case("LOBES")
def principled_specular_tint(scene):
    tint = (0.9, 0.3, 0.2) if bpy.app.version >= (4, 0) else 1.0
    studio(scene, principled(Base_Color=(0.2, 0.3, 0.8), Roughness=0.25, Specular_Tint=tint))


@case("LOBES", since=(4, 0))
def principled_metal_edge_tint(scene):
    studio(scene, principled(Base_Color=_GOLD, Metallic=1.0, Roughness=0.2, Specular_Tint=(0.2, 0.5, 1.0)))


@variants("LOBES", values={"low": 1.1, "high": 2.4})
def principled_ior(scene, ior):
    studio(scene, principled(Base_Color=_RED, Roughness=0.2, IOR=ior))


@variants("LOBES", values={"smooth": 0.0, "rough": 0.4}, bounces=4)
def principled_transmission(scene, roughness):
    open_air(scene, principled(Base_Color=(0.85, 0.95, 1.0), Transmission_Weight=1.0, Roughness=roughness, IOR=1.45))


@case("LOBES", bounces=4)
def principled_half_transmission(scene):
    open_air(scene, principled(Base_Color=_RED, Transmission_Weight=0.5, Roughness=0.2))


@case(
    "LOBES",
    quick=True,
    blender3=((0.015, 0.16), CLEAR_COAT3, CLEAR_COAT3_TOLD),
)
def principled_coat(scene):
    studio(scene, principled(Base_Color=_RED, Roughness=0.8, Coat_Weight=1.0, Coat_Roughness=0.1))


@case("LOBES", needs=with_socket(_KIND, "Coat IOR"))
def principled_coat_ior(scene):
    studio(scene, principled(Base_Color=_RED, Roughness=0.8, Coat_Weight=1.0, Coat_Roughness=0.2, Coat_IOR=2.2))


@case("LOBES", needs=with_socket(_KIND, "Coat Tint"))
def principled_coat_tint(scene):
    studio(scene, principled(Base_Color=(0.8, 0.8, 0.8), Coat_Weight=1.0, Coat_Tint=(0.9, 0.5, 0.2)))


@case("LOBES")
def principled_coat_normal(scene):
    _coat_leaning(scene, (0.65, 0.5, 0.97))


@case(
    "LOBES",
    limit=(0.01, 0.055),
    reason="the coat mirrors the lamp at the horizon, above the plane of the smooth normal and below that of the facet: Cycles "
    "weights this light by a probability that its sampler does not use, and loses a tenth of the highlight",
)
def principled_coat_normal_horizon(scene):
    _coat_leaning(scene, (0.8, 0.5, 0.9))


def _coat_leaning(scene, color):
    def build(nodes):
        # A map of one colour tilts the normal of the coat, and of the coat alone.
        lean = nodes.add("ShaderNodeNormalMap", props={"space": "WORLD"}, Color=color)
        return nodes.add(_KIND, Base_Color=_RED, Roughness=0.7, Coat_Weight=1.0, Coat_Roughness=0.15, Coat_Normal=lean)

    studio(scene, material(build))


@variants("LOBES", values={"soft": 0.3, "wide": (0.9, {"since": (4, 0)})})
def principled_sheen(scene, roughness):
    inputs = {"Sheen_Roughness": roughness} if bpy.app.version >= (4, 0) else {}
    studio(scene, principled(Base_Color=(0.1, 0.1, 0.15), Roughness=0.9, Sheen_Weight=1.0, **inputs))


@case("LOBES")
def principled_sheen_tint(scene):
    tint = (0.9, 0.2, 0.4) if bpy.app.version >= (4, 0) else 1.0
    studio(scene, principled(Base_Color=(0.1, 0.1, 0.3), Roughness=0.9, Sheen_Weight=1.0, Sheen_Tint=tint))


@case("LOBES")
def principled_emission(scene):
    studio(scene, principled(Base_Color=(0.5, 0.5, 0.5), Emission_Color=(1.0, 0.5, 0.2), Emission_Strength=0.7), caustics=True)


@case("LOBES", quick=True)
def principled_alpha(scene):
    studio(scene, principled(Base_Color=_RED, Alpha=0.4))


@variants("LOBES", values={"half": (0.5, 0.0), "full": (1.0, 0.0), "turned": (0.8, 0.15)})
def principled_anisotropic(scene, value):
    anisotropic, rotation = value
    metal = principled(Base_Color=_GOLD, Metallic=1.0, Roughness=0.4, Anisotropic=anisotropic, Anisotropic_Rotation=rotation)
    studio(scene, metal)


@case("LOBES")
def principled_anisotropic_tangent(scene):
    def build(nodes):
        around = nodes.add("ShaderNodeTangent", props={"direction_type": "RADIAL", "axis": "X"})
        return nodes.add(_KIND, Base_Color=_GOLD, Metallic=1.0, Roughness=0.4, Anisotropic=0.8, Tangent=around)

    studio(scene, material(build)).rotation_euler = (0.3, 0.0, math.radians(20))


@case("LOBES", needs=with_socket(_KIND, "Diffuse Roughness"))
def principled_diffuse_roughness(scene):
    studio(scene, principled(Base_Color=_RED, Diffuse_Roughness=1.0, Specular_IOR_Level=0.0), caustics=True)


@case(
    "LOBES",
    limit=(0.05, 0.25),
    reason="a diffuse surface replaces sub-surface scattering, which softens the edge of the shadow; a message reports it",
    announced="is not supported, a diffuse surface is used",
)
def principled_subsurface(scene):
    studio(scene, principled(Base_Color=(0.8, 0.5, 0.4), Subsurface_Weight=1.0, Roughness=0.5), caustics=True)


_FILM = "Thin Film Thickness"


def _film(thickness, ior=1.33, **inputs):
    return principled(Thin_Film_Thickness=thickness, Thin_Film_IOR=ior, **inputs)


@variants(
    "LOBES",
    values={"thinnest": (15.0, 1.6, 0.2), "thin": ((300.0, 1.33, 0.2), {"quick": True}), "thick": (1200.0, 1.8, 0.3)},
    needs=with_socket(_KIND, _FILM),
)
def principled_film(scene, value):
    thickness, ior, roughness = value
    studio(scene, _film(thickness, ior, Base_Color=(0.03, 0.03, 0.03), Roughness=roughness, IOR=1.8))


@case("LOBES", needs=with_socket(_KIND, _FILM))
def principled_film_tinted(scene):
    studio(scene, _film(450.0, Base_Color=_RED, Roughness=0.3, Specular_Tint=(0.4, 0.9, 0.6), Specular_IOR_Level=0.9))


@case("LOBES", needs=with_socket(_KIND, _FILM))
def principled_film_metal(scene):
    """On metal, from 5.0 on."""
    studio(scene, _film(500.0, 1.5, Base_Color=_GOLD, Metallic=1.0, Roughness=0.25, Specular_Tint=(0.8, 0.9, 0.5)))


@variants("LOBES", values={"smooth": 0.0, "rough": 0.4}, bounces=4, needs=with_socket(_KIND, _FILM))
def principled_film_glass(scene, roughness):
    open_air(scene, _film(350.0, Base_Color=(0.9, 0.95, 1.0), Transmission_Weight=1.0, Roughness=roughness, IOR=1.45))


@case("LOBES", needs=with_socket(_KIND, _FILM))
def principled_film_varied(scene):
    """A film whose thickness varies from none on."""

    def build(nodes):
        place = nodes.add("ShaderNodeTexCoord")
        parted = nodes.add("ShaderNodeSeparateXYZ", place.outputs["Object"])
        thickness = nodes.add("ShaderNodeMath", parted.outputs["Z"], 700.0, props={"operation": "MULTIPLY"})
        return nodes.add(_KIND, Base_Color=(0.05, 0.05, 0.05), Roughness=0.2, IOR=2.0, Thin_Film_Thickness=thickness)

    studio(scene, material(build))


_WALL = "Thin Wall"


@variants(
    "LOBES",
    values={"smooth": (0.0, {"quick": True}), "low": 0.15, "rough": 0.5},
    bounces=4,
    needs=with_socket(_KIND, _WALL),
)
def principled_wall_glass(scene, roughness):
    inputs = {"Base_Color": (0.7, 0.9, 0.95), "Transmission_Weight": 1.0, "Roughness": roughness, "IOR": 1.5}
    open_air(scene, principled(Thin_Wall=True, **inputs))


@case("LOBES", bounces=4, needs=with_socket(_KIND, _WALL))
def principled_wall_film(scene):
    inputs = {"Base_Color": (0.9, 0.95, 1.0), "Transmission_Weight": 0.9, "Roughness": 0.1, "IOR": 1.7}
    open_air(scene, _film(380.0, 1.3, Thin_Wall=True, Specular_Tint=(0.9, 0.7, 1.0), **inputs))


@case("LOBES", bounces=4, needs=with_socket(_KIND, _WALL))
def principled_wall_lets_lamps_through(scene):
    """Light samples pass smooth sheets, and a sheet behind another is no bounce."""
    open_air(scene, principled(Thin_Wall=True, Base_Color=(0.8, 0.9, 1.0), Transmission_Weight=1.0, Roughness=0.0))
    parts.add_light(scene, "Light", "POINT", 300.0, (1.5, -2.5, 3.5), shadow_soft_size=0.0)


@variants("LOBES", values={"back": (-0.5, 0.0), "even": (0.0, 0.0), "ahead": (0.8, 0.7)}, needs=with_socket(_KIND, _WALL))
def principled_wall_leaf(scene, value):
    anisotropy, roughness = value
    inputs = {"Subsurface_Weight": 0.8, "Subsurface_Anisotropy": anisotropy, "Diffuse_Roughness": roughness}
    studio(scene, principled(Thin_Wall=True, Base_Color=(0.4, 0.8, 0.2), Roughness=0.4, **inputs))
