"""Blender materials as lobes: Kd, Ks, roughness, IOR, emission and opacity."""

import bpy

from ..bindings import snapshot
from ..bindings.enums import LobeKind
from .messages import Messages
from .shader import ShaderReader
from .sockets import output_node, source

_DEFAULT = snapshot.Material(name="default grey", lobes=(snapshot.Lobe(LobeKind.LAMBERT, (0.8, 0.8, 0.8)),))

_LOBE_NAMES = {
    LobeKind.LAMBERT: "Diffuse Kd",
    LobeKind.BECKMANN: "Specular Ks",
    LobeKind.MIRROR: "Mirror",
    LobeKind.DIELECTRIC: "Glass",
    LobeKind.PHONG: "Phong Ks",
    LobeKind.BLINN_PHONG: "Blinn-Phong Ks",
}


class Materials:
    """Numbers the materials that objects ask for; each is read once."""

    def __init__(self, messages, override=None):
        self.messages = messages
        self.override = override
        self.list = []
        self._numbers = {}

    def number(self, material, asker):
        """The number of a material; None is the default grey, as everywhere in Blender. asker is the object's name."""
        material = self.override or material
        key = None if material is None else material.original.as_pointer()
        if key not in self._numbers:
            self._numbers[key] = len(self.list)
            self.list.append(_DEFAULT if material is None else export_material(material, self.messages, asker))
        return self._numbers[key]


def export_material(material, messages, asker=None):
    """asker is the object that is met first with the material: messages name it too."""
    who = f"material '{material.name}'" + ("" if asker is None else f" on object '{asker}'")
    own = material.lancer
    ambient = messages.color(own.ka, who, "ambient colour")
    if own.model != "NODES":
        lobes, emission, opacity = _own_model(own, who, messages), (0.0, 0.0, 0.0), 1.0
    elif bpy.app.version >= (5, 0) or material.use_nodes:
        lobes, emission, opacity = _from_nodes(material.node_tree, who, messages)
    else:
        color = messages.color(material.diffuse_color, who, "viewport colour")
        lobes, emission, opacity = (snapshot.Lobe(LobeKind.LAMBERT, color),), (0.0, 0.0, 0.0), 1.0
    return snapshot.Material(
        name=material.name,
        lobes=lobes,
        emission=emission,
        opacity=opacity,
        ambient=ambient,
        material_index=max(0, material.pass_index),
    )


def _own_model(own, who, messages):
    kd = messages.color(own.kd, who, "diffuse colour")
    ks = messages.color(own.ks, who, "specular colour")
    lobes = []
    if any(kd):
        lobes.append(snapshot.Lobe(LobeKind.LAMBERT, kd))
    if any(ks) and own.model == "KD_KS":
        roughness = messages.number(own.roughness, who, "roughness", 0.2, 0.0)
        ior = messages.number(own.ior, who, "IOR", 1.5, 1e-6)
        lobes.append(snapshot.Lobe(LobeKind.BECKMANN, ks, roughness=roughness, ior=ior))
    elif any(ks):
        kind = LobeKind.PHONG if own.model == "PHONG" else LobeKind.BLINN_PHONG
        shininess = messages.number(own.shininess, who, "shininess", 50.0, 0.0)
        lobes.append(snapshot.Lobe(kind, ks, shininess=shininess))
    return tuple(lobes)


def _from_nodes(tree, who, messages):
    black = (), (0.0, 0.0, 0.0), 1.0
    output = output_node(tree, "OUTPUT_MATERIAL") if tree is not None else None
    if output is None:
        messages.add(f"{who}: has no Material Output node, black is used")
        return black
    surface = source(output.inputs["Surface"])
    if source(output.inputs["Volume"]) is not None:
        messages.add(f"{who}: volumes are not supported")
        if surface is None:
            return (), (0.0, 0.0, 0.0), 0.0
    if source(output.inputs["Displacement"]) is not None:
        messages.add(f"{who}: displacement is not supported, the undisplaced surface is used")
    if surface is None:
        return black
    reader = ShaderReader(who, messages)
    reader.read(surface, 1.0)
    return reader.result()


def describe_material(material):
    """What a material becomes, as lines for its panel."""
    messages = Messages()
    exported = export_material(material, messages)
    lines = []
    for lobe in exported.lobes:
        text = f"{_LOBE_NAMES[lobe.kind]}: {_triple(lobe.color)}"
        if lobe.kind == LobeKind.BECKMANN:
            text += f", alpha {lobe.roughness:.3g}"
        if lobe.kind in (LobeKind.BECKMANN, LobeKind.DIELECTRIC):
            text += f", IOR {lobe.ior:.3g}"
        lines.append(text)
    if any(exported.emission):
        lines.append(f"Emission: {_triple(exported.emission)}")
    if exported.opacity < 1.0:
        lines.append(f"Opacity: {exported.opacity:.3g}")
    return lines + messages.lines()


def _triple(color):
    return " ".join(f"{c:.3g}" for c in color)
