"""Differences between Blender versions: socket names and closure rules; and the output node that renders use."""

import bpy

from ..bindings.enums import Rules

_SINCE = {
    (5, 2): Rules.BLENDER_52, (5, 0): Rules.BLENDER_50, (4, 5): Rules.BLENDER_45, (4, 0): Rules.BLENDER_4,
    (0, 0): Rules.BLENDER_3,
}  # fmt: skip
RULES = next(rules for version, rules in _SINCE.items() if bpy.app.version >= version)
# Option of DIFFUSE and of the Principled BSDF: before 4.3 Blender's rough diffuse surface loses light.
DIFFUSE_OPTION = int(bpy.app.version >= (4, 3))
# From 5.0 on Blender itself evaluates nodes of constant inputs, before Cycles reads them.
EVALUATES_CONSTANTS = bpy.app.version >= (5, 0)
SMALLEST_IOR = 1e-5  # Cycles clamps to it

_MUTED_OUTPUTS_ARE_OFF = bpy.app.version < (5, 0)

# Node types of which every input has its identifier as its name.
_NAMED_BY_IDENTIFIER = {"ShaderNodeBsdfPrincipled"}

# Socket identifiers of the Principled BSDF, newest first; versions may lack some.
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
    "subsurface_anisotropy": ("Subsurface Anisotropy",),
    "film_thickness": ("Thin Film Thickness",),
    "film_ior": ("Thin Film IOR",),
    "thin_wall": ("Thin Wall",),
}


def find(node, identifiers):
    """Return the first enabled input with one of the identifiers; None if this Blender has none."""
    inputs = node.inputs
    for identifier in identifiers:
        # Most sockets have their identifier as their name, by which Blender finds them at once.
        named = inputs.get(identifier)
        if named is not None and named.identifier == identifier:
            if named.enabled:
                return named
            continue
        if named is None and node.bl_idname in _NAMED_BY_IDENTIFIER:
            continue
        for socket in inputs:
            if socket.identifier == identifier and socket.enabled:
                return socket
    return None


def output_node(tree, kind):
    """Return the output node that Cycles uses: the active one of its type that is not for EEVEE alone; None if missing."""
    node = tree.get_output_node("CYCLES")
    if node is not None and node.type != kind:
        nodes = [other for other in tree.nodes if other.type == kind and getattr(other, "target", "ALL") != "EEVEE"]
        node = next((other for other in nodes if other.is_active_output), nodes[0] if nodes else None)
    return None if node is None or (node.mute and _MUTED_OUTPUTS_ARE_OFF) else node
