"""Faces of a mesh that lie over others of its faces in one plane, as far as they look alike and share no three corners."""

import numpy as np

from .coincident import is_plain
from .facets import mesh_facets
from .finding import IN_ONE_PLANE, SHADOWED, Finding, Harm, told_number
from .framing import LEAST_SHARE, share_of_triangles
from .overlap import box_pairs, triangles_over
from .subject import step

_MOST_PAIRS = 8_000_000, 200_000  # thorough, quick
# Faces lie in one plane where the corners of one are this many steps of their place from the other, at most.
_STEPS = 4.0
_SLIVER = 0.01  # of its size by which triangles overlap at least


def check_laid_over(subject):
    """Follows the check of double faces, whose meshes it leaves out."""
    for number, mesh, looks in subject.shown_meshes():
        row = looks[0]
        if number in subject.doubled or not subject.seen_by_camera(row):
            continue
        facets = subject.cached("facets", number, lambda mesh=mesh: mesh_facets(mesh))
        for part, faces in enumerate(facets.faces):
            material = subject.material(row, int(facets.slots[part]))
            if material < 0 or not is_plain(subject.traits[material]):
                continue
            corners = mesh.positions[mesh.triangles[faces]].astype(float)
            over = _overlapping(corners, facets.normals[part], _MOST_PAIRS[not subject.thorough])
            if len(over) == 0:
                continue
            places = subject.world(row, corners[over].reshape(-1, 3)).reshape(-1, 3, 3)
            share = share_of_triangles(subject.snapshot.camera, places)
            if share < LEAST_SHARE:
                continue
            yield Finding(
                "coincident",
                Harm.DIFFERENT,
                f"{told_number(len(over), 'face')} lie in the same plane as others that they overlap: {SHADOWED}",
                "in Edit Mode delete those beneath, or move them a little",
                object=subject.name(row),
                mesh=mesh.name,
                material=subject.material_name(material),
                others=subject.others(number),
                faces=len(over),
                place=tuple(places[0].mean(axis=0).tolist()),
                weight=share,
                key=IN_ONE_PLANE,
            )
            break


def _overlapping(corners, normal, most):
    """Numbers of the triangles, (n, 3, 3) and nearly in one plane, that overlap an earlier one exactly in its plane."""
    flat = np.delete(corners, np.argmax(np.abs(normal)), axis=2)
    low, high = corners.min(axis=1), corners.max(axis=1)
    pairs = box_pairs(low, high, most)
    if pairs is None or len(pairs[0]) == 0:
        return np.empty(0, int)
    i, j = pairs
    size = (high - low).max(axis=1)
    over = triangles_over(flat[i], flat[j], _SLIVER * np.minimum(size[i], size[j]))
    i, j = i[over], j[over]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    apart = np.abs(np.einsum("nk,nck->nc", normals[i], corners[j] - corners[i][:, :1])).max(axis=1)
    return np.unique(j[apart <= _STEPS * step(np.abs(corners).max(initial=0.0))])
