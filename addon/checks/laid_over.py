"""Faces of a mesh that overlap other faces of the mesh in one plane, with the same look and without equal corners.

Of the flat parts with such faces only the one that covers most of the picture is reported.
"""

import numpy as np

from .coincident import is_plain
from .facets import facets_of
from .finding import IN_ONE_PLANE, SHADOWED, Finding, Severity, told_number
from .framing import LEAST_SHARE, share_of_triangles
from .overlap import box_pairs, triangles_over
from .subject import step

_MOST_PAIRS = 8_000_000, 200_000  # thorough, quick
# Greatest distance between faces in one plane, in steps of single precision at their place.
_STEPS = 4.0
_SLIVER = 0.01  # least overlap of triangles, relative to the size of the smaller one


def check_laid_over(subject):
    """Yield findings of overlapping faces. Run it after check_double_faces, whose meshes it skips."""
    for number, mesh, looks in subject.shown_meshes():
        row = looks[0]
        if number in subject.doubled or not subject.seen_by_camera(row):
            continue
        facets = facets_of(subject, number, mesh).large()
        plain = [
            part
            for part in range(len(facets))
            if len(facets.faces[part]) > 1 and _is_plain(subject, subject.material(row, int(facets.slots[part])))
        ]
        parts = [
            (*_seen(subject, row, mesh, over), over, part)
            for part, over in _overlapping(mesh, facets, plain, _MOST_PAIRS[not subject.thorough])
        ]
        if not parts:
            continue
        share, place, over, part = max(parts, key=lambda found: found[0])
        yield Finding(
            "coincident",
            Severity.DIFFERENT if share >= LEAST_SHARE else Severity.HINT,
            f"{told_number(len(over), 'face')} lie in the same plane as others that they overlap: {SHADOWED}",
            "in Edit Mode delete those beneath, or move them a little",
            object=subject.name(row),
            mesh=mesh.name,
            material=subject.material_name(subject.material(row, int(facets.slots[part]))),
            others=subject.others(number),
            faces=len(over),
            place=place,
            weight=share,
            key=IN_ONE_PLANE,
        )


def _seen(subject, row, mesh, triangles):
    """Return (share of the picture that the triangles cover, a point on one of them)."""
    corners = mesh.positions[mesh.triangles[triangles]].astype(float)
    places = subject.world(row, corners.reshape(-1, 3)).reshape(-1, 3, 3)
    return share_of_triangles(subject.snapshot.camera, places), tuple(places[0].mean(axis=0).tolist())


def _is_plain(subject, material):
    return material >= 0 and is_plain(subject.traits[material])


def _overlapping(mesh, facets, parts, most):
    """Yield (part, its triangles that overlap an earlier one in the same plane) for all parts with such triangles."""
    if not parts:
        return
    faces = np.concatenate([facets.faces[part] for part in parts])
    group = np.repeat(parts, [len(facets.faces[part]) for part in parts])
    corners = mesh.positions[mesh.triangles[faces]].astype(float)
    low, high = corners.min(axis=1), corners.max(axis=1)
    pairs = box_pairs(low, high, most, group)
    if pairs is None or len(pairs[0]) == 0:
        return
    i, j = pairs
    axes = np.array([(1, 2), (0, 2), (0, 1)])[np.argmax(np.abs(facets.normals[group[i]]), axis=1)]
    flat = (np.take_along_axis(corners[number], axes[:, None, :], axis=2) for number in (i, j))
    size = (high - low).max(axis=1)
    over = triangles_over(*flat, _SLIVER * np.minimum(size[i], size[j]))
    i, j = i[over], j[over]
    normals = np.cross(corners[i, 1] - corners[i, 0], corners[i, 2] - corners[i, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    apart = np.abs(np.einsum("nk,nck->nc", normals, corners[j] - corners[i][:, :1])).max(axis=1, initial=0.0)
    j = np.unique(j[apart <= _STEPS * step(np.abs(corners).max())])
    for part in np.unique(group[j]).tolist():
        yield part, faces[j[group[j] == part]]
