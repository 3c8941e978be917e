"""Shading normals that point away from the geometric side of the surface."""

import numpy as np

from ..bindings.enums import Shading
from .edges import corner_keys, edge_faults, vertex_keys
from .finding import Finding, Severity, told_number
from .sides import corners, crossed, dots, lengths, middle

# Least share of the mesh's area: less is invisible, and slivers, whose direction is rounding, have hardly any area.
_SHARE = 1e-3
# Cosine of 91 degrees, so that rounding does not matter for exactly perpendicular normals.
_AWAY = -0.0175


def check_normals(subject):
    shown = [
        (number, mesh, next((row for row in looks if _shows_normals(subject, row)), None))
        for number, mesh, looks in subject.shown_meshes(whole=False)
        if mesh.normals is not None
    ]
    shown = [(number, mesh, row) for number, mesh, row in shown if row is not None]
    for number, mesh, row in shown if subject.thorough else _suspects(subject, shown):
        faces, asked = subject.sample(mesh)
        away, areas = _away(mesh, faces)
        # If all corners turn away, the face is lit from behind; if some do, light ends abruptly within the face.
        some, whole = away[0] | away[1] | away[2], away[0] & away[1] & away[2]
        if not some.any():
            continue
        some, total = some & ~whole, areas.sum()
        folds = _folds(mesh, faces, some)
        groups = [
            (severity, float(areas[bad].sum() / total) if total > 0.0 else 0.0, bad)
            for severity, bad in ((Severity.WRONG, some & ~folds), (Severity.WRONG, whole), (Severity.HINT, folds))
        ]
        groups = [group for group in groups if group[1] >= _SHARE]
        if not groups:
            continue
        severity, share, bad = max(groups, key=lambda group: group[:2])
        worst = np.flatnonzero(bad)[np.argmax(areas[bad])]
        count = round(bad.sum() * len(mesh.triangles) / asked)
        what, advice = _words(subject, number, mesh, severity, count, bad is whole)
        yield Finding(
            "normals",
            severity,
            what,
            advice,
            object=subject.name(row),
            mesh=mesh.name,
            others=subject.others(number),
            faces=count,
            place=subject.place(row, middle(mesh, np.arange(len(mesh.triangles))[faces][worst])),
            weight=share,
        )


def _suspects(subject, shown):
    """Return the meshes with a normal that points away in the sample. One batch for all meshes takes a tenth of the time."""
    if not shown:
        return []
    places, shading, owners = [], [], []
    for owner, (_, mesh, _) in enumerate(shown):
        faces, asked = subject.sample(mesh)
        triangles = mesh.triangles[faces]
        places.append(mesh.positions[triangles])
        shading.append(mesh.normals[triangles] if mesh.normals.ndim == 2 else mesh.normals[faces])
        owners.append(np.full(asked, owner))
    places, shading = np.concatenate(places), np.concatenate(shading)
    geometric = crossed(places[:, 0], places[:, 1], places[:, 2])
    away = (np.einsum("ijk,ik->ij", shading, geometric) < 0.0).any(axis=1)
    return [shown[owner] for owner in np.unique(np.concatenate(owners)[away])]


def _shows_normals(subject, row):
    if subject.instances.shadings[row] == Shading.FLAT:
        return False
    return any(subject.traits[number].scatters for number in subject.materials_of(row))


def _away(mesh, faces):
    """Return (masks of the faces whose normal points away, one for each of three corners; twice the areas)."""
    geometric = crossed(*corners(mesh, faces))
    areas = lengths(geometric)
    if mesh.normals.ndim == 2:
        triangles = mesh.triangles[faces]
        shading = [np.take(mesh.normals, triangles[:, corner], axis=0) for corner in range(3)]
    else:
        shading = [mesh.normals[faces, corner] for corner in range(3)]
    away = [dots(normals, geometric) < _AWAY * lengths(normals) * areas for normals in shading]
    return away, np.where(np.isfinite(areas), areas, 0.0)


def _folds(mesh, faces, bad):
    """Return a mask of the bad faces whose normals are valid smooth normals at folds of more than a right angle.

    At such a fold the mean normal turns away from some faces around the corner, in any engine, but never from all. A normal
    that turns away from all of them is a fault, and so is one between faces of opposite orientation.
    """
    folds = np.zeros(len(bad), bool)
    keys = vertex_keys(mesh.positions)
    chosen = np.arange(len(mesh.triangles))[faces][bad]
    near = np.flatnonzero(np.isin(keys, keys[mesh.triangles[chosen]])[mesh.triangles].any(axis=1))
    around = keys[mesh.triangles[near]]
    flipped = near[edge_faults(around).flipped]
    # Pair every corner of a bad face with every face that has a corner in the same position.
    around = around.reshape(-1)
    order = np.argsort(around)
    corner_places = keys[mesh.triangles[chosen]].reshape(-1)
    first = np.searchsorted(around[order], corner_places)
    count = np.searchsorted(around[order], corner_places, "right") - first
    corner = np.repeat(np.arange(len(corner_places)), count)
    face = near[order[np.arange(len(corner)) + np.repeat(first - np.cumsum(count) + count, count)] // 3]
    shading = mesh.normals[mesh.triangles[chosen]] if mesh.normals.ndim == 2 else mesh.normals[chosen]
    agrees = np.zeros(len(corner_places), bool)
    agrees[corner[dots(shading.reshape(-1, 3)[corner], crossed(*corners(mesh, face))) > 0.0]] = True
    folds[bad] = agrees.reshape(-1, 3).all(axis=1) & ~np.isin(chosen, flipped)
    return folds


def _words(subject, number, mesh, severity, count, whole):
    where = told_number(count, "face")
    if _has_flipped(subject, number, mesh):
        return (
            f"faces point in opposite directions, and smooth normals turn away on {where}",
            "in Edit Mode, Mesh > Normals > Recalculate Outside",
        )
    if whole:
        return (
            f"shading normals point into the surface on {where}, which light reaches only from behind",
            "clear custom split normals, or recalculate them",
        )
    if severity == Severity.WRONG:
        return (
            f"shading normals point away from the surface at some corners of {where}, which shows as dark patches",
            "clear custom normals, mark sharp edges or shade it flat",
        )
    return (
        f"smooth shading runs around folds of more than a right angle at {where}",
        "if dark patches show there, mark sharp edges or shade it flat",
    )


def _has_flipped(subject, number, mesh):
    if not subject.thorough and len(mesh.triangles) > 4096:
        return False
    return len(subject.cached("faults", number, lambda: edge_faults(corner_keys(mesh))).flipped) > 0
