"""Lines for a material's panel: the lobes that its nodes become."""

import math
from dataclasses import dataclass

from ..bindings.enums import LobeKind
from ..bindings.shading import NodeRef
from ..messages.messages import Messages
from .arithmetic import is_constant
from .images import NoPictures
from .materials import Exported, export_material
from .probe import probe

_NAMES = {
    LobeKind.LAMBERT: "Diffuse Kd",
    LobeKind.BECKMANN: "Specular Ks",
    LobeKind.MIRROR: "Mirror",
    LobeKind.DIELECTRIC: "Glass",
    LobeKind.PHONG: "Phong Ks",
    LobeKind.BLINN_PHONG: "Blinn-Phong Ks",
    LobeKind.DIFFUSE: "Rough diffuse Kd",
    LobeKind.GLOSSY: "Glossy Ks",
    LobeKind.GLASS: "Glass",
    LobeKind.REFRACTION: "Refraction",
    LobeKind.CONDUCTOR: "Metal Ks",
    LobeKind.SHEEN: "Sheen",
    LobeKind.TRANSLUCENT: "Translucent Kd",
    LobeKind.PRINCIPLED: "Principled",
    LobeKind.MINNAERT: "Minnaert Kd",
    LobeKind.TOON: "Toon",
    LobeKind.HAIR: "Hair",
    LobeKind.HAIR_FIBRE: "Hair absorption",
    LobeKind.SUBSURFACE: "Subsurface Kd",
}
_ROUGH = {
    LobeKind.DIFFUSE, LobeKind.GLOSSY, LobeKind.GLASS, LobeKind.REFRACTION, LobeKind.CONDUCTOR, LobeKind.SHEEN, LobeKind.HAIR,
    LobeKind.HAIR_FIBRE, LobeKind.SUBSURFACE,
}  # fmt: skip
_FACETS = {LobeKind.BECKMANN, LobeKind.GLOSSY, LobeKind.GLASS, LobeKind.REFRACTION, LobeKind.CONDUCTOR}
_REFRACTIVE = {
    LobeKind.BECKMANN,
    LobeKind.DIELECTRIC,
    LobeKind.GLASS,
    LobeKind.REFRACTION,
    LobeKind.HAIR_FIBRE,
    LobeKind.SUBSURFACE,
}
# Inputs of the Principled BSDF that are shown if they are not 0, with their names.
_PRINCIPLED = (
    ("metallic", "metallic"),
    ("transmission", "transmission"),
    ("coat", "coat"),
    ("sheen", "sheen"),
    ("diffuse_roughness", "diffuse roughness"),
    ("anisotropic", "anisotropic"),
    ("film_thickness", "thin film"),
    ("thin_wall", "thin wall"),
    ("subsurface", "subsurface"),
)


@dataclass(frozen=True)
class Description:
    lobes: tuple  # of lines: lobes, emission, transmittance, holdout, portals, displacement
    losses: tuple  # of lines: nodes and inputs that are left out or replaced, each once
    exported: Exported


def describe_material(material):
    messages = Messages()
    # Panels are drawn often: read no images.
    found = export_material(material, messages, None, NoPictures(), None)
    exported = found.material
    # The core splits only Principled lobes into several.
    layered = any(lobe.kind == LobeKind.PRINCIPLED for lobe in exported.lobes)
    seen = probe(exported) if layered else None
    if seen is None:
        seen, lines = exported, [line for lobe in exported.lobes for line in _lobe(lobe)]
    else:
        lines = [_probed(lobe) for lobe in seen.lobes]
    for value, name in ((seen.emission, "Emission"), (seen.transmittance, "Passes"), (exported.holdout, "Hole")):
        if not is_constant(value, 0.0):
            lines.append(f"{name}: {_told(value)}")
    lines += [f"Portal: {_told(portal.weight)}{', elsewhere' if portal.moves else ''}" for portal in exported.portals]
    if not is_constant(exported.displacement, 0.0):
        lines.append("Displacement: textured")
    losses = tuple(_without_owner(line, material) for line in messages)
    return Description(tuple(lines or ["Black"]), losses, found)


def _without_owner(line, material):
    """Return a message without the name of the material, which the panel shows."""
    text = line.removeprefix(f"material '{material.name}'").lstrip(":, ")
    return text[0].upper() + text[1:]


def _probed(lobe):
    """Return the line of a ProbedLobe: albedo, IOR, and roughness in the units of shader nodes."""
    text = f"{_NAMES[lobe.kind]}: {_told(lobe.albedo)}"
    if lobe.kind in _FACETS:
        text += f", roughness {_told(math.sqrt(lobe.alpha))}"
    if lobe.kind in _FACETS and lobe.ior != 1.0:
        text += f", IOR {_told(lobe.ior)}"
    return text


def _lobe(lobe):
    weight = "" if is_constant(lobe.weight, 1.0) else f", weight {_told(lobe.weight)}"
    if lobe.kind == LobeKind.PRINCIPLED:
        record = lobe.principled
        extras = [f"{name} {_told(getattr(record, field))}" for field, name in _PRINCIPLED if _shown(getattr(record, field))]
        yield f"Diffuse Kd: {_told(record.base_color)}{weight}"
        yield f"Specular Ks: roughness {_told(record.roughness)}, IOR {_told(record.ior)}, level {_told(record.specular)}"
        if extras:
            yield "Principled: " + ", ".join(extras)
        if _shown(record.emission):
            yield f"Emission: {_told(record.emission)}"
        return
    text = f"{_NAMES[lobe.kind]}: {_told(lobe.color)}{weight}"
    if lobe.kind == LobeKind.BECKMANN:
        text += f", alpha {_told(lobe.roughness)}"
    if lobe.kind in (LobeKind.PHONG, LobeKind.BLINN_PHONG):
        text += f", shininess {_told(lobe.shininess)}"
    if lobe.kind == LobeKind.MINNAERT:
        text += f", darkness {_told(lobe.shininess)}"
    if lobe.kind in _ROUGH:
        text += f", roughness {_told(lobe.roughness)}"
    if lobe.kind in _REFRACTIVE:
        text += f", IOR {_told(lobe.ior)}"
    if lobe.kind == LobeKind.TOON:
        text += f", size {_told(lobe.roughness)}, smooth {_told(lobe.roughness_across)}"
    if lobe.kind == LobeKind.SUBSURFACE:
        text += f", radius {_told(lobe.edge)}"
    if not is_constant(lobe.film_thickness, 0.0):
        text += f", thin film {_told(lobe.film_thickness)}"
    if not is_constant(lobe.normal, 0.0):
        text += ", normal mapped"
    yield text


def _shown(value):
    return not is_constant(value, 0.0)


def _told(value):
    if isinstance(value, NodeRef):
        return "textured"
    if isinstance(value, tuple):
        return f"{value[0]:.3g}" if len(set(value)) == 1 else " ".join(f"{c:.3g}" for c in value)
    return f"{value:.3g}"
