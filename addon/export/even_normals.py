"""Normals of meshes with a single instance under an uneven scale or shear, as in final renders of Cycles.

Cycles first transforms such a mesh to the world: there, each vertex has a normal of length 1, and faces interpolate these
normals. For other meshes, Cycles interpolates the object's normals and transforms the result. The core treats all meshes in the
second way, and accepts normals of any length: a normal divided by its length in the world gives the result of the first way.
"""

from dataclasses import replace

import numpy as np

from ..bindings.enums import InstanceKind
from .arithmetic import is_constant
from .attributes import has_tangents

# An unevenness below this limit turns no normal by more than the limit. Matrices of even scales have errors of
# single precision, 1e-7 per element.
_EVEN = 1e-5
_MESH = int(InstanceKind.MESH)


def with_even_normals(meshes, table, geometries, materials, known):
    """Return (meshes, table) with other normals for the meshes that Cycles transforms to the world.

    geometries: of each name of the table; equal for objects that share one geometry in Cycles. materials: by the table's slots.
    known: a dict in which a call keeps its results for the next one, which returns the same objects for the same meshes.
    """
    numbers = np.unique(np.array(geometries, np.int64).reshape(-1), return_inverse=True)[1][table.name_indices]
    alone = (np.bincount(numbers)[numbers] == 1) & (table.kinds == _MESH) if len(numbers) else np.zeros(0, bool)
    # Leave out instances that move: Cycles transforms none of them beforehand.
    for motion in table.motions:
        alone[motion.instances] = False
    alone &= np.array([mesh.moved_positions is None for mesh in meshes] or [True])[np.where(alone, table.meshes, 0)]
    rows = np.flatnonzero(alone)
    rows = rows[_are_uneven(np.asarray(table.matrices, float)[rows, :, :3])]
    before = dict(known)
    known.clear()
    if not len(rows):
        return meshes, table
    users = np.bincount(table.meshes[table.kinds == _MESH], minlength=len(meshes))
    result, mesh_numbers = list(meshes), np.array(table.meshes)
    for row in rows.tolist():
        number = int(mesh_numbers[row])
        mesh = meshes[number]
        # Tangents are computed from the object's own normals, whether or not Cycles transforms the mesh.
        if mesh.normals is None or has_tangents(mesh) or _is_displaced(table, row, materials):
            continue
        matrix = np.asarray(table.matrices[row], float)[:, :3]
        key = id(mesh), matrix.tobytes()
        # An entry keeps its mesh, whose address no other mesh then gets.
        found = before.get(key) or (mesh, replace(mesh, normals=_divided(mesh.normals, matrix)))
        known[key] = found
        moved = found[1]
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
    uneven = np.zeros(len(matrices), bool)
    # Singular values take long, and most matrices are even at a glance.
    left = np.flatnonzero(~_are_clearly_even(matrices))
    lengths = np.linalg.svd(matrices[left], compute_uv=False)
    # A turned matrix of single precision with a scale of 0 is flat up to its rounding.
    uneven[left] = (lengths[:, 2] > lengths[:, 0] * 2.0**-23) & (lengths[:, 0] > lengths[:, 2] * (1.0 + _EVEN))
    return uneven


def _are_clearly_even(matrices):
    """Whether the squares of the singular values differ by less than the limit: by Gershgorin's circles around their mean."""
    squares = np.einsum("nki,nkj->nij", matrices, matrices)
    mean = np.trace(squares, axis1=1, axis2=2)[:, None, None] / 3.0
    radius = np.abs(squares - mean * np.eye(3)).sum(axis=2).max(axis=1)
    return 2.0 * radius < 0.5 * _EVEN * mean[:, 0, 0]


def _divided(normals, matrix):
    """Each by its length in the world; all by the same number, so that they keep the length 1 about."""
    cofactors = np.linalg.inv(matrix).T
    cofactors /= abs(np.linalg.det(cofactors)) ** (1.0 / 3.0)
    lengths = np.linalg.norm(normals.astype(float) @ cofactors.T, axis=-1, keepdims=True)
    return (normals / np.where(lengths > 0.0, lengths, 1.0)).astype(np.float32)
