"""Mesh attributes that materials read by name: UV maps, colours, tangents, coordinates before deformation."""

import numpy as np

from ..bindings.enums import Domain
from ..bindings.snapshot import MeshAttribute
from .tangents import corner_tangents

_TANGENT = "tangent:"
_NAMED = "named:"
# Requested like an attribute: the polygon of each triangle, for flat shading.
POLYGONS = "polygons:"
_DOMAINS = {"POINT": Domain.VERTEX, "FACE": Domain.FACE, "CORNER": Domain.CORNER}
# Blender's attribute types: the field that holds a value, the type of its numbers, and how many of them are used.
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


def attribute_name(name):
    """Return the name of a Blender attribute in a snapshot, in which some names are reserved."""
    is_taken = name in ("generated", POLYGONS) or name.startswith((_TANGENT, _NAMED)) or name.endswith(" ")
    return _NAMED + name if is_taken else name


def tangents_name(uv_map):
    return _TANGENT + attribute_name(uv_map)


def named_attributes(wanted):
    """Return Blender's names of the wanted attributes, without generated coordinates, tangents and polygons."""
    own = (_TANGENT, POLYGONS)
    return sorted(_name_in_blender(name) for name in wanted if name != "generated" and not name.startswith(own))


def _name_in_blender(name):
    return name[len(_NAMED) :] if name.startswith(_NAMED) else name


def read_attributes(mesh, data, wanted, corners, faces, poll):
    """Return the wanted attributes that the mesh has. data: the MeshData read so far.

    corners, faces: Blender's corners and face of each triangle; None if every face is a triangle.
    """
    found = []
    for name in sorted(wanted - {POLYGONS}):
        poll()
        if name == "generated":
            found.append(_generated(mesh))
        elif name.startswith(_TANGENT):
            found.append(_tangents(mesh, data, name, corners, poll))
        else:
            found.append(_named(mesh, name, corners, faces))
    return tuple(attribute for attribute in found if attribute is not None)


def _generated(mesh):
    """Return the positions before modifiers, mapped to 0 to 1 over the texture space."""
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("undeformed_co", places)
    middle, half = np.array(mesh.texspace_location), np.array(mesh.texspace_size)
    half = np.where(half == 0.0, 1.0, half)
    return MeshAttribute("generated", (places.reshape(-1, 3) - middle) / (2.0 * half) + 0.5, Domain.VERTEX)


def _tangents(mesh, data, name, corners, poll):
    """Return (x, y, z, sign) of the tangent along u at each corner; None if the mesh lacks the UV map."""
    layer = _tangents_layer(mesh, name)
    if layer is None:
        return None
    uvs = _at_corners(read_uv_map(layer), corners).reshape(-1, 3, 2)
    return MeshAttribute(name, corner_tangents(data.positions, data.triangles, data.normals, uvs, poll), Domain.CORNER)


def _tangents_layer(mesh, name):
    uv_map = _name_in_blender(name[len(_TANGENT) :])
    return mesh.uv_layers.get(uv_map) if uv_map else render_uv_map(mesh)


def attribute_sources(mesh, wanted):
    """Yield the values of the mesh that read_attributes depends on, besides faces, positions and normals; None if missing."""
    for name in sorted(wanted - {POLYGONS}):
        if name == "generated":
            yield _generated(mesh).values
        elif name.startswith(_TANGENT):
            layer = _tangents_layer(mesh, name)
            yield None if layer is None else read_uv_map(layer)
        else:
            values, domain = _values(mesh, name) or (None, None)
            yield values
            yield domain


def render_uv_map(mesh):
    return next((layer for layer in mesh.uv_layers if layer.active_render), None)


def read_uv_map(layer):
    """Return (Blender's corners, 2)."""
    data, field = (layer.uv, "vector") if hasattr(layer, "uv") else (layer.data, "uv")
    values = np.empty(2 * len(data), np.float32)
    data.foreach_get(field, values)
    return values.reshape(-1, 2)


def _named(mesh, name, corners, faces):
    found = _values(mesh, name)
    if found is None:
        return None
    values, domain = found
    if domain == Domain.CORNER:
        values = _at_corners(values, corners)
    elif domain == Domain.FACE and faces is not None:
        values = values[faces]
    return MeshAttribute(name, values, domain)


def _values(mesh, name):
    """Return (values, domain) of a named attribute; None if the mesh lacks it or its type or domain is not supported."""
    layer = mesh.uv_layers.get(_name_in_blender(name))
    if layer is not None:
        return read_uv_map(layer), Domain.CORNER
    attribute = mesh.attributes.get(_name_in_blender(name))
    if attribute is None or attribute.data_type not in _TYPES or attribute.domain not in _DOMAINS or not len(attribute.data):
        return None
    field, dtype, width = _TYPES[attribute.data_type]
    values = np.empty(len(attribute.data) * width, dtype)
    attribute.data.foreach_get(field, values)
    return values.reshape(-1, width).astype(np.float32), _DOMAINS[attribute.domain]


def _at_corners(values, corners):
    return values if corners is None else values[corners.reshape(-1)]
