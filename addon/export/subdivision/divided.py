"""Export of a mesh that is divided adaptively: triangles on the limit surface, and all that materials read of them."""

from dataclasses import replace

import bpy
import numpy as np

from ...bindings.abi import LancerError
from ...bindings.enums import Domain
from ...bindings.snapshot import MeshAttribute, MeshData
from ..arrays import built_in, read
from ..attributes import (
    GENERATED,
    POLYGONS,
    RENDER_COLOR,
    TANGENT,
    generated_coordinates,
    is_without_map,
    name_in_blender,
    read_attributes,
    read_uv_map,
    render_uv_map,
    spherical_map,
    tangents_layer,
)
from ..mesh import face_slots, read_positions
from ..tangents import corner_tangents
from .cage import patch_levels, read_cage, uv_cage
from .edge_table import Rate
from .limit_patches import LimitPatches
from .memory import BYTES_OF_TRIANGLE, most_triangles
from .patches import LinearPatches
from .pixel_size import pixel_size
from .splitting import TooManyTrianglesError, split_patches
from .tessellation import tessellate

# Before 4.5 each face has vertices of its own in Cycles, and its own normals at a crease.
_KEEPS_SIDES = bpy.app.version < (4, 5)
# Since 4.5 the tangents of a divided mesh without a UV map follow a spherical map; before, they are along x.
_HAS_SPHERICAL = bpy.app.version >= (4, 5)


def export_divided(mesh, name, poll, wanted, adaptive, camera, matrix, undeformed=None):
    """Return the MeshData of a mesh divided as its settings ask.

    name: of the object. wanted: as for export_mesh(). camera: the snapshot.Camera by whose pixels the mesh is divided.
    matrix: from the object to the world. undeformed: the positions before modifiers, if the mesh lacks them. Raise LancerError
    if the triangles would not fit into memory.
    """
    return _Divided(mesh, name, poll, wanted, adaptive, camera, matrix, undeformed).export()


