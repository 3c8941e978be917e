"""Normals of meshes that stand in one place alone, under an uneven scale or shear, as final renders of Cycles have them.

Cycles moves such a mesh into the world first: each vertex then has a normal of length 1, and faces interpolate these. Of other
meshes it interpolates the object's normals and moves the result. The core does the latter with all meshes, with normals of any
length: a normal divided by its length in the world counts as much as Cycles' own.
"""

from dataclasses import replace

import numpy as np

from ..bindings.enums import InstanceKind
from .arithmetic import is_constant
from .attributes import has_tangents

# An unevenness below this turns no normal by more; matrices of even scales are single precision, 1e-7 an element.
_EVEN = 1e-5
_MESH = int(InstanceKind.MESH)


def with_even_normals(meshes, table, geometries, materials):
    """(meshes, table) with other normals for what Cycles moves into the world.

    geometries: of each name of the table, equal for objects of one geometry of Cycles. materials: by the table's slots.
    """
    numbers = np.unique(np.array(geometries, np.int64).reshape(-1), return_inverse=True)[1][table.name_indices]
    alone = (np.bincount(numbers)[numbers] == 1) & (table.kinds == _MESH) if len(numbers) else np.zeros(0, bool)
    rows = np.flatnonzero(alone)
    rows = rows[_are_uneven(np.asarray(table.matrices, float)[rows, :, :3])]
    users = np.bincount(table.meshes[table.kinds == _MESH], minlength=len(meshes))
    result, mesh_numbers = list(meshes), np.array(table.meshes)
    for row in rows.tolist():
        number = int(mesh_numbers[row])
        mesh = meshes[number]
        # Tangents are laid across the object's own normals, whatever Cycles does with the mesh.
        if mesh.normals is None or has_tangents(mesh) or _is_displaced(table, row, materials):
            continue
        moved = replace(mesh, normals=_divided(mesh.normals, np.asarray(table.matrices[row], float)[:, :3]))
        if users[number] == 1:
            result[number] = moved
        else:
            mesh_numbers[row] = len(result)
            result.append(moved)
    return result, replace(table, meshes=mesh_numbers)


def _is_displaced(table, row, materials):
    first = int(table.first_slots[row])
    slots = table.slots[first : first + int(table.slot_counts[row])]
    return any(not is_constant(materials[slot].displacement, 0.0) for slot in slots)


def _are_uneven(matrices):
    """Of (n, 3, 3), without those that are flat."""
    lengths = np.linalg.svd(matrices, compute_uv=False)
    return (lengths[:, 2] > 0.0) & (lengths[:, 0] > lengths[:, 2] * (1.0 + _EVEN))


def _divided(normals, matrix):
    """Each by its length in the world; all by the same number, so that they keep the length 1 about."""
    cofactors = np.linalg.inv(matrix).T
    cofactors /= abs(np.linalg.det(cofactors)) ** (1.0 / 3.0)
    lengths = np.linalg.norm(normals.astype(float) @ cofactors.T, axis=-1, keepdims=True)
    return (normals / np.where(lengths > 0.0, lengths, 1.0)).astype(np.float32)
