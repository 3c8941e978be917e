"""Meshes and exact shapes that Cycles shows otherwise: by what they lack for their materials, or by a rule of Cycles' own."""

import bpy
import numpy as np

from ..bindings.enums import Coordinate, MaterialFlag, NodeKind
from .arithmetic import is_constant
from .attributes import ISLANDS, POINTINESS, lacks_tangents, name_in_blender, named_attributes
from .coordinates import ALONG_U

_SMOOTHS_FLAT_FACES = (5, 0) <= bpy.app.version < (5, 2)
# The attributes that are outputs of the Geometry node.
_OUTPUTS = {ISLANDS: "Random Per Island", POINTINESS: "Pointiness"}
_EDGES = (Coordinate.EDGE_U, Coordinate.EDGE_V)
_KEEPS_CORNERS = bpy.app.version >= (5, 2)


def show_differences(materials):
    """Whether differences() depends on the mesh; without it, there are none."""
    return _are_displaced(materials) or _keep_normals(materials) or bool(_uv_maps_of_tangents(materials))


def differences(mesh, materials):
    """Return [(text, key)], for Messages.add, of an exported mesh and the materials of its slots."""
    found = []
    for name in _uv_maps_of_tangents(materials):
        if lacks_tangents(mesh, name):
            uv_map = name_in_blender(name)
            text = f"it has no UV map '{uv_map}' for tangents: anisotropic surfaces are even, Cycles shows them black"
            found.append((f"{text}; add the map, or choose another in the Tangent node", "feature:tangents without a UV map"))
    if _are_displaced(materials) and _has_creases(mesh):
        text = "displacement renews its normals otherwise than in Cycles at creases, custom normals and beside flat faces"
        remedy = "they agree where all faces are smooth and without custom normals"
        found.append((f"{text}; {remedy}", "feature:creases under displacement"))
    if _keep_normals(materials) and mesh.normals is None and _SMOOTHS_FLAT_FACES:
        text = "flat faces with Displacement and Bump stay flat, Cycles of this version smooths them"
        found.append((f"{text}; they agree where the faces are smooth", "feature:smooth bump of flat faces"))
    return found


def lost_by_exact_shape(wanted, materials):
    """Return the names of what the object's mesh would have and its exact shape lacks. wanted: names of attributes."""
    nodes = [node for material in materials for node in material.nodes]
    lost = ["displacement"] if _are_displaced(materials) else []
    if any(node.kind == NodeKind.WIREFRAME for node in nodes):
        lost.append("Wireframe")
    if any(node.kind == NodeKind.COORDINATE and node.option in _EDGES for node in nodes):
        lost.append("edges for the direction of hair")
    return [*lost, *(_OUTPUTS.get(name, f"attribute '{name}'") for name in named_attributes(wanted))]


def _uv_maps_of_tangents(materials):
    nodes = (node for material in materials for node in material.nodes if node.kind == NodeKind.TANGENT)
    return sorted({node.name for node in nodes if node.option == ALONG_U})


def _keep_normals(materials):
    return any(material.flags & int(MaterialFlag.KEEP_NORMALS) for material in materials)


def _are_displaced(materials):
    return any(not is_constant(material.displacement, 0.0) for material in materials)


def _has_creases(mesh):
    """Whether normals at corners are renewed by a rule of Cycles' own: all since 5.2, before those beside flat faces."""
    corners = mesh.normals
    if corners is None or np.ndim(corners) != 3:
        return False
    flat = (corners == corners[:, :1]).all(axis=(1, 2))
    return _KEEPS_CORNERS or bool(flat.any() and not flat.all())
