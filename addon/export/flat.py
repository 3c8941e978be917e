"""Objects that a scale of 0 flattens: messages for those that Cycles hides or shades black."""

import numpy as np

from ..bindings.enums import InstanceKind

_ROUNDOFF = 2.0**-50  # the core's limit for singular matrices
_TURNED = 2.0**-20  # below it single precision does not determine the sign


def report_flat(table, meshes, messages):
    """Add the messages for an InstanceTable; meshes: of the snapshot."""
    linear, numbers = table.matrices[:, :, :3], table.meshes
    is_mesh = table.kinds == InstanceKind.MESH
    usable = np.flatnonzero(is_mesh & np.isfinite(linear).all(axis=(1, 2)))
    flat = usable[is_singular(linear[usable])]
    if not len(flat):
        return
    users = np.bincount(numbers[is_mesh], minlength=len(meshes))
    cofactors = _cofactors(linear[flat])
    size = np.abs(cofactors).max(axis=(1, 2))
    turned = np.trace(cofactors, axis1=1, axis2=2) <= _TURNED * size
    names, firsts = np.unique(table.name_indices[flat], return_index=True)
    for name, first in zip(names, firsts, strict=True):
        if size[first] == 0.0:
            continue
        mesh = numbers[flat[first]]
        who = f"object '{table.names[name]}': is flat by a scale of 0"
        if users[mesh] > 1:
            messages.add(f"{who} and shares its mesh, Cycles leaves it out", "feature:flat object")
        elif _has_two_sides(meshes[mesh], cofactors[first]):
            messages.add(f"{who} and closed, Cycles has its two sides shadow each other", "feature:flat object")
        elif turned[first] and meshes[mesh].normals is not None:
            messages.add(f"{who} and smooth, Cycles turns its normals away from the light", "feature:flat object")


def _has_two_sides(mesh, cofactors):
    """Whether faces of the flattened mesh look both ways."""
    corners = mesh.positions[mesh.triangles].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # The rows of the cofactors are parallel to the direction that is lost.
    sides = normals @ cofactors[np.abs(cofactors).max(axis=1).argmax()]
    limit = _TURNED * np.abs(sides).max(initial=0.0)
    return bool((sides > limit).any() and (sides < -limit).any())


def is_singular(linear):
    """Whether each matrix of (count, 3, 3) is singular, independent of the lengths of its columns."""
    # Contiguous entries: a table may hold millions of matrices.
    a, b, c, d, e, f, g, h, i = np.ascontiguousarray(linear.reshape(-1, 9).T)
    volume = np.abs(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g))
    lengths = (a * a + d * d + g * g) * (b * b + e * e + h * h) * (c * c + f * f + i * i)
    return ~(volume > _ROUNDOFF * np.sqrt(lengths))


def _cofactors(linear):
    a, b, c = linear.transpose(2, 0, 1)
    return np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=2)
