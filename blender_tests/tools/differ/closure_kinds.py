"""The shaders and displacements of random graphs, as node_kinds has the rest."""

from .node_kinds import NORMAL, TANGENT, C, F, Kind, V

# Nanometres; most films are thin enough to be coloured.
_FILM = {"Thin Film Thickness": ("f", 0.0, 900.0), "Thin Film IOR": ("f", 1.0, 2.0)}

SHADERS = {
    "ShaderNodeBsdfDiffuse": Kind({"Color": C, "Roughness": F, "Normal": NORMAL}, {"BSDF": "s"}, weight=5.0),
    "ShaderNodeBsdfPrincipled": Kind(
        {
            "Base Color": C, "Metallic": F, "Roughness": ("f", 0.15, 1.0), "IOR": ("f", 1.0, 2.0), "Alpha": F,
            "Diffuse Roughness": F, "Specular IOR Level": F, "Specular Tint": C, "Anisotropic": F,
            "Anisotropic Rotation": F, "Transmission Weight": F, "Coat Weight": F, "Coat Roughness": ("f", 0.15, 1.0),
            "Coat IOR": ("f", 1.0, 2.0), "Coat Tint": C, "Sheen Weight": F, "Sheen Roughness": ("f", 0.15, 1.0),
            "Sheen Tint": C, "Emission Color": C, "Emission Strength": F, "Normal": NORMAL, "Coat Normal": NORMAL,
            "Tangent": TANGENT, "Thin Wall": F, **_FILM,
        },
        {"BSDF": "s"},
        {"distribution": ("GGX", "MULTI_GGX")},
        5.0,
        special=("sparse",),
    ),
    "ShaderNodeBsdfGlossy": Kind(
        {
            "Color": C, "Roughness": ("f", 0.15, 0.9), "Anisotropy": ("f", -0.9, 0.9), "Rotation": F, "Normal": NORMAL,
            "Tangent": TANGENT,
        },
        {"BSDF": "s"},
        {"distribution": ("GGX", "GGX", "BECKMANN", "MULTI_GGX", "ASHIKHMIN_SHIRLEY")},
        2.0,
        special=("sparse",),
    ),
    "ShaderNodeBsdfMetallic": Kind(
        {
            "Base Color": C, "Edge Tint": C, "IOR": ("v", 0.5, 3.0), "Extinction": ("v", 0.5, 4.0),
            "Roughness": ("f", 0.15, 0.9), "Anisotropy": F, "Rotation": F, "Normal": NORMAL, "Tangent": TANGENT, **_FILM,
        },
        {"BSDF": "s"},
        {"distribution": ("GGX", "BECKMANN", "MULTI_GGX"), "fresnel_type": ("PHYSICAL_CONDUCTOR", "F82")},
        special=("sparse",),
    ),
    "ShaderNodeBsdfGlass": Kind(
        {"Color": C, "Roughness": ("f", 0.0, 0.6), "IOR": ("f", 1.0, 1.8), "Normal": NORMAL, **_FILM},
        {"BSDF": "s"},
        {"distribution": ("GGX", "BECKMANN", "MULTI_GGX")},
        0.7,
    ),
    "ShaderNodeBsdfRefraction": Kind(
        {"Color": C, "Roughness": ("f", 0.0, 0.6), "IOR": ("f", 1.0, 1.8), "Normal": NORMAL},
        {"BSDF": "s"},
        {"distribution": ("GGX", "BECKMANN")},
        0.7,
    ),
    "ShaderNodeBsdfSheen": Kind(
        {"Color": C, "Roughness": ("f", 0.15, 1.0), "Normal": NORMAL},
        {"BSDF": "s"},
        {"distribution": ("ASHIKHMIN", "MICROFIBER")},
    ),
    "ShaderNodeBsdfToon": Kind(
        {"Color": C, "Size": F, "Smooth": F, "Normal": NORMAL}, {"BSDF": "s"}, {"component": ("DIFFUSE", "GLOSSY")}
    ),
    "ShaderNodeBsdfHair": Kind(
        {"Color": C, "Offset": ("f", -0.5, 0.5), "RoughnessU": F, "RoughnessV": F, "Tangent": TANGENT},
        {"BSDF": "s"},
        {"component": ("Reflection", "Transmission")},
        0.4,
    ),
    "ShaderNodeBsdfHairPrincipled": Kind(
        {
            "Color": C, "Melanin": F, "Melanin Redness": F, "Tint": C, "Absorption Coefficient": C,
            "Roughness": ("f", 0.1, 1.0), "Radial Roughness": ("f", 0.1, 1.0), "Coat": F, "IOR": ("f", 1.1, 2.0),
            "Offset": ("f", -0.2, 0.2), "Random Color": F, "Random Roughness": F, "Random": F, "Aspect Ratio": ("f", 0.2, 1.0),
            "R lobe": F, "TT lobe": F, "TRT lobe": F,
        },
        {"BSDF": "s"},
        {"parametrization": ("ABSORPTION", "MELANIN", "COLOR"), "model": ("CHIANG", "HUANG")},
        0.4,
    ),
    "ShaderNodeBsdfRayPortal": Kind({"Color": C, "Position": V, "Direction": V}, {"BSDF": "s"}, weight=0.5),
    "ShaderNodeSubsurfaceScattering": Kind(
        {
            "Color": C, "Scale": ("f", 0.0, 0.1), "Radius": ("v", 0.1, 1.0), "IOR": ("f", 1.1, 2.0), "Roughness": F,
            "Anisotropy": ("f", 0.0, 0.8), "Normal": NORMAL,
        },
        {"BSSRDF": "s"},
        {"falloff": ("BURLEY", "RANDOM_WALK", "RANDOM_WALK_SKIN")},
        0.1,
        special=("sparse",),
    ),
    "ShaderNodeBsdfTranslucent": Kind({"Color": C, "Normal": NORMAL}, {"BSDF": "s"}),
    "ShaderNodeBsdfTransparent": Kind({"Color": C}, {"BSDF": "s"}),
    "ShaderNodeEmission": Kind({"Color": C, "Strength": ("f", 0.0, 2.0)}, {"Emission": "s"}, weight=2.0),
    "ShaderNodeBackground": Kind({"Color": C, "Strength": ("f", 0.0, 2.0)}, {"Background": "s"}, weight=0.2),
    "ShaderNodeHoldout": Kind({}, {"Holdout": "s"}, weight=0.3),
    "ShaderNodeMixShader": Kind({"Fac": F, "Shader": ("s", 0, 0), "Shader_001": ("s", 0, 0)}, {"Shader": "s"}, weight=3.0),
    "ShaderNodeAddShader": Kind({"Shader": ("s", 0, 0), "Shader_001": ("s", 0, 0)}, {"Shader": "s"}),
}  # fmt: skip

