"""Every closure beside Principled, on a ball in a small studio."""

import bmesh
import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import material, shader, with_node, with_socket
from .reasons import BECKMANN3, WALK3, WALK3_TOLD
from .stages import ball, camera, floor, lamp, open_air, sky, studio

_NEW = bpy.app.version >= (4, 0)
_GLOSSY = "ShaderNodeBsdfGlossy"
_MULTI = "MULTI_GGX"
_STEEL = (0.7, 0.75, 0.8)


@variants(values={"smooth": (0.0, {"quick": True}), "half": 0.5, "rough": 1.0})
def diffuse(scene, roughness):
    studio(scene, shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.5, 0.3), Roughness=roughness))


@case()
def glossy_mirror(scene):
    # SHARP before 4.0 equals roughness 0 since then.
    studio(scene, shader(_GLOSSY, Color=_STEEL, Roughness=0.0))


@variants(
    values={
        "ggx_low": ("GGX", 0.1),
        "ggx_high": (("GGX", 0.7), {"quick": True}),
        "beckmann_low": (("BECKMANN", 0.1), {"blender3": ((0.005, 0.06), BECKMANN3)}),
        "beckmann_high": ("BECKMANN", 0.7),
        "ashikhmin_low": ("ASHIKHMIN_SHIRLEY", 0.1),
    }
)
def glossy(scene, value):
    distribution, roughness = value
    studio(scene, shader(_GLOSSY, {"distribution": distribution}, Color=_STEEL, Roughness=roughness))


@case(bounces=0)
def glossy_ashikhmin_high(scene):
    _under_a_point(scene, shader(_GLOSSY, {"distribution": "ASHIKHMIN_SHIRLEY"}, Color=_STEEL, Roughness=0.7))


def _under_a_point(scene, surface):
    """Adds a point light, which no ray finds by chance: sampling in Cycles does not affect the picture."""
    floor(scene)
    ball(scene, surface)
    parts.add_light(scene, "Light", "POINT", 300.0, (1.5, -2.5, 3.5), shadow_soft_size=0.0)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


@variants("LOBES", values={"low": 0.2, "high": (0.9, {"blender3": ((0.05, 0.40), WALK3, WALK3_TOLD)})})
def glossy_multiple(scene, roughness):
    studio(scene, shader(_GLOSSY, {"distribution": _MULTI}, Color=(0.9, 0.6, 0.3), Roughness=roughness))


@variants(
    values={
        "ggx": ("GGX", 0.7, 0.0),
        # Blender 3 samples stretched facets without masking: see the next scene.
        "beckmann": (("BECKMANN", 0.7, 0.0), {"since": (4, 0)}),
        "negative": ("GGX", -0.6, 0.0),
        "turned": ("GGX", 0.7, 0.2),
    }
)
def anisotropic(scene, value):
    studio(scene, _stretched(*value))


@variants(values={"ashikhmin": "ASHIKHMIN_SHIRLEY", "beckmann": "BECKMANN"}, bounces=0)
def anisotropic_under_a_point(scene, distribution):
    _under_a_point(scene, _stretched(distribution, 0.7, 0.0))


def _stretched(distribution, anisotropy, rotation):
    def build(nodes):
        around = nodes.add("ShaderNodeTangent", props={"direction_type": "RADIAL", "axis": "Z"})
        return nodes.add(
            "ShaderNodeBsdfAnisotropic",
            props={"distribution": distribution},
            Color=_STEEL,
            Roughness=0.4,
            Anisotropy=anisotropy,
            Rotation=rotation,
            Tangent=around,
        )

    return material(build)


@variants(values={"smooth": (0.0, {"quick": True})}, bounces=4)
def glass(scene, roughness):
    open_air(scene, shader("ShaderNodeBsdfGlass", Color=(0.9, 1.0, 0.95), Roughness=roughness, IOR=1.45))


@case(bounces=4)
def glass_under_a_lamp(scene):
    """The lamp's own light through glass, on the objects behind it."""
    studio(scene, shader("ShaderNodeBsdfGlass", Color=(0.9, 1.0, 0.95), Roughness=0.0, IOR=1.45), caustics=True)
    # Paths find the lamp behind glass by chance alone.
    scene.objects["Lamp"].data.size = 8.0


