"""Glass that is open, non-manifold or inside out: refraction requires closed bodies with consistent orientation."""

import numpy as np

from .edges import corner_keys, edge_faults, is_balanced, shells
from .finding import Finding, Severity, told_number

_LARGEST_FOR_SHELLS = 400_000
_MOST_TURNED = 256


def check_glass(subject):
    for number, mesh, looks in subject.shown_meshes(where=lambda traits: traits.refracts):
        found = ((row, subject.faces_with(mesh, row, lambda traits: traits.refracts)) for row in looks)
        row, clear = next(((row, clear) for row, clear in found if np.any(clear)), (None, None))
        if row is None:
            continue
        keys = corner_keys(mesh)
        if is_balanced(keys):
            yield from _check_turned(subject, number, mesh, row, keys, clear)
        else:
            yield from _check_edges(subject, number, mesh, row, keys, clear)


def _finding(subject, number, mesh, row, what, advice, faces, at):
    clear = next(n for n in subject.materials_of(row) if subject.traits[n].refracts)
    return Finding(
        "glass",
        Severity.WRONG,
        what,
        advice,
        object=subject.name(row),
        mesh=mesh.name,
        material=subject.material_name(clear),
        others=subject.others(number),
        faces=faces,
        place=subject.place(row, mesh.positions[mesh.triangles[at]].astype(float).mean(axis=0)),
        weight=faces / len(mesh.triangles),
    )


def _check_edges(subject, number, mesh, row, keys, clear):
    faults = subject.cached("faults", number, lambda: edge_faults(keys))
    of_glass = np.broadcast_to(clear, len(mesh.triangles))
    for faces, words, advice in (
        (
            faults.open,
            "glass is open at {}: light that enters there does not come out again",
            "close the mesh, or give it thickness with a Solidify modifier",
        ),
        (
            faults.flipped,
            "glass faces point in opposite directions at {}: inside and outside are confused",
            "in Edit Mode, Mesh > Normals > Recalculate Outside",
        ),
        (
            faults.shared,
            "more than two glass faces meet at {}: inside and outside are undefined",
            "delete faces within the body",
        ),
    ):
        faces = faces[of_glass[faces]]
        if len(faces):
            what = words.format(told_number(len(faces), "edge"))
            yield _finding(subject, number, mesh, row, what, advice, len(np.unique(faces)), faces[0])


def _check_turned(subject, number, mesh, row, keys, clear):
    """Yield a finding of closed bodies whose faces point inward, except cavities inside another body of the mesh."""
    corners = mesh.positions.astype(float)[mesh.triangles]
    corners = corners - corners[0, 0]
    # Six times the volume between each face and one point.
    volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    if not subject.thorough or len(volumes) > _LARGEST_FOR_SHELLS:
        turned = _is_negative(volumes)
        bodies = np.zeros(len(volumes), int) if turned else None
        inward = [0] if turned else []
    else:
        _, bodies = np.unique(shells(keys), return_inverse=True)
        inward = _turned_bodies(corners, volumes, bodies)
    faces = np.flatnonzero(np.isin(bodies, inward) & clear) if len(inward) else ()
    if len(faces):
        yield _finding(
            subject,
            number,
            mesh,
            row,
            f"glass is inside out: {told_number(len(faces), 'face')} of a closed body point inward, as if it were air in glass",
            "in Edit Mode, Mesh > Normals > Flip",
            len(faces),
            faces[0],
        )


def _is_negative(volumes):
    """Whether the sum is below zero by more than its rounding, 2^-24 per term for single-precision positions."""
    return volumes.sum() < -(2.0**-24) * np.abs(volumes).sum()


def _turned_bodies(corners, volumes, bodies):
    count = int(bodies.max()) + 1
    volume, size = np.bincount(bodies, volumes, count), np.bincount(bodies, np.abs(volumes), count)
    negative = np.flatnonzero(volume < -(2.0**-24) * size)[:_MOST_TURNED]
    if len(negative) == 0:
        return negative
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, bodies, corners.min(axis=1))
    np.maximum.at(high, bodies, corners.max(axis=1))
    solid = np.flatnonzero(volume > 0.0)
    within = ((low[negative][:, None] > low[solid]) & (high[negative][:, None] < high[solid])).all(axis=2).any(axis=1)
    return negative[~within]
