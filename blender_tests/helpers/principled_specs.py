"""Pairs of a shader node for Cycles and the equal lobe for Lancer, one list for each family of rules."""

import math

from addon.bindings.enums import Distribution, LobeKind, Rules
from addon.bindings.shading import Lobe, Principled

ANGLES = (5.0, 30.0, 60.0, 75.0, 85.0)
ROUGHNESSES = (0.1, 0.3, 0.6, 1.0)
# Directions to the suns: around the mirror direction of each angle, beside it, and far from it.
SUNS = [
    (math.sin(math.radians(theta)) * math.cos(math.radians(phi)), math.sin(math.radians(theta)) * math.sin(math.radians(phi)),
     math.cos(math.radians(theta)))
    for theta, phi in ((5, 40), (30, 20), (55, -35), (62, 5), (80, 60), (120, 8), (140, -3), (40, 170))
]  # fmt: skip

# Field of the record -> socket, or a function of the value if the meaning differs.
_SOCKETS_4 = {
    "base_color": "Base Color", "metallic": "Metallic", "roughness": "Roughness", "ior": "IOR",
    "diffuse_roughness": "Diffuse Roughness", "specular": "Specular IOR Level", "specular_tint": "Specular Tint",
    "anisotropic": "Anisotropic", "anisotropic_rotation": "Anisotropic Rotation", "transmission": "Transmission Weight",
    "coat": "Coat Weight", "coat_roughness": "Coat Roughness", "coat_ior": "Coat IOR", "coat_tint": "Coat Tint",
    "sheen": "Sheen Weight", "sheen_roughness": "Sheen Roughness", "sheen_tint": "Sheen Tint", "emission": "Emission Color",
}  # fmt: skip
_SOCKETS_3 = {
    **_SOCKETS_4, "specular": "Specular", "transmission": "Transmission", "transmission_roughness": "Transmission Roughness",
    "coat": "Clearcoat", "coat_roughness": "Clearcoat Roughness", "sheen": "Sheen", "emission": "Emission",
}  # fmt: skip

_RED = (0.8, 0.3, 0.1)

# Differences from an opaque plastic of that roughness; {r} stands for each of ROUGHNESSES.
_LAYERS_4 = {
    "plastic": dict(base_color=_RED),
    "plastic, single": dict(base_color=_RED, distribution=Distribution.GGX),
    "plastic, coloured": dict(base_color=_RED, specular=0.9, specular_tint=(0.2, 0.9, 1.0), ior=1.8),
    "black, low ior": dict(base_color=(0.0, 0.0, 0.0), ior=1.1),
    "below air": dict(base_color=_RED, ior=0.8),
    "metal": dict(base_color=_RED, metallic=1.0),
    "metal, single": dict(base_color=_RED, metallic=1.0, distribution=Distribution.GGX),
    "metal, edge": dict(base_color=(0.9, 0.6, 0.2), metallic=1.0, specular_tint=(0.3, 0.6, 1.0)),
    "metal, brushed": dict(base_color=_RED, metallic=1.0, anisotropic=0.7),
    "metal, brushed and turned": dict(base_color=_RED, metallic=1.0, anisotropic=0.5, anisotropic_rotation=0.15),
    "half metal": dict(base_color=_RED, metallic=0.4),
    "glass": dict(base_color=_RED, transmission=1.0, ior=1.45),
    "glass, single": dict(base_color=_RED, transmission=1.0, ior=1.45, distribution=Distribution.GGX),
    "half glass": dict(base_color=_RED, transmission=0.5, ior=1.3, specular_tint=(0.5, 1.0, 0.5)),
    "coat": dict(base_color=_RED, roughness=0.5, coat=1.0, coat_roughness="{r}"),
    "coat, coloured": dict(base_color=_RED, coat=0.7, coat_roughness=0.2, coat_ior=1.8, coat_tint=(0.2, 0.5, 0.9)),
    "cloth": dict(base_color=_RED, sheen=1.0, sheen_roughness="{r}", roughness=0.8),
    "cloth, coloured": dict(base_color=_RED, sheen=0.6, sheen_tint=(0.2, 0.3, 1.0), coat=0.5, sheen_roughness=0.4),
    "lamp": dict(base_color=_RED, coat=0.8, sheen=0.5, emission=(0.5, 1.0, 2.0)),
}
_CHALK = {"chalk": dict(base_color=_RED, diffuse_roughness="{r}", roughness=0.4)}
_LAYERS_3 = {
    "plastic": dict(base_color=_RED),
    "plastic, coloured": dict(base_color=_RED, specular=0.9, specular_tint=0.7),
    "no gloss": dict(base_color=_RED, specular=0.0),
    "metal": dict(base_color=_RED, metallic=1.0),
    "metal, brushed": dict(base_color=_RED, metallic=1.0, anisotropic=0.7),
    "half metal": dict(base_color=_RED, metallic=0.4),
    "glass": dict(base_color=_RED, transmission=1.0, ior=1.45, transmission_roughness=0.3),
    "half glass": dict(base_color=_RED, transmission=0.5, ior=1.3, specular_tint=0.5),
    "coat": dict(base_color=_RED, coat=1.0, coat_roughness="{r}", roughness=0.5),
    "dust": dict(base_color=_RED, sheen=1.0, sheen_tint=0.4),
    "lamp": dict(base_color=_RED, coat=0.8, sheen=0.5, emission=(0.5, 1.0, 2.0)),
}


