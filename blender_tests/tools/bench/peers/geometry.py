"""Meshes of a snapshot as vertex arrays of one material each, and their places."""

from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from addon.bindings.enums import InstanceKind, Shading

from . import Cannot

# Copies of one mesh are baked into world space if all together have at most this many triangles.
_MOST_BAKED = 2_000_000


@dataclass(frozen=True)
class Part:
    """Faces of one material: vertex arrays with common indices."""

    positions: np.ndarray  # (V, 3)
    triangles: np.ndarray  # (T, 3)
    normals: np.ndarray | None  # (V, 3); None: flat faces
    uvs: np.ndarray | None  # (V, 2)

    def placed(self, matrix):
        """Return the part in world space; the front side of faces stays outside under a mirroring matrix."""
        linear = matrix[:, :3]
        positions = self.positions @ linear.T + matrix[:, 3]
        triangles = self.triangles if np.linalg.det(linear) > 0 else self.triangles[:, ::-1]
        normals = self.normals
        if normals is not None:
            normals = normals @ np.linalg.inv(linear)
            normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        return Part(positions.astype(np.float32), triangles, normals, self.uvs)


@dataclass(frozen=True)
class Placed:
    """One part with its material in one or more places; kind is MESH, or that of an exact shape, which has no part."""

    name: str
    kind: int
    part: Part | None
    material: int
    matrices: tuple  # of (3, 4)


def placements(snapshot):
    """Return everything visible, a Placed for each part of a mesh and each material that it is used with."""
    table, groups = snapshot.instances, defaultdict(list)
    for index in range(len(table)):
        if table.hidden_from[index] or table.flags[index]:
            raise Cannot(f"object '{table.names[table.name_indices[index]]}' is hidden from some rays or a holdout")
        first = int(table.first_slots[index])
        slots = tuple(int(slot) for slot in table.slots[first : first + int(table.slot_counts[index])])
        kind = InstanceKind(int(table.kinds[index]))
        flat = kind == InstanceKind.MESH and table.shadings[index] == Shading.FLAT
        groups[kind, int(table.meshes[index]) if kind == InstanceKind.MESH else -1, slots, flat].append(index)
    for (kind, mesh_index, slots, flat), members in groups.items():
        name = table.names[table.name_indices[members[0]]]
        matrices = tuple(table.matrices[member] for member in members)
        if kind != InstanceKind.MESH:
            yield Placed(name, kind, None, slots[0], matrices)
            continue
        mesh = snapshot.meshes[mesh_index]
        for slot, part in _parts(mesh, flat):
            yield Placed(name, kind, part, slots[min(slot, len(slots) - 1)], matrices)


def is_baked(placed):
    return len(placed.matrices) == 1 or len(placed.matrices) * len(placed.part.triangles) <= _MOST_BAKED


def _parts(mesh, flat):
    slots = mesh.material_slots if mesh.material_slots is not None else np.zeros(len(mesh.triangles), np.uint16)
    for slot in np.unique(slots):
        yield int(slot), _part(mesh, slots == slot, flat)


def _part(mesh, chosen, flat):
    triangles = mesh.triangles[chosen].astype(np.int64)
    normals = None if flat else mesh.normals
    if mesh.uvs is None and (normals is None or normals.ndim == 2):
        return _compact(Part(mesh.positions, triangles, normals, None))
    # Corners of one vertex with different attributes become different vertices.
    corners = triangles.ravel()
    columns = [mesh.positions[corners]]
    if normals is not None:
        columns.append(normals[corners] if normals.ndim == 2 else normals[chosen].reshape(-1, 3))
    if mesh.uvs is not None:
        columns.append(mesh.uvs[chosen].reshape(-1, 2))
    rows = np.ascontiguousarray(np.concatenate(columns, axis=1, dtype=np.float32))
    keys = rows.view(np.dtype((np.void, rows.dtype.itemsize * rows.shape[1]))).ravel()
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    rows = rows[first]
    return Part(
        rows[:, :3],
        inverse.reshape(-1, 3),
        rows[:, 3:6] if normals is not None else None,
        rows[:, -2:] if mesh.uvs is not None else None,
    )


def _compact(part):
    """Return the part without the vertices that no face uses."""
    used, triangles = np.unique(part.triangles, return_inverse=True)
    if len(used) == len(part.positions):
        return part
    normals = None if part.normals is None else part.normals[used]
    return Part(part.positions[used], triangles.reshape(-1, 3), normals, None)
