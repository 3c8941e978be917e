"""What differs between Blender versions: names of sockets, rules of closures; and the output nodes that renders use."""

import bpy

from ..bindings.enums import Rules

RULES = Rules.BLENDER_3 if bpy.app.version < (4, 0) else Rules.BLENDER_4 if bpy.app.version < (4, 5) else Rules.BLENDER_45
# Before 4.3 Blender's rough diffuse surface loses light: option of DIFFUSE and of the Principled BSDF.
DIFFUSE_OPTION = int(bpy.app.version >= (4, 3))
SMALLEST_IOR = 1e-5  # as Cycles takes smaller ones

_MUTED_OUTPUTS_ARE_OFF = bpy.app.version < (5, 0)

# Identifiers of the Principled BSDF, newest first; a name that a version lacks is simply not found.
PRINCIPLED = {
    "base_color": ("Base Color",),
    "metallic": ("Metallic",),
    "roughness": ("Roughness",),
    "ior": ("IOR",),
    "alpha": ("Alpha",),
    "diffuse_roughness": ("Diffuse Roughness",),
    "specular": ("Specular IOR Level", "Specular"),
    "specular_tint": ("Specular Tint",),
    "anisotropic": ("Anisotropic",),
    "anisotropic_rotation": ("Anisotropic Rotation",),
    "transmission": ("Transmission Weight", "Transmission"),
    "transmission_roughness": ("Transmission Roughness",),
    "coat": ("Coat Weight", "Clearcoat"),
    "coat_roughness": ("Coat Roughness", "Clearcoat Roughness"),
    "coat_ior": ("Coat IOR",),
    "coat_tint": ("Coat Tint",),
    "coat_normal": ("Coat Normal", "Clearcoat Normal"),
    "sheen": ("Sheen Weight", "Sheen"),
    "sheen_roughness": ("Sheen Roughness",),
    "sheen_tint": ("Sheen Tint",),
    "emission_color": ("Emission Color", "Emission"),
    "emission_strength": ("Emission Strength",),
    "subsurface": ("Subsurface Weight", "Subsurface"),
    "thin_film": ("Thin Film Thickness",),
    "thin_wall": ("Thin Wall",),
}


def find(node, identifiers):
    """The first enabled input with one of the identifiers; None where this Blender has none."""
    for identifier in identifiers:
        for socket in node.inputs:
            if socket.identifier == identifier and socket.enabled:
                return socket
    return None


def output_node(tree, kind):
    """The output node that Cycles takes: the active one of its type that is not for EEVEE alone; None where there is none."""
    node = tree.get_output_node("CYCLES")
    if node is not None and node.type != kind:
        nodes = [other for other in tree.nodes if other.type == kind and getattr(other, "target", "ALL") != "EEVEE"]
        node = next((other for other in nodes if other.is_active_output), nodes[0] if nodes else None)
    return None if node is None or (node.mute and _MUTED_OUTPUTS_ARE_OFF) else node