@variants(values={"ggx": ("GGX", 0.3), "beckmann": ("BECKMANN", 0.3), "ggx_full": ("GGX", 1.0)}, bounces=4)
def glass_rough(scene, value):
    distribution, roughness = value
    props = {"distribution": distribution}
    open_air(scene, shader("ShaderNodeBsdfGlass", props, Color=(0.9, 1.0, 0.95), Roughness=roughness, IOR=1.45))


@variants(values={"refraction": "ShaderNodeBsdfRefraction", "glass": "ShaderNodeBsdfGlass"}, bounces=4)
def rough_under_a_lamp(scene, kind):
    """Light from a lamp in addition to a sky."""
    studio(scene, shader(kind, {"distribution": "GGX"}, Color=(0.9, 1.0, 0.95), Roughness=0.7, IOR=1.45))
    # Large, so that little of the light is found by chance.
    scene.objects["Lamp"].data.size = 8.0


@variants(
    "LOBES",
    values={
        "low": (0.3, {"blender3": ((0.03, 0.19), WALK3, WALK3_TOLD)}),
        "high": (0.8, {"blender3": ((0.065, 0.27), WALK3, WALK3_TOLD)}),
    },
    bounces=4,
)
def glass_multiple(scene, roughness):
    open_air(
        scene, shader("ShaderNodeBsdfGlass", {"distribution": _MULTI}, Color=(0.9, 1.0, 0.95), Roughness=roughness, IOR=1.45)
    )


@case(bounces=4)
def glass_thinner_than_air(scene):
    open_air(scene, shader("ShaderNodeBsdfGlass", {"distribution": "GGX"}, Color=(1, 1, 1), Roughness=0.0, IOR=0.8))


@variants(values={"smooth": ("GGX", 0.0), "ggx": ("GGX", 0.3), "beckmann": ("BECKMANN", 0.3)}, bounces=4)
def refraction(scene, value):
    distribution, roughness = value
    props = {"distribution": distribution}
    open_air(scene, shader("ShaderNodeBsdfRefraction", props, Color=(1.0, 0.9, 0.7), Roughness=roughness, IOR=1.3))


@variants("LOBES", values={"low": 0.2, "high": 0.8}, needs=with_node("ShaderNodeBsdfMetallic"))
def metallic_tint(scene, roughness):
    props = {"fresnel_type": "F82"}
    inputs = {"Base_Color": (0.9, 0.6, 0.3), "Edge_Tint": (0.4, 0.6, 1.0), "Roughness": roughness}
    studio(scene, shader("ShaderNodeBsdfMetallic", props, **inputs))


@case("LOBES", needs=with_node("ShaderNodeBsdfMetallic"))
def metallic_physical(scene):
    props = {"fresnel_type": "PHYSICAL_CONDUCTOR"}
    inputs = {"IOR": (0.18, 0.42, 1.37), "Extinction": (3.42, 2.35, 1.77), "Roughness": 0.25}
    studio(scene, shader("ShaderNodeBsdfMetallic", props, **inputs))


@variants(
    "LOBES",
    values={"microfiber": ("MICROFIBER", 0.5), "ashikhmin": ("ASHIKHMIN", 0.5), "microfiber_low": ("MICROFIBER", 0.2)},
    since=(4, 0),
)
def sheen(scene, value):
    distribution, roughness = value
    studio(scene, shader("ShaderNodeBsdfSheen", {"distribution": distribution}, Color=(0.8, 0.5, 0.6), Roughness=roughness))


@case("LOBES", until=(4, 0))
def velvet(scene):
    studio(scene, shader("ShaderNodeBsdfVelvet", Color=(0.8, 0.5, 0.6), Sigma=0.5))


@case(quick=True)
def translucent(scene):
    floor(scene)
    leaf = shader("ShaderNodeBsdfTranslucent", Color=(0.5, 0.8, 0.3))
    parts.place(scene, "Leaf", parts.plane_mesh("Leaf", 2.0), leaf, (0, 0, 0.9), rotation=(1.2, 0, 0.3))
    lamp(scene, 200.0, (1, 3, 3))
    sky(scene, strength=0.2)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85))


@case()
def transparent_coloured(scene):
    studio(scene, shader("ShaderNodeBsdfTransparent", Color=(0.9, 0.6, 0.3)))


@case(quick=True)
def emission(scene):
    floor(scene)
    ball(scene, shader("ShaderNodeEmission", Color=(1.0, 0.6, 0.3), Strength=2.0))
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85))