class _Divided:
    def __init__(self, mesh, name, poll, wanted, adaptive, camera, matrix, undeformed=None):
        self._mesh, self._name, self._poll, self._wanted, self._adaptive = mesh, name, poll, wanted, adaptive
        self._positions, self._undeformed = read_positions(mesh), undeformed
        if adaptive.in_pixels:
            size = pixel_size(camera, adaptive.offscreen_scale)
            self._rate = Rate(adaptive.rate, adaptive.most_levels, np.asarray(matrix, float), size)
        else:
            self._rate = Rate(adaptive.rate, adaptive.most_levels)
        self._cage = read_cage(mesh, self._positions, adaptive, self._rate)
        self._levels = patch_levels(self._cage, self._rate)
        poll()

    def export(self):
        cage, poll = self._cage, self._poll
        if len(cage.corners) == 0:
            return MeshData(name=self._mesh.name, positions=self._positions)
        most = most_triangles(len(cage.corners))
        # The patches need memory before there are triangles.
        if most == 0:
            raise self._too_many(most)
        surface = self._surface()
        found = self._tessellation(surface, most)
        self._found, self._faces = found, np.repeat(np.arange(len(cage.starts) - 1), np.diff(cage.starts))
        at = found.patches[found.owners], found.uvs[found.owners]
        positions = surface.at(*at, poll).astype(np.float32)
        triangles = found.vertices[found.triangles]
        faces = self._faces[found.patches[found.triangles[:, 0]]]
        slots = face_slots(self._mesh)
        uv_map = render_uv_map(self._mesh)
        data = MeshData(
            name=self._mesh.name,
            positions=positions,
            triangles=triangles.astype(np.uint32),
            normals=self._normals(surface, at, positions, triangles, faces),
            uvs=None if uv_map is None else self._uvs(read_uv_map(uv_map))[found.triangles],
            material_slots=None if slots is None else np.clip(slots[faces], 0, 0xFFFF).astype(np.uint16),
            polygons=np.unique(faces, return_inverse=True)[1] if POLYGONS in self._wanted else None,
        )
        return self._with_attributes(data, faces)

    def _surface(self):
        if self._adaptive.smooth:
            return LimitPatches(self._cage, self._poll, self._levels)
        normals = read(self._mesh.vertices, "normal", np.float32, 3)[self._cage.corners]
        return LinearPatches(self._cage.values[self._cage.corners], self._cage, normals)

    def _tessellation(self, surface, most):
        try:
            table, quads, triangles = split_patches(surface, self._cage, self._rate, most, self._poll)
        except TooManyTrianglesError:
            raise self._too_many(most) from None
        return tessellate(table, quads, triangles, self._cage, self._poll)

    def _too_many(self, most):
        rate = f"{self._adaptive.rate:g} pixels" if self._adaptive.in_pixels else f"an edge length of {self._adaptive.rate:g}"
        size = most * BYTES_OF_TRIANGLE / 2**30
        return LancerError(
            f"object '{self._name}': adaptive subdivision by {rate} would make more than the {most} triangles for which "
            f"the {size:.1f} GB of free memory beside its {len(self._cage.starts) - 1} faces suffice: raise the dicing rate, "
            "or lower Max Subdivisions"
        )

    def _normals(self, surface, at, positions, triangles, faces):
        """Return the normals as MeshData has them: of the limit surface, but flat faces have those of their triangles."""
        flat = _flat_faces(self._mesh)
        if flat.all():
            return None
        rows = np.flatnonzero(flat[faces])
        if _KEEPS_SIDES and len(self._cage.creases):
            found = self._found
            corners = surface.normals(found.patches, found.uvs, self._poll).astype(np.float32)[found.triangles]
        else:
            normals = surface.normals(*at, self._poll).astype(np.float32)
            if len(rows) == 0:
                return normals
            corners = normals[triangles]
        places = positions[triangles[rows]].astype(float)
        across = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
        lengths = np.linalg.norm(across, axis=1, keepdims=True)
        corners[rows] = (across / np.where(lengths > 0.0, lengths, 1.0))[:, None]
        return corners

    def _uvs(self, values):
        """Return (points, 2), a UV map as the modifier smooths it. values: of Blender's corners."""
        rule = self._adaptive.uv_smooth
        if rule == "NONE" or not self._adaptive.smooth:
            patches = LinearPatches(values, self._cage)
        else:
            patches = LimitPatches(uv_cage(self._cage, values, rule), self._poll, self._levels)
        return self._at_points(patches)

    def _at_points(self, patches):
        return patches.at(self._found.patches, self._found.uvs, self._poll).astype(np.float32)

    def _with_attributes(self, data, faces):
        mesh, cage, poll = self._mesh, self._cage, self._poll
        # One point for each face stands for its triangles: attributes of faces are the same on all of them.
        first = MeshData(positions=self._positions, triangles=cage.corners[cage.starts[:-1], None].repeat(3, axis=1))
        tangents = {name for name in self._wanted if name.startswith(TANGENT)}
        plain = (self._wanted - tangents - {GENERATED}) | {RENDER_COLOR}
        corners = np.arange(len(cage.corners))
        found = read_attributes(mesh, first, plain, corners, np.arange(len(cage.starts) - 1), poll)
        if GENERATED in self._wanted:
            found = (*found, generated_coordinates(mesh, self._undeformed))
        attributes = [self._divided(attribute, faces) for attribute in found]
        for attribute in attributes:
            if attribute.name == RENDER_COLOR:
                data = replace(data, colors=_of_corners(attribute, data)[..., :3])
        attributes = [attribute for attribute in attributes if attribute.name in self._wanted]
        attributes += [attribute for name in sorted(tangents) for attribute in self._tangents(name, data)]
        return replace(data, attributes=tuple(sorted(attributes, key=lambda attribute: attribute.name)))

    def _tangents(self, name, data):
        """Yield the tangents of that name, if Cycles has them."""
        found, layer = self._found, tangents_layer(self._mesh, name)
        if layer is not None:
            # The points of a vertex that share their place on the map are one vertex to the tangents.
            positions = data.positions[found.vertices]
            has_sides = data.normals is None or data.normals.ndim == 3
            normals = data.normals if has_sides else data.normals[found.vertices]
            map_and_mesh = positions, found.triangles, normals, self._uvs(read_uv_map(layer))
        elif is_without_map(self._mesh, name):
            shape = (*data.triangles.shape, 2)
            uvs = spherical_map(data.positions, data.triangles) if _HAS_SPHERICAL else np.zeros(shape, np.float32)
            map_and_mesh = data.positions, data.triangles, data.normals, uvs
        else:
            return
        yield MeshAttribute(name, corner_tangents(*map_and_mesh, self._poll), Domain.CORNER)

    def _divided(self, attribute, faces):
        """Return an attribute of the cage on the triangles."""
        name, values, domain = attribute.name, np.asarray(attribute.values), attribute.domain
        found, cage, poll = self._found, self._cage, self._poll
        if domain == Domain.FACE:
            return MeshAttribute(name, values[faces], domain)
        if domain == Domain.CORNER:
            is_uv_map = self._mesh.uv_layers.get(name_in_blender(name)) is not None
            at = self._uvs(values) if is_uv_map else self._at_points(LinearPatches(values, cage))
            return MeshAttribute(name, at[found.triangles.reshape(-1)], domain)
        if name == GENERATED and self._adaptive.smooth:
            patches = LimitPatches(replace(cage, values=values.astype(float)), poll, self._levels)
        else:
            patches = LinearPatches(values[cage.corners], cage)
        at = patches.at(found.patches[found.owners], found.uvs[found.owners], poll)
        return MeshAttribute(name, at.astype(np.float32), domain)


def _of_corners(attribute, data):
    """Return (triangles, 3, channels)."""
    if attribute.domain == Domain.FACE:
        return np.repeat(attribute.values[:, None], 3, axis=1)
    if attribute.domain == Domain.VERTEX:
        return attribute.values[data.triangles]
    return attribute.values.reshape(len(data.triangles), 3, -1)


def _flat_faces(mesh):
    """Return whether each face is flat."""
    if hasattr(mesh, "normals_domain"):
        data = built_in(mesh, "sharp_face", "FACE")
        return np.zeros(len(mesh.polygons), bool) if data is None else read(data, "value", bool, 1)
    return ~read(mesh.polygons, "use_smooth", bool, 1)
