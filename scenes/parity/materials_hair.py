"""Hair closures on a mesh, as Cycles shows them there."""

from .catalogue import case, variants
from .nodes import material, shader
from .stages import studio


@variants(
    values={
        "reflection": ("Reflection", 0.3, 0.8),
        "narrow": ("Reflection", 0.1, 0.3),
        "transmission": ("Transmission", 0.3, 0.6),
    }
)
def hair(scene, value):
    component, along, around = value
    inputs = {"Color": (0.7, 0.5, 0.3), "RoughnessU": along, "RoughnessV": around, "Offset": 0.1}
    studio(scene, shader("ShaderNodeBsdfHair", {"component": component}, **inputs)).visible_diffuse = False


@case()
def hair_along_a_tangent(scene):
    def build(nodes):
        around = nodes.add("ShaderNodeTangent", props={"direction_type": "RADIAL", "axis": "Z"})
        inputs = {"Color": (0.7, 0.5, 0.3), "RoughnessU": 0.3, "RoughnessV": 0.7, "Offset": 0.2, "Tangent": around}
        return nodes.add("ShaderNodeBsdfHair", **inputs)

    studio(scene, material(build)).visible_diffuse = False


_HAIR_COLORS = {
    "COLOR": {"Color": (0.5, 0.3, 0.15), "Roughness": 0.4, "Radial_Roughness": 0.5},
    "MELANIN": {"Melanin": 0.6, "Melanin_Redness": 0.4, "Tint": (0.9, 0.8, 1.0), "Random": 0.7},
    "ABSORPTION": {"Absorption_Coefficient": (0.1, 0.3, 0.8), "Coat": 0.5, "Random_Roughness": 0.4},
}
_HUANG = {
    "round": {"Color": (0.5, 0.3, 0.15), "Roughness": 0.4, "Aspect_Ratio": 1.0},
    "elliptic": {"Color": (0.5, 0.3, 0.15), "Aspect_Ratio": 0.6, "Offset": 0.1},
    "smooth": {"Color": (0.7, 0.5, 0.3), "Roughness": 0.1},
    "reflection": {"Transmission": 0.0, "Secondary_Reflection": 0.0, "Reflection": 3.0},
    "transmission": {"Color": (0.7, 0.5, 0.3), "Reflection": 0.0, "Secondary_Reflection": 0.0},
    "secondary": {"Color": (0.7, 0.5, 0.3), "Reflection": 0.0, "Transmission": 0.0, "Secondary_Reflection": 4.0},
}


@variants(values={"color": "COLOR", "melanin": "MELANIN", "absorption": "ABSORPTION"})
def hair_principled(scene, way):
    fibre = shader("ShaderNodeBsdfHairPrincipled", {"parametrization": way}, **_HAIR_COLORS[way])
    studio(scene, fibre).visible_diffuse = False


@variants(values={name: name for name in _HUANG}, since=(4, 0))
def hair_huang(scene, name):
    fibre = shader("ShaderNodeBsdfHairPrincipled", {"parametrization": "COLOR", "model": "HUANG"}, **_HUANG[name])
    studio(scene, fibre).visible_diffuse = False


@case(since=(4, 0))
def hair_huang_beside_diffuse(scene):
    def build(nodes):
        inputs = {"Color": (0.5, 0.3, 0.15), "Roughness": 0.4}
        props = {"parametrization": "COLOR", "model": "HUANG"}
        fibre = nodes.add("ShaderNodeBsdfHairPrincipled", props=props, **inputs)
        matt = nodes.add("ShaderNodeBsdfDiffuse", Color=(0.2, 0.4, 0.6))
        return nodes.add("ShaderNodeMixShader", 0.5, fibre, matt)

    studio(scene, material(build)).visible_diffuse = False
