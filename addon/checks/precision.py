"""Geometry smaller than the precision at its position: single precision is coarse far from the origin."""

import math

import numpy as np

from ..bindings.enums import InstanceKind
from .finding import Finding, Severity, told_number
from .sides import corners, dots, lengths
from .subject import step

# A corner has an error of up to half a step along each axis. With an edge of 32 steps that tilts a face by up to
# 2 * sqrt(3) * 0.5 / 32 = 0.054, 3 degrees, which is visible in mirrors.
_WHOLE_FACE = 32.0
# With a width of less than 4 steps the error of a needle's width is up to half of the width. A few needles are not reported.
_WIDTH = 4.0
_SHARE_OF_FACES = 0.01
_SHARE_OF_NEEDLES = 0.1
# An object whose position has steps of an eighth of its size is visibly displaced from its true position.
_WHOLE_OBJECT = 8.0
# Rounding errors of 2^-25 in a matrix of unit columns turn normals by 2^-25 over the volume: at 2^-20 by 2^-5, 2 degrees.
_FLATTEST = 2.0**-20


def check_precision(subject):
    yield from _check_meshes(subject)
    yield from _check_places(subject)
    yield from _check_shear(subject)


def _check_meshes(subject):
    """Yield findings of meshes whose coordinates are too coarse for their faces."""
    for number, mesh, looks in subject.shown_meshes(whole=False):
        if not subject.thorough and not _is_far(mesh):
            continue
        faces, count = subject.sample(mesh)
        # Test edges against steps at the largest coordinate first: most meshes then need no further tests.
        a, b, c = corners(mesh, faces)
        limit = (_WHOLE_FACE * step(np.abs(mesh.positions).max())) ** 2
        squares = [dots(side, side) for side in (a - b, b - c, c - a)]
        few = np.flatnonzero(np.minimum(np.minimum(*squares[:2]), squares[2]) < limit)
        if len(few) < max(1.0, _SHARE_OF_FACES * count):
            continue
        finding = _judge(subject, number, mesh, looks[0], few, [part[few].astype(float) for part in (a, b, c)], count)
        if finding is not None:
            yield finding


def _judge(subject, number, mesh, row, few, places, count):
    """Return the finding of a mesh, or None. few: the possibly small ones of count sampled triangles; places: their corners."""
    steps = step(np.maximum.reduce([np.abs(place).max(axis=1) for place in places]))
    sides = [lengths(one - other) for one, other in zip(places, places[1:] + places[:1], strict=True)]
    longest, shortest = np.maximum.reduce(sides), np.minimum.reduce(sides)
    small = (longest < _WHOLE_FACE * steps) & (longest > 0.0)
    needle = (shortest < _WIDTH * steps) & (shortest > 0.0)
    if small.sum() >= max(1.0, _SHARE_OF_FACES * count):
        bad = small
    elif needle.sum() >= max(1.0, _SHARE_OF_NEEDLES * count):
        bad = needle
    else:
        return None
    edges = np.where(shortest > 0.0, shortest, longest)
    worst = np.flatnonzero(bad)[np.argmin((edges / steps)[bad])]
    stretch = abs(float(subject.volumes[row])) ** (1.0 / 3.0)
    share = float(bad.sum() / count)
    faces = round(share * len(mesh.triangles))
    return Finding(
        "precision",
        Severity.WRONG,
        f"{told_number(faces, 'face')} no larger than a few steps of Blender's numbers: this far from its origin a step is "
        f"{steps[worst] * stretch:.2g}, and the smallest edge {edges[worst] * stretch:.2g}",
        "model it near its own origin and export it again: rounded coordinates cannot be restored",
        object=subject.name(row),
        mesh=mesh.name,
        others=subject.others(number),
        faces=faces,
        place=subject.place(row, sum(place[worst] for place in places) / 3.0),
        weight=share,
    )


def _is_far(mesh):
    """Whether a mesh is farther from its origin than 64 times its size, so that at most 18 of 24 bits are left for its shape.

    Usually two vertices suffice for a no, since no two are farther apart than sqrt(3) sizes; else test a sample.
    """
    (x, y, z), (u, v, w) = mesh.positions[0].tolist(), mesh.positions[len(mesh.positions) // 2].tolist()
    if max(abs(x), abs(y), abs(z)) < 36.0 * max(abs(x - u), abs(y - v), abs(z - w)):
        return False
    some = mesh.positions[:: max(1, len(mesh.positions) // 256)]
    low, high = some.min(axis=0), some.max(axis=0)
    return float(max(np.abs(low).max(), np.abs(high).max())) > 64.0 * float((high - low).max())


def _sizes(subject):
    """Return the size of each instance in world space along its largest extent; infinity for infinite planes."""
    table = subject.instances
    # Half extents: 1 for unit shapes, infinity for meshes that the check skips.
    half = np.ones((len(table), 3))
    half[table.kinds == InstanceKind.MESH] = math.inf
    for number, _, _ in subject.shown_meshes(whole=False):
        positions = subject.meshes[number].positions
        half[subject.rows_of(number)] = 0.5 * np.ptp(positions.astype(float), axis=0)
    sizes = 2.0 * (half * subject.scales).max(axis=1)
    sizes[table.kinds == InstanceKind.PLANE] = math.inf
    return sizes


def _check_places(subject):
    """Yield a finding of objects and exact shapes that are not much larger than the steps of their position."""
    table = subject.instances
    if len(table) == 0:
        return
    steps = step(np.maximum.reduce(np.abs(table.matrices[:, :, 3].T)))
    # Compute sizes only if some position is far from the origin compared with its scale.
    if not subject.thorough and not (steps * 2.0**16 > np.maximum.reduce(subject.scales.T)).any():
        return
    sizes = _sizes(subject)
    bad = np.flatnonzero((sizes < _WHOLE_OBJECT * steps) & (sizes > 0.0))
    if len(bad) == 0:
        return
    worst = bad[np.argmin(sizes[bad] / steps[bad])]
    place = table.matrices[worst][:, 3]
    yield Finding(
        "precision",
        Severity.WRONG,
        f"its size of {sizes[worst]:.2g} is hardly more than the step of Blender's numbers there, {steps[worst]:.2g}, so that "
        f"it cannot stand where it should{'' if len(bad) == 1 else f', like {len(bad) - 1} more'}",
        "move the scene to the origin",
        object=subject.name(worst),
        place=tuple(place.tolist()),
        weight=float(steps[worst] / sizes[worst]),
    )


def _check_shear(subject):
    """Yield a finding of transforms so sheared that rounding turns normals."""
    scales = subject.scales
    usable = np.isfinite(subject.volumes) & (np.minimum.reduce(scales.T) > 0.0)
    rows = np.flatnonzero(usable)
    # The volume of the unit columns is 1 for a rotation with any scale along its axes, and 0 for a singular matrix.
    volumes = np.abs(subject.volumes[rows]) / (scales[rows, 0] * scales[rows, 1] * scales[rows, 2])
    bad = rows[volumes < _FLATTEST]
    if len(bad) == 0:
        return
    worst = bad[np.argmin(volumes[volumes < _FLATTEST])]
    yield Finding(
        "precision",
        Severity.WRONG,
        "its transform is sheared until almost nothing of its thickness is left, and rounding decides which way it faces"
        f"{'' if len(bad) == 1 else f', like that of {len(bad) - 1} more'}",
        "apply the scale of its parents, or shear it less",
        object=subject.name(worst),
        place=tuple(subject.instances.matrices[worst][:, 3].tolist()),
        weight=1.0,
    )
