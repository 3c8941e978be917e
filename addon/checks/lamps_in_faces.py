"""Area lamps that lie exactly in a face: in Cycles rounding decides for each shadow ray whether the face is an occluder."""

import numpy as np

from ..bindings.enums import LightKind, Ray
from .coincident import corners_of
from .finding import Finding, Severity
from .overlap import overlapping_triangles
from .planes import World, in_one_plane
from .subject import step

_MOST_ASKED = 100_000_000, 1_000_000  # lamps times flat parts: thorough, quick
_MOST_TRIANGLES = 1_000_000


def check_lamps_in_faces(subject, facets, world):
    """Yield findings of lamps in faces; a lamp in a hole of a ceiling is no fault. facets, world: of planes.gather."""
    lamps = [
        light
        for light in subject.snapshot.lights
        if light.kind == LightKind.AREA and any(light.emission) and not light.no_shadow and not light.opening
    ]
    if world is None or not lamps:
        return
    hides = subject.instances.hidden_from[world.rows] & int(Ray.SHADOW) == 0
    for light in lamps[: max(1, _MOST_ASKED[not subject.thorough] // len(world))]:
        subject.poll()
        both = _with_lamp(world, light)
        near = hides & (world.low <= both.high[-1]).all(axis=1) & (world.high >= both.low[-1]).all(axis=1)
        near = np.flatnonzero(near)
        near = near[in_one_plane(both, near, np.full(len(near), len(world)))]
        part = next((part for part in near.tolist() if _covers(subject, facets, world, part, light)), None)
        if part is None:
            continue
        what = f"lies exactly in a face of object '{subject.name(int(world.rows[part]))}'"
        yield Finding(
            "lights",
            Severity.DIFFERENT,
            f"{what}: Cycles would show it weaker, as the face hides part of it",
            "move it a little to the side that it shines to",
            light=light.name,
            place=tuple(light.matrix[:, 3].tolist()),
            weight=float(light.size[0] * light.size[1]),
            key="feature:lamps in faces",
        )


def _corners(light):
    """Return the corners (4, 3) of a lamp's rectangle, or of its ellipse's bounds, in world space."""
    x, y = (0.5 * size * light.matrix[:, axis] for axis, size in enumerate(light.size))
    return light.matrix[:, 3] + np.array([-x - y, x - y, x + y, y - x])


def _with_lamp(world, light):
    """Return the World with the lamp appended as the last part."""
    corners = _corners(light)
    steps = step(np.abs(corners).max())
    # The margin of other parts: the corners are rounded twice, once by the transform.
    margin = 2.0 * steps
    last = (
        [-1], [-1], [-1], [light.matrix[:, 2]], [light.matrix[:, 3]], [corners.min(axis=0) - margin],
        [corners.max(axis=0) + margin], [steps],
    )  # fmt: skip
    columns = (world.rows, world.parts, world.materials, world.normals, world.points, world.low, world.high, world.steps)
    return World(*(np.concatenate(column) for column in zip(columns, last, strict=True)))


def _covers(subject, facets, world, part, light):
    """Whether the faces of a part in the lamp's plane overlap the lamp, by more than a common border."""
    origin = light.matrix[:, 3]
    faces = corners_of(subject, facets, world, part, origin)
    if not np.isfinite(faces).all():
        return True
    axes = np.delete(np.arange(3), np.argmax(np.abs(light.matrix[:, 2])))
    lamp = (_corners(light) - origin)[[[0, 1, 2], [0, 2, 3]]]
    i, _ = overlapping_triangles(faces[:, :, axes], lamp[:, :, axes], _MOST_TRIANGLES)
    return len(i) > 0
