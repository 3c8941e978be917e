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


@variants(values={"color": "COLOR", "melanin": "MELANIN", "absorption": "ABSORPTION"})
def hair_principled(scene, way):
    fibre = shader("ShaderNodeBsdfHairPrincipled", {"parametrization": way}, **_HAIR_COLORS[way])
    studio(scene, fibre).visible_diffuse = False
