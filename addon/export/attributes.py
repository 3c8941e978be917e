"""Attributes of a mesh that materials ask for by name: UV maps, colours, tangents, coordinates before deformation."""

import numpy as np

from ..bindings.enums import Domain
from ..bindings.snapshot import MeshAttribute

_TANGENT = "tangent:"
_DOMAINS = {"POINT": Domain.VERTEX, "FACE": Domain.FACE, "CORNER": Domain.CORNER}
# Blender's types of attributes: the field that holds a value, its numbers, and how many of them are used.
_TYPES = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int32, 1),
    "BOOLEAN": ("value", bool, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
}


def read_attributes(mesh, wanted, corners, faces, poll):
    """Those of the wanted names that the mesh has. corners and faces: of each triangle; None where they are Blender's own."""
    found = []
    for name in sorted(wanted):
        poll()
        if name == "generated":
            found.append(_generated(mesh))
        elif name.startswith(_TANGENT):
            found.append(_tangents(mesh, name, corners))
        else:
            found.append(_named(mesh, name, corners, faces))
    return tuple(attribute for attribute in found if attribute is not None)


def _generated(mesh):
    """Places before modifiers moved them, 0 to 1 over the texture space."""
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("undeformed_co", places)
    middle, half = np.array(mesh.texspace_location), np.array(mesh.texspace_size)
    half = np.where(half == 0.0, 1.0, half)
    return MeshAttribute("generated", (places.reshape(-1, 3) - middle) / (2.0 * half) + 0.5, Domain.VERTEX)


def _tangents(mesh, name, corners):
    """(x, y, z, sign) along u at each corner; None where Blender cannot tell, as for faces of more than four corners."""
    uv_map = name[len(_TANGENT) :]
    layer = mesh.uv_layers.get(uv_map) if uv_map else next((item for item in mesh.uv_layers if item.active_render), None)
    if layer is None:
        return None
    try:
        mesh.calc_tangents(uvmap=layer.name)
    except RuntimeError:
        return None
    values = np.empty((len(mesh.loops), 4), np.float32)
    tangents, signs = np.empty(3 * len(mesh.loops), np.float32), np.empty(len(mesh.loops), np.float32)
    mesh.loops.foreach_get("tangent", tangents)
    mesh.loops.foreach_get("bitangent_sign", signs)
    mesh.free_tangents()
    values[:, :3], values[:, 3] = tangents.reshape(-1, 3), signs
    return MeshAttribute(name, _at_corners(values, corners), Domain.CORNER)


def _named(mesh, name, corners, faces):
    layer = mesh.uv_layers.get(name)
    if layer is not None:
        values = np.empty(2 * len(mesh.loops), np.float32)
        if hasattr(layer, "uv"):
            layer.uv.foreach_get("vector", values)
        else:
            layer.data.foreach_get("uv", values)
        return MeshAttribute(name, _at_corners(values.reshape(-1, 2), corners), Domain.CORNER)
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.data_type not in _TYPES or attribute.domain not in _DOMAINS or not len(attribute.data):
        return None
    field, dtype, width = _TYPES[attribute.data_type]
    values = np.empty(len(attribute.data) * width, dtype)
    attribute.data.foreach_get(field, values)
    values, domain = values.reshape(-1, width).astype(np.float32), _DOMAINS[attribute.domain]
    if domain == Domain.CORNER:
        values = _at_corners(values, corners)
    elif domain == Domain.FACE and faces is not None:
        values = values[faces]
    return MeshAttribute(name, values, domain)


def _at_corners(values, corners):
    return values if corners is None else values[corners.reshape(-1)]