@case()
def holdout(scene):
    scene.render.film_transparent = True
    studio(scene, material(lambda nodes: nodes.add("ShaderNodeHoldout")))


@case()
def holdout_half(scene):
    def build(nodes):
        grey = nodes.add("ShaderNodeBsdfDiffuse", Color=(0.7, 0.7, 0.7))
        mix = nodes.add("ShaderNodeMixShader", 0.5)
        nodes.link(grey, mix.inputs[1])
        nodes.link(nodes.add("ShaderNodeHoldout"), mix.inputs[2])
        return mix

    scene.render.film_transparent = True
    studio(scene, material(build))


@case(bounces=1)
def back_of_a_material(scene):
    """A closure whose normal follows the visible side: an open glossy bowl, outside and inside."""
    floor(scene)
    bowl = parts.mesh_from_bmesh("Bowl", _make_bowl, smooth=True)
    steel = shader(_GLOSSY, {"distribution": "GGX"}, Color=_STEEL, Roughness=0.3)
    parts.place(scene, "Bowl", bowl, steel, (0, 0, 0.9), 0.9, rotation=(0.5, 0.3, 0))
    parts.add_light(scene, "Light", "POINT", 200.0, (1, -1.5, 3), shadow_soft_size=0.0)
    sky(scene, strength=1.0)
    camera(scene)


def _make_bowl(bm):
    """Makes the lower half of a ball."""
    bmesh.ops.create_uvsphere(bm, u_segments=64, v_segments=32, radius=1.0)
    upper = [vert for vert in bm.verts if vert.co.z > 0.01]
    bmesh.ops.delete(bm, geom=upper, context="VERTS")


@variants(
    values={
        "hard": (("DIFFUSE", 0.6, 0.0), {"quick": True}),
        "soft": ("DIFFUSE", 0.3, 0.5),
        "none": ("DIFFUSE", 0.0, 0.4),
        "full": ("DIFFUSE", 1.0, 1.0),
        "glossy_hard": ("GLOSSY", 0.3, 0.0),
        "glossy_soft": ("GLOSSY", 0.1, 0.4),
        "glossy_full": ("GLOSSY", 1.0, 0.0),
    }
)
def toon(scene, value):
    component, size, smooth = value
    thing = studio(scene, shader("ShaderNodeBsdfToon", {"component": component}, Color=_STEEL, Size=size, Smooth=smooth))
    # The floor meets the cone of the ball's highlights by chance.
    thing.visible_diffuse = component == "DIFFUSE"


@case()
def toon_mixed(scene):
    """A soft cone beside another lobe, by inputs that vary."""

    def build(nodes):
        place = nodes.add("ShaderNodeTexCoord")
        noise = nodes.add("ShaderNodeTexNoise", Scale=2.0)
        nodes.link(place.outputs["Object"], noise.inputs["Vector"])
        cone = nodes.add("ShaderNodeBsdfToon", Color=(0.8, 0.3, 0.2), Size=noise, Smooth=noise)
        mix = nodes.add("ShaderNodeMixShader", 0.5)
        nodes.link(cone, mix.inputs[1])
        nodes.link(nodes.add("ShaderNodeBsdfDiffuse", Color=(0.2, 0.4, 0.7)), mix.inputs[2])
        return mix

    studio(scene, material(build))


@variants(
    "LOBES",
    values={"thin": (250.0, 1.33, 0.0), "thick": (900.0, 1.6, 0.0), "rough": (400.0, 1.33, 0.4)},
    bounces=4,
    needs=with_socket("ShaderNodeBsdfGlass", "Thin Film Thickness"),
)
def glass_film(scene, value):
    thickness, film, roughness = value
    inputs = {"Roughness": roughness, "Thin_Film_Thickness": thickness, "Thin_Film_IOR": film}
    open_air(scene, shader("ShaderNodeBsdfGlass", {"distribution": "GGX"}, Color=(1, 1, 1), IOR=1.5, **inputs))


@variants(
    "LOBES",
    values={"tint": "F82", "physical": "PHYSICAL_CONDUCTOR"},
    needs=with_socket("ShaderNodeBsdfMetallic", "Thin Film Thickness"),
)
def metallic_film(scene, fresnel):
    inputs = {"Roughness": 0.25, "Thin_Film_Thickness": 350.0, "Thin_Film_IOR": 1.8}
    studio(scene, shader("ShaderNodeBsdfMetallic", {"fresnel_type": fresnel}, **inputs))
