"""Meshes for tests: trimesh's primitives, and real meshes from ../shared/models if that folder exists."""

import os

import numpy as np
import pytest
import trimesh
from conftest import ROOT

from addon.bindings.snapshot import MeshData

MODELS = os.path.join(ROOT, "..", "shared", "models")
CLOSED = ("spot", "fandisk", "rocker-arm", "cheburashka")
OPEN = ("stanford-bunny", "teapot")


def primitives():
    """Return closed meshes of 12 to a few thousand triangles at irregular positions."""
    rng = np.random.default_rng(1)
    shapes = {
        "box": trimesh.creation.box((1.0, 2.0, 0.5)),
        "icosphere": trimesh.creation.icosphere(2),
        "torus": trimesh.creation.torus(1.0, 0.3, 24, 16),
        "capsule": trimesh.creation.capsule(1.0, 0.4, count=(8, 8)),
        "cone": trimesh.creation.cone(0.7, 1.5, sections=24),
        "bumpy": trimesh.creation.icosphere(2),
    }
    bumpy = shapes["bumpy"]
    bumpy.vertices = bumpy.vertices * rng.uniform(0.8, 1.0, (len(bumpy.vertices), 1))
    for shape in shapes.values():
        shape.apply_transform(trimesh.transformations.random_rotation_matrix(rng.random(3)))
    return shapes


def model(name):
    """Return a real mesh, joined at its texture seams."""
    path = os.path.join(MODELS, name + ".obj")
    if not os.path.isdir(MODELS):
        pytest.skip("the folder ../shared/models is missing")
    with open(path, encoding="utf-8") as file:
        lines = [line.split() for line in file]
    vertices = [[float(x) for x in words[1:4]] for words in lines if words and words[0] == "v"]
    # Corners are position/uv/normal: use positions only, which joins texture seams.
    polygons = [[int(corner.split("/")[0]) - 1 for corner in words[1:]] for words in lines if words and words[0] == "f"]
    faces = [(p[0], p[i], p[i + 1]) for p in polygons for i in range(1, len(p) - 1)]
    return trimesh.Trimesh(vertices, faces, process=False)


def data(mesh, name="mesh", **fields):
    return MeshData(name, np.asarray(mesh.vertices, np.float32), np.asarray(mesh.faces, np.uint32), **fields)


def winding_number(mesh, points):
    """Return 1 for points inside a closed mesh, 0 outside: the sum of the triangles' solid angles over 4 pi."""
    corners = np.asarray(mesh.vertices, np.float32).astype(float)[mesh.faces]
    result = []
    for p in points:
        a, b, c = (corners[:, i] - p for i in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c))
        dots = la * lb * lc + np.sum(a * b, 1) * lc + np.sum(b * c, 1) * la + np.sum(c * a, 1) * lb
        result.append(2.0 * np.arctan2(volume, dots).sum() / (4.0 * np.pi))
    return np.array(result)


def points_inside(mesh, count, seed=1):
    rng = np.random.default_rng(seed)
    low, high = mesh.bounds
    found = []
    while len(found) < count:
        p = rng.uniform(low, high, (8, 3))
        found.extend(p[winding_number(mesh, p) > 0.9])
    return np.array(found[:count])


def rays_at(mesh, count, seed):
    """Return rays that are hard for intersection: at random places, at vertices and edges, along axes, from the surface."""
    rng = np.random.default_rng(seed)
    vertices = np.asarray(mesh.vertices, np.float32).astype(float)
    corners = vertices[mesh.faces]
    centre, size = vertices.mean(axis=0), np.ptp(vertices, axis=0).max()
    origins = centre + rng.normal(size=(count, 3)) * size
    weights = rng.dirichlet((1, 1, 1), count)
    face = corners[rng.integers(len(corners), size=count)]
    targets = np.einsum("ij,ijk->ik", weights, face)
    kind = rng.integers(6, size=count)
    targets[kind == 1] = face[kind == 1, 0]
    targets[kind == 2] = face[kind == 2, :2].mean(axis=1)
    # Along an axis at a vertex: the special case of slabs and shear.
    axis = np.eye(3)[rng.integers(3, size=count)]
    along = kind == 3
    origins[along] = (face[:, 0] + axis * size * 2)[along]
    targets[along] = face[along, 0]
    surface = kind == 4
    origins[surface] = targets[surface]
    targets[surface] = (origins + rng.normal(size=(count, 3)))[surface]
    wild = kind == 5
    targets[wild] = origins[wild] + rng.normal(size=(count, 3))[wild]
    return origins, targets - origins
