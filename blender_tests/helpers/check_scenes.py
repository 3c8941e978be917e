"""Small scenes for the checks, each with one fault or nearly one."""

import numpy as np
from tiny_scenes import look_at, move

from addon.bindings.enums import InstanceKind, LightKind, LobeKind
from addon.bindings.snapshot import (
    Camera,
    Instance,
    InstanceTable,
    Light,
    Lobe,
    Material,
    MeshData,
    Principled,
    SceneSnapshot,
    Settings,
)
from addon.checks.check import check_snapshot
from addon.checks.finding import lines

GREY = Material("grey", lobes=(Lobe(LobeKind.LAMBERT, color=(0.5, 0.5, 0.5)),))
RED = Material("red", lobes=(Lobe(LobeKind.LAMBERT, color=(0.8, 0.1, 0.1)),))
GLASS = Material("glass", lobes=(Lobe(LobeKind.GLASS, color=(1, 1, 1), ior=1.5, roughness=0.0),))
CLEAR = Material(
    "clear", lobes=(Lobe(LobeKind.PRINCIPLED, weight=(1, 1, 1), color=(1, 1, 1), principled=Principled(transmission=1.0)),)
)
VEIL = Material("veil", lobes=(Lobe(LobeKind.LAMBERT, color=(0.5, 0.5, 0.5), weight=(0.5,) * 3),), transmittance=(0.5,) * 3)
GLOW = Material("glow", lobes=(), emission=(3.0, 3.0, 3.0))
# The materials' numbers in scene().
GREY_, RED_, GLASS_, CLEAR_, VEIL_, GLOW_ = range(6)
LAMP = Light("lamp", move(2, -3, 4), LightKind.POINT, emission=(20, 20, 20), radius=0.1)
EYE = Camera(matrix=look_at((1.0, -6.0, 3.0), (0, 0, 0)), width=32, height=32)

_BOX = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
_SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
BOX_FACES = [face for a, b, c, d in _SIDES for face in ((a, b, c), (a, c, d))]


def box(name="box", faces=BOX_FACES, size=1.0, shift=(0, 0, 0), **fields):
    """Return a closed cube with faces counter-clockwise as seen from outside."""
    return MeshData(name, np.array(_BOX) * size + shift, faces, **fields)


def sheet(size=4.0, name="sheet", shift=(0, 0, 0), parts=1, **fields):
    """Return a square that faces +z, divided into parts x parts."""
    steps = np.linspace(-size / 2, size / 2, parts + 1)
    points = np.array([(x, y, 0.0) for y in steps for x in steps]) + shift
    corner = np.arange(parts * (parts + 1)).reshape(parts, parts + 1)[:, :-1].reshape(-1)
    row = parts + 1
    faces = [(a, a + 1, a + row + 1) for a in corner] + [(a, a + row + 1, a + row) for a in corner]
    return MeshData(name, points, faces, **fields)


def ball(rings=16, radius=1.0, shift=(0, 0, 0), name="ball", smooth=True, turned=False):
    """Return a closed sphere of 2 rings x rings quads and two fans."""
    theta, phi = np.pi * np.arange(1, rings) / rings, np.pi * np.arange(2 * rings) / rings
    side = np.stack(
        (np.sin(theta)[:, None] * np.cos(phi), np.sin(theta)[:, None] * np.sin(phi), np.tile(np.cos(theta)[:, None], len(phi))),
        axis=2,
    ).reshape(-1, 3)
    points = np.concatenate((side, [(0, 0, 1), (0, 0, -1)]))
    around = 2 * rings
    faces = []
    for k in range(around):
        right = (k + 1) % around
        faces.append((len(side), k, right))
        faces.append((len(side) + 1, (rings - 2) * around + right, (rings - 2) * around + k))
        for ring in range(rings - 2):
            a, b = ring * around + k, ring * around + right
            faces += [(a, a + around, b + around), (a, b + around, b)]
    faces = np.array(faces)
    return MeshData(
        name,
        points * radius + shift,
        faces[:, ::-1] if turned else faces,
        normals=(-points if turned else points) if smooth else None,
    )


def placed(mesh=0, material=0, matrix=None, name="thing", **fields):
    materials = material if isinstance(material, tuple) else (material,)
    return Instance(mesh=mesh, matrix=np.eye(4) if matrix is None else matrix, materials=materials, name=name, **fields)


def exact(kind, material=0, matrix=None, name="shape"):
    return placed(0, material, matrix, name, kind=InstanceKind[kind])


def scene(instances, meshes=(), materials=(GREY, RED, GLASS, CLEAR, VEIL, GLOW), **fields):
    values = {"lights": (LAMP,), "camera": EYE, "settings": Settings(), **fields}
    return SceneSnapshot(
        meshes=tuple(meshes), instances=InstanceTable.build(list(instances)), materials=tuple(materials), **values
    )


def one(mesh, material=0, matrix=None, **fields):
    return scene([placed(0, material, matrix)], [mesh], **fields)


def found(snapshot, thorough=True):
    """Return (kind, name of the severity) of all findings, sorted."""
    return sorted((finding.kind, finding.severity.name) for finding in check_snapshot(snapshot, thorough))


def only(snapshot, thorough=True):
    findings = check_snapshot(snapshot, thorough)
    assert len(findings) == 1, lines(findings)
    return findings[0]