def _principled(rules, fields):
    base = dict(distribution=Distribution.MULTI_GGX, rules=rules)
    if rules == Rules.BLENDER_3:
        base.update(distribution=Distribution.GGX, option=0, coat_roughness=0.03, specular_tint=0.0, sheen_tint=0.5, ior=1.45)
    return Principled(**{**base, **fields})


def _node(rules, fields):
    sockets = _SOCKETS_3 if rules == Rules.BLENDER_3 else _SOCKETS_4
    inputs = {sockets[name]: value for name, value in fields.items() if name != "distribution"}
    if "emission" in fields:
        inputs["Emission Strength"] = 1.0
    if "ior" not in fields:
        inputs["IOR"] = 1.45 if rules == Rules.BLENDER_3 else 1.5
    default = Distribution.GGX if rules == Rules.BLENDER_3 else Distribution.MULTI_GGX
    multi = fields.get("distribution", default) == Distribution.MULTI_GGX
    return {
        "node": "ShaderNodeBsdfPrincipled",
        "inputs": inputs,
        "properties": {"distribution": "MULTI_GGX" if multi else "GGX"},
        "tangent": "anisotropic" in fields,
    }


def _filled(fields, roughness):
    filled = {name: roughness if value == "{r}" else value for name, value in fields.items()}
    filled.setdefault("roughness", roughness)
    return filled


def _layered(rules, layers):
    for name, fields in layers.items():
        for roughness in ROUGHNESSES:
            filled = _filled(fields, roughness)
            tangent = (1.0, 0.0, 0.0) if "anisotropic" in filled else (0.0, 0.0, 0.0)
            lobe = Lobe(kind=LobeKind.PRINCIPLED, principled=_principled(rules, filled), tangent=tangent)
            yield f"{name}, {roughness}", _node(rules, filled), lobe


def _alone(version, rules):
    """Yield the wide lobes and Ashikhmin-Shirley, which have shader nodes of their own."""
    preserving = int(version >= (4, 3))
    for r in ROUGHNESSES:
        color = {"Color": _RED, "Roughness": r}
        yield (
            f"Diffuse, {r}",
            {"node": "ShaderNodeBsdfDiffuse", "inputs": color},
            Lobe(kind=LobeKind.DIFFUSE, color=_RED, roughness=r, option=preserving, rules=rules),
        )
        yield (
            f"Ashikhmin-Shirley, {r}",
            {
                "node": "ShaderNodeBsdfAnisotropic" if version < (4, 0) else "ShaderNodeBsdfGlossy",
                "inputs": {**color, "Anisotropy": 0.4},
                "properties": {"distribution": "ASHIKHMIN_SHIRLEY"},
                "tangent": True,
            },
            Lobe(
                kind=LobeKind.GLOSSY, color=_RED, roughness=r, anisotropy=0.4, tangent=(1.0, 0.0, 0.0), rules=rules,
                distribution=Distribution.ASHIKHMIN_SHIRLEY,
            ),
        )  # fmt: skip
        velvet = {"Color": _RED, "Sigma": r} if version < (4, 0) else color
        node = {"node": "ShaderNodeBsdfVelvet" if version < (4, 0) else "ShaderNodeBsdfSheen", "inputs": velvet}
        kinds = (Distribution.BECKMANN,) if version < (4, 0) else (Distribution.GGX, Distribution.BECKMANN)
        for kind in kinds:
            name = "Velvet" if kind == Distribution.BECKMANN else "Sheen"
            if version >= (4, 0):
                node = {**node, "properties": {"distribution": "ASHIKHMIN" if name == "Velvet" else "MICROFIBER"}}
            yield f"{name}, {r}", node, Lobe(kind=LobeKind.SHEEN, color=_RED, roughness=r, distribution=kind, rules=rules)
    translucent = {"node": "ShaderNodeBsdfTranslucent", "inputs": {"Color": _RED}}
    yield "Translucent", translucent, Lobe(kind=LobeKind.TRANSLUCENT, color=_RED, rules=rules)


def specs(version):
    """Return (name, node, lobe) for a version of Blender."""
    if version < (4, 0):
        return list(_alone(version, Rules.BLENDER_3)) + list(_layered(Rules.BLENDER_3, _LAYERS_3))
    since = {(5, 2): Rules.BLENDER_52, (5, 0): Rules.BLENDER_50, (4, 5): Rules.BLENDER_45, (0, 0): Rules.BLENDER_4}
    rules = next(rules for first, rules in since.items() if version >= first)
    layers = _LAYERS_4 if version < (4, 3) else {**_LAYERS_4, **_CHALK}
    return list(_alone(version, rules)) + list(_layered(rules, layers))
