"""Large flat faces with smooth normals that differ from the face's normal.

Directions below such a face but above the horizon of its shading normal are found only by sampling lights, never by sampling
the BSDF. With multiple importance sampling the light from these directions depends on the engine's pdf of sampling its lights,
so that lamps with an extent look different between engines.
"""

import numpy as np

from ..bindings.enums import LightKind, Shading
from .facets import facets_of
from .finding import Finding, Severity, told_number
from .framing import share_of_triangles
from .sides import corners, crossed, dots, lengths

# Least shares of the mesh's area and of the picture: smaller faces have no visible effect.
_SHARE, _SHARE_OF_PICTURE = 0.05, 0.02
_LEAN = np.cos(np.radians(10.0))


def check_round_faces(subject):
    if not _has_lamps_with_extent(subject):
        return
    for number, mesh, looks in subject.shown_meshes():
        row = next((row for row in looks if _shows(subject, row)), None)
        if mesh.normals is None or row is None:
            continue
        facets = facets_of(subject, number, mesh)
        faces, cosine = _round(mesh, facets)
        if len(faces) == 0:
            continue
        places = subject.world(row, mesh.positions[mesh.triangles[faces]].reshape(-1, 3)).reshape(-1, 3, 3)
        share = share_of_triangles(subject.snapshot.camera, places)
        if share < _SHARE_OF_PICTURE:
            continue
        angle = np.degrees(np.arccos(cosine))
        yield Finding(
            "normals",
            Severity.HINT,
            f"{told_number(len(faces), 'flat face')} are shaded as if they were round, by {angle:.0f} degrees at the corners: "
            "light along them may differ from Cycles' by a few percent",
            "add a Weighted Normal modifier, or shade it smooth by angle",
            object=subject.name(row),
            mesh=mesh.name,
            others=subject.others(number),
            faces=len(faces),
            place=tuple(places[0].mean(axis=0).tolist()),
            weight=share,
            key="feature:smooth shading of large flat faces",
        )


def _has_lamps_with_extent(subject):
    lamps = any(light.kind == LightKind.AREA and any(light.emission) and not light.opening for light in subject.snapshot.lights)
    return lamps or any(subject.traits[number].emits for number in set(subject.instances.slots.tolist()))


def _shows(subject, row):
    if subject.instances.shadings[row] == Shading.FLAT or not subject.seen_by_camera(row):
        return False
    return any(subject.traits[number].scatters for number in subject.materials_of(row))


def _round(mesh, facets):
    """Return (triangles of large flat parts whose normals lean, mean cosine at their corners)."""
    geometric = crossed(*corners(mesh))
    areas = lengths(geometric)
    least = _SHARE * areas.sum(dtype=float)
    leaning, sums = [], np.zeros(2)
    for part in facets.faces:
        if areas[part].sum() < least:
            continue
        shading = mesh.normals[mesh.triangles[part]] if mesh.normals.ndim == 2 else mesh.normals[part]
        cosines = [dots(shading[:, k], geometric[part]) / (lengths(shading[:, k]) * areas[part]) for k in range(3)]
        # The core shades a corner with a zero normal flat.
        mean = float((np.nan_to_num(cosines, nan=1.0).mean(axis=0) * areas[part]).sum() / areas[part].sum())
        if mean < _LEAN:
            leaning.append(part)
            sums += mean * areas[part].sum(), areas[part].sum()
    if not leaning:
        return np.empty(0, int), 1.0
    return np.concatenate(leaning), float(np.clip(sums[0] / sums[1], -1.0, 1.0))
