"""Mesh attributes that materials read by name: UV maps, colours, tangents, coordinates before deformation."""

import bpy
import numpy as np

from ..bindings.enums import Domain
from ..bindings.snapshot import MeshAttribute
from .edges import at_vertices, edge_ends
from .islands import island_attribute
from .pointiness import pointiness_attribute
from .tangents import corner_tangents

TANGENT = "tangent:"
_NAMED = "named:"
# Requested like an attribute: the polygon of each triangle, for flat shading.
POLYGONS = "polygons:"
# Requested like an attribute: the rendered colours with their alpha, where a node gives no name.
RENDER_COLOR = "render color:"
# Names that Cycles gives to attributes of its own, even if the mesh has others of these names.
ISLANDS, POINTINESS, GENERATED = "random_per_island", "pointiness", "generated"
_DOMAINS = {"POINT": Domain.VERTEX, "EDGE": Domain.VERTEX, "FACE": Domain.FACE, "CORNER": Domain.CORNER}
# The attribute types that Cycles reads: the field that holds a value, the type of its numbers, and how many of them are used.
TYPES = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "BOOLEAN": ("value", bool, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT4": ("vector", np.float32, 4),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "QUATERNION": ("value", np.float32, 4),
}
# Since 5.0 a triangle across the seam of the spherical map is not stretched over all of it.
_JOINS_SEAM = bpy.app.version >= (5, 0)
if bpy.app.version >= (4, 1):
    TYPES["INT8"] = ("value", np.int32, 1)


def attribute_name(name):
    """Return the name of a Blender attribute in a snapshot, in which some names are reserved."""
    is_taken = (
        name in (GENERATED, ISLANDS, POINTINESS, POLYGONS, RENDER_COLOR)
        or name.startswith((TANGENT, _NAMED))
        or name.endswith(" ")
    )
    return _NAMED + name if is_taken else name


def tangents_name(uv_map):
    return TANGENT + attribute_name(uv_map)


def has_tangents(mesh):
    return any(attribute.name.startswith(TANGENT) for attribute in mesh.attributes)


def lacks_tangents(mesh, name):
    """Whether an exported mesh has no tangents of the UV map that a node of the core names."""
    return not any(attribute.name == TANGENT + name for attribute in mesh.attributes)


def named_attributes(wanted):
    """Return the names in Blender of the wanted attributes of a mesh, without those that Lancer computes."""
    own = (TANGENT, POLYGONS, RENDER_COLOR)
    return sorted(name_in_blender(name) for name in wanted if name != GENERATED and not name.startswith(own))


def name_in_blender(name):
    return name[len(_NAMED) :] if name.startswith(_NAMED) else name


def read_attributes(mesh, data, wanted, corners, faces, poll):
    """Return the wanted attributes that the mesh has. data: the MeshData read so far.

    corners, faces: Blender's corners and face of each triangle; None if every face is a triangle.
    """
    found = []
    for name in sorted(wanted - {POLYGONS}):
        poll()
        if name == GENERATED:
            found.append(generated_coordinates(mesh))
        elif name.startswith(TANGENT):
            found.append(_tangents(mesh, data, name, corners, poll))
        elif name == ISLANDS:
            found.append(island_attribute(mesh, name, data.triangles, poll))
        elif name == POINTINESS:
            found.append(pointiness_attribute(mesh, name, data.positions, poll))
        else:
            found.append(_named(mesh, name, corners, faces))
    return tuple(attribute for attribute in found if attribute is not None)


def _undeformed(mesh):
    """Return the positions before modifiers, (vertices, 3)."""
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("undeformed_co", places)
    return places.reshape(-1, 3)


def generated_coordinates(mesh, places=None):
    """Return the positions before modifiers, mapped to 0 to 1 over the texture space. places: those positions, if known."""
    middle, half = np.array(mesh.texspace_location), np.array(mesh.texspace_size)
    half = np.where(half == 0.0, 1.0, half)
    places = _undeformed(mesh) if places is None else places
    return MeshAttribute(GENERATED, (places - middle) / (2.0 * half) + 0.5, Domain.VERTEX)


