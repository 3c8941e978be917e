"""Intersections of rays with spheres, planes, cylinders, cones and triangles."""

import math

import numpy as np
import tiny_scenes
from tiny_scenes import lambert, rotate_x

from addon.bindings.abi import InstanceKind, Integrator
from addon.bindings.session import Scene, Session
from addon.bindings.snapshot import Instance, MeshData

from . import studio
from .chapter import Figure, Picture, worst

# A parallel grid of rays along +y over the square -2 ... 2; all of its coordinates are exact in double precision.
_ORIGIN = -10.0
_TRIANGLE = MeshData("triangle", [(-1, 0, -1), (1, 0, -1), (0, 0, 1)], [(0, 1, 2)])
_DOUBLE = "t in double precision: 2^-53 of the 10 units on the way, a dozen times, and 1/cos of up to 200 at the outline"


def _grid(count):
    """Returns the odd integers (x, z) of the grid's rays, and their origins."""
    odd = 2 * np.arange(count) + 1 - count
    x, z = (axis.ravel() for axis in np.meshgrid(odd, odd))
    return x, z, np.stack([x * 2.0 / count, np.full(x.shape, _ORIGIN), z * 2.0 / count], axis=1)


def _shapes(x, z, half):
    """Returns name: (instance, meshes, which rays hit, computed in integers, distance of those hits to the plane y = 0)."""
    s = 1.0 / half
    inside = np.abs(z) < half
    slope = inside & (2 * np.abs(x) < half - z)
    with np.errstate(invalid="ignore"):
        ball, tube = np.sqrt(1.0 - (x * s) ** 2 - (z * s) ** 2), np.sqrt(1.0 - (x * s) ** 2)
        cone = np.sqrt(((1.0 - z * s) / 2) ** 2 - (x * s) ** 2)
    everywhere = np.ones(x.shape, bool)
    return {
        "sphere": (Instance(kind=InstanceKind.SPHERE), (), x**2 + z**2 < half**2, ball),
        "plane": (Instance(kind=InstanceKind.PLANE, matrix=rotate_x(math.pi / 4)), (), everywhere, -z * s),
        "cylinder": (Instance(kind=InstanceKind.CYLINDER), (), inside & (np.abs(x) < half), tube),
        "cone": (Instance(kind=InstanceKind.CONE), (), slope, cone),
        "triangle": (Instance(), (_TRIANGLE,), slope, 0.0 * x),
    }


def _meet(instance, meshes, places):
    with Scene.upload(tiny_scenes.scene([instance], [lambert()], meshes=meshes)) as scene:
        return scene.intersect(places, (0.0, 1.0, 0.0))