DISPLACEMENTS = {
    "ShaderNodeDisplacement": Kind(
        {"Height": F, "Midlevel": F, "Scale": ("f", 0.0, 0.3), "Normal": NORMAL},
        {"Displacement": "v"},
        {"space": ("OBJECT", "WORLD")},
        always=("Height",),
    ),
    "ShaderNodeVectorDisplacement": Kind(
        {"Vector": C, "Midlevel": F, "Scale": ("f", 0.0, 0.3)},
        {"Displacement": "v"},
        {"space": ("TANGENT", "OBJECT", "WORLD")},
        always=("Vector",),
    ),
}
# Closures that are the same mathematics in both engines; others have tables in one of them.
EXACT = {
    "ShaderNodeBsdfDiffuse", "ShaderNodeBsdfTranslucent", "ShaderNodeBsdfTransparent", "ShaderNodeEmission",
    "ShaderNodeBackground", "ShaderNodeHoldout", "ShaderNodeMixShader", "ShaderNodeAddShader",
}  # fmt: skip
# Closures that pass on to others, and those that show what is behind.
MIXED = {"ShaderNodeMixShader", "ShaderNodeAddShader"}
CLEAR = MIXED | {"ShaderNodeBsdfTransparent", "ShaderNodeHoldout", "ShaderNodeBsdfRayPortal"}