def _tangents(mesh, data, name, corners, poll):
    """Return (x, y, z, sign) of the tangent along u at each corner; None if the mesh lacks the UV map."""
    layer = tangents_layer(mesh, name)
    if layer is not None:
        uvs = _at_corners(read_uv_map(layer), corners).reshape(-1, 3, 2)
    elif is_without_map(mesh, name):
        uvs = spherical_map(_undeformed(mesh), data.triangles)
    else:
        return None
    return MeshAttribute(name, corner_tangents(data.positions, data.triangles, data.normals, uvs, poll), Domain.CORNER)


def tangents_layer(mesh, name):
    uv_map = name_in_blender(name[len(TANGENT) :])
    return mesh.uv_layers.get(uv_map) if uv_map else render_uv_map(mesh)


def is_without_map(mesh, name):
    """Whether a spherical map may replace the UV map: the name is empty, and the mesh has no UV map."""
    return name == TANGENT and len(mesh.uv_layers) == 0


def spherical_map(places, triangles):
    """Return the longitude and latitude of triangles' corners seen from the origin, 0 to 1, (triangles, 3, 2)."""
    uvs = _spherical(places)[triangles]
    if _JOINS_SEAM:
        u = uvs[..., 0]
        u[(np.ptp(u, axis=1, keepdims=True) > 0.5) & (u < 0.5)] += 1.0
    return uvs


def _spherical(places):
    """Return longitude and latitude of positions seen from the origin, 0 to 1, (count, 2)."""
    x, y, z = places.T.astype(np.float32)
    length = np.sqrt(x * x + y * y + z * z)
    turn = np.where((x == 0.0) & (y == 0.0), 0.5, np.arctan2(x, y) / np.float32(2.0 * np.pi))
    height = np.arccos(np.clip(z / np.where(length > 0.0, length, 1.0), -1.0, 1.0)) / np.float32(np.pi)
    return np.where(length > 0.0, (0.5 - turn, 1.0 - height), 0.0).T.astype(np.float32)


def attribute_sources(mesh, wanted):
    """Yield the values of the mesh that read_attributes depends on, besides faces, positions and normals; None if missing."""
    for name in sorted(wanted - {POLYGONS}):
        if name == GENERATED:
            yield generated_coordinates(mesh).values
        elif name.startswith(TANGENT):
            layer = tangents_layer(mesh, name)
            if layer is not None:
                yield read_uv_map(layer)
            else:
                yield _undeformed(mesh) if is_without_map(mesh, name) else None
        elif name in (ISLANDS, POINTINESS):
            yield edge_ends(mesh)
        else:
            values, domain = _found(mesh, name) or (None, None)
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
    found = _found(mesh, name)
    if found is None:
        return None
    values, domain = found
    if domain == Domain.CORNER:
        values = _at_corners(values, corners)
    elif domain == Domain.FACE and faces is not None:
        values = values[faces]
    return MeshAttribute(name, values, domain)


def _found(mesh, name):
    """Return (values, domain) of a named attribute; None if the mesh lacks it or Cycles does not read its type."""
    if name == RENDER_COLOR:
        return _values(mesh, color_attribute(mesh))
    layer = mesh.uv_layers.get(name_in_blender(name))
    if layer is not None:
        return read_uv_map(layer), Domain.CORNER
    return _values(mesh, mesh.attributes.get(name_in_blender(name)))


def color_attribute(mesh):
    """Return the colour attribute for rendering, of any domain; None if the mesh has no colours."""
    found = mesh.attributes.get(getattr(mesh.attributes, "default_color_name", None) or "")
    if found is not None and found.data_type in ("FLOAT_COLOR", "BYTE_COLOR"):
        return found
    if len(mesh.color_attributes) == 0:
        return None
    # Files of old versions may have no attribute marked for rendering: take the first.
    index = mesh.color_attributes.render_color_index
    return mesh.color_attributes[index if 0 <= index < len(mesh.color_attributes) else 0]


def _values(mesh, attribute):
    if attribute is None or attribute.data_type not in TYPES or attribute.domain not in _DOMAINS or not len(attribute.data):
        return None
    field, dtype, width = TYPES[attribute.data_type]
    values = np.empty(len(attribute.data) * width, dtype)
    attribute.data.foreach_get(field, values)
    values = values.reshape(-1, width)
    values = at_vertices(mesh, attribute, values) if attribute.domain == "EDGE" else values.astype(np.float32)
    return values, _DOMAINS[attribute.domain]


def _at_corners(values, corners):
    return values if corners is None else values[corners.reshape(-1)]