def shapes(quick):
    count = 128 if quick else 512
    x, z, places = _grid(count)
    figures, pictures = [], []
    for name, (instance, meshes, hit, depth) in _shapes(x, z, count // 2).items():
        found = _meet(instance, meshes, places)
        met = np.isfinite(found.t)
        wrong = int(np.sum(met != hit))
        figures.append(
            Figure.near(
                f"{name}: rays of {len(x)} whose hit or miss contradicts the equation",
                wrong,
                0,
                0,
                f"counted in whole numbers: {int(hit.sum())} rays hit",
            )
        )
        both = met & hit
        error = worst(found.t[both], -_ORIGIN - depth[both])
        figures.append(Figure.at_most(f"{name}: largest relative error of t", error, 1e-11, _DOUBLE))
        pictures.append(_portrait(name, instance, meshes))
    figures.append(_shared_edge(count))
    return tuple(figures) + (_normal_view(),), tuple(pictures)


def _portrait(name, instance, meshes):
    camera = studio.perspective((2.0, -5.0, 2.4), (0, 0, 0))
    shot = tiny_scenes.scene(
        [instance], [lambert()], meshes=meshes, camera=camera, world=(0.1, 0.1, 0.12), integrator=Integrator.NORMALS, samples=16
    )
    return Picture(name, f"{name}: its normals as colours", studio.render(shot))


def _shared_edge(count):
    """Returns rays through the shared diagonal of two triangles, at places that no float represents exactly."""
    rng = np.random.default_rng(1)
    corners = rng.uniform(-1, 1, (4, 3)).astype(np.float32)
    mesh = MeshData("fold", corners, [(0, 1, 2), (1, 0, 3)])
    share = rng.uniform(0.01, 0.99, (40 * count, 1))
    a, b = corners[:2].astype(float)
    targets = a + share * (b - a)
    # Start from places where the two triangles lie on different sides of the edge.
    edge = (b - a) / np.linalg.norm(b - a)
    wings = [corners[k].astype(float) - a for k in (2, 3)]
    wings = [w - edge * (w @ edge) for w in wings]
    away = -sum(w / np.linalg.norm(w) for w in wings)
    origins = targets + 3.0 * away / np.linalg.norm(away) + 0.1 * edge
    with Scene.upload(tiny_scenes.scene([Instance()], [lambert()], meshes=(mesh,))) as scene:
        missed = int(np.isinf(scene.intersect(origins, targets - origins).t).sum())
    what = f"triangle: rays of {len(origins)} through a shared edge that miss both triangles"
    return Figure.near(what, missed, 0, 0, "both triangles make the same decision about their edge")


def _normal_view():
    pixels = 64
    camera = studio.parallel((0.0, 0.0, 5.0), width=1.0, pixels=pixels)
    shot = tiny_scenes.scene([tiny_scenes.sphere()], [lambert()], camera=camera, integrator=Integrator.NORMALS)
    picture = studio.render(shot)
    points, _ = studio.seen_on_plane(shot)
    normals = points.copy()
    normals[..., 2] = np.sqrt(1.0 - points[..., 0] ** 2 - points[..., 1] ** 2)
    error = np.abs(picture[..., :3] - (0.5 * normals + 0.5)).max()
    return Figure.at_most("Normals: largest deviation from 0.5 n + 0.5 on a sphere", error, 1e-6, "n in single precision")


def rays(quick):
    width, height = 64, 36
    camera = studio.Camera(
        matrix=tiny_scenes.look_at((1, -4, 2), (0, 0, 0)), width=width, height=height, window=(-0.4, 0.4, -0.225, 0.225)
    )
    x, y = (axis.ravel() + 0.5 for axis in np.meshgrid(np.arange(width), np.arange(height)))
    with Session.upload(tiny_scenes.scene(camera=camera)) as session:
        origins, directions = session.probe_camera(np.stack([x, y], axis=1))
    at_eye = np.linalg.norm(np.cross(np.array([1.0, -4.0, 2.0]) - origins, directions), axis=1)
    at_eye = (at_eye / np.linalg.norm(directions, axis=1)).max()
    matrix = camera.matrix[:3, :3]
    local = np.stack([-0.4 + 0.8 * x / width, -0.225 + 0.45 * y / height, -np.ones(x.shape)], axis=1)
    expected = local @ matrix.T
    cosine = np.sum(expected * directions, axis=1) / np.linalg.norm(expected, axis=1) / np.linalg.norm(directions, axis=1)
    corner = directions[[0, width - 1]] / np.linalg.norm(directions[[0, width - 1]], axis=1, keepdims=True)
    first, last = local[[0, width - 1]] / np.linalg.norm(local[[0, width - 1]], axis=1, keepdims=True)
    basis = np.abs(matrix.T @ matrix - np.eye(3)).max()
    handed = float(np.dot(np.cross(matrix[:, 0], matrix[:, 1]), matrix[:, 2]))
    return (
        Figure.at_most("largest distance of a ray from the eye", at_eye, 1e-6, "directions in single precision"),
        Figure.at_most("largest 1 - cosine to the direction of the formula", 1.0 - cosine.min(), 1e-12, "rounding of both"),
        Figure.near(
            "angle between the first and the last ray of a row, degrees",
            math.degrees(math.acos(corner[0] @ corner[1])),
            math.degrees(math.acos(first @ last)),
            1e-4,
            "arc cosine of directions in single precision",
        ),
        Figure.at_most("camera's frame: largest deviation of its dot products from 0 and 1", basis, 1e-12, "double precision"),
        Figure.near("camera's frame: (x × y)·z, right-handed", handed, 1.0, 1e-12, "double precision"),
    ), ()


CHAPTERS = (rays, shapes)
