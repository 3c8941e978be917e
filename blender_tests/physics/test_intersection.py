"""Intersection: the course's checks, extreme exact shapes, the data of hits, three accelerators."""

import dataclasses

import mpmath as mp
import numpy as np
import pytest
import reference
import tiny_scenes
from tiny_scenes import move, plane, rotate_x, rotate_y, scale, sphere

from addon.bindings.abi import UINT32_MAX, Accelerator, InstanceKind
from addon.bindings.session import Scene
from addon.bindings.snapshot import Instance, MeshData

U = 2.0**-53


def upload(library, instances, mesh_list=(), accelerator=Accelerator.BVH):
    return Scene.upload(
        tiny_scenes.scene(instances, [tiny_scenes.lambert()], meshes=mesh_list, accelerator=accelerator), library
    )


# ---- the course's checks: three rays against two spheres and two planes ----

RAYS = [((0.0, 0.0, 5.0), (0.0, 0.0, -1.0)), ((3.0, 4.0, 5.0), (-0.3, -0.4, -0.5)), ((0.0, 0.0, 0.0), (0.0, 0.6, 0.8))]
SHAPES = {
    "sphere1": sphere(),
    "sphere2": sphere(matrix=move(0.0, 1.2, 1.6) @ scale(0.5)),
    "plane1": plane(),
    "plane2": plane(matrix=move(z=-2.0) @ rotate_x(0.5)),
}


def expected_hits(shape, origin, direction):
    """Return all (t, normal) by the textbook formulas at 50 digits, sorted by t."""
    linear, translation = np.asarray(shape.matrix)[:3, :3], np.asarray(shape.matrix)[:3, 3]
    if shape.kind == InstanceKind.SPHERE:
        radius = linear[0, 0]
        hits = reference.sphere_hits(np.asarray(origin) - translation, direction, radius)
        points = [[mp.mpf(float(o)) + t * mp.mpf(float(d)) for o, d in zip(origin, direction, strict=True)] for t in hits]
        return [
            (t, [(p - mp.mpf(float(c))) / mp.mpf(float(radius)) for p, c in zip(q, translation, strict=True)])
            for t, q in zip(hits, points, strict=True)
        ]
    normal = reference.vector(linear[:, 2])
    along = reference.dot(normal, reference.vector(direction))
    if along == 0:
        return []
    return [(reference.dot(normal, reference.vector(translation - np.asarray(origin))) / along, normal)]


@pytest.mark.parametrize("accelerator", Accelerator)
@pytest.mark.parametrize("number", range(3))
@pytest.mark.parametrize("name", SHAPES)
def test_lab_rays(library, name, number, accelerator):
    origin, direction = RAYS[number]
    ahead = [(t, n) for t, n in expected_hits(SHAPES[name], origin, direction) if t > mp.mpf("1e-12")]
    with upload(library, [SHAPES[name]], accelerator=accelerator) as scene:
        hit = scene.intersect([origin], [direction], 1e-12)[0]
        if not ahead:
            assert hit.instance == UINT32_MAX and np.isinf(hit.t)
            return
        t, normal = float(ahead[0][0]), [float(x) for x in ahead[0][1]]
        # Double precision with a short chain of operations; the normal is float32.
        assert hit.instance == 0 and abs(hit.t - t) <= 32 * U * max(t, 5.0)
        assert np.allclose(hit.normal, normal, atol=3e-7) and np.allclose(hit.geometric_normal, normal, atol=3e-7)
        assert np.allclose(hit.position, np.add(origin, t * np.asarray(direction)), atol=100 * U * 10)
        # tmin and tmax bound the open interval on both sides.
        before, after = t * (1 - 1e-9), t * (1 + 1e-9)
        later = float(ahead[1][0]) if len(ahead) > 1 else np.inf
        assert scene.intersect([origin], [direction], 1e-12, before)[0].instance == UINT32_MAX
        assert scene.intersect([origin], [direction], before, after)[0].instance == 0
        beyond = scene.intersect([origin], [direction], after)[0]
        assert np.isclose(beyond.t, later, rtol=1e-12) if len(ahead) > 1 else beyond.instance == UINT32_MAX
        assert list(scene.occluded([origin] * 3, [direction] * 3, [1e-12, before, after], [before, after, np.inf])) == [
            False,
            True,
            len(ahead) > 1,
        ]


@pytest.mark.parametrize("accelerator", Accelerator)
def test_closest_of_all(library, accelerator):
    """The nearest shape wins whatever the order of instances."""
    origin, direction = (0.0, 0.0, 10.0), (0.0, 0.0, -1.0)
    order = [sphere(matrix=move(z=z)) for z in (-3.0, 2.0, 5.0, 0.0)]
    with upload(library, order, accelerator=accelerator) as scene:
        hit = scene.intersect([origin], [direction])[0]
        assert hit.instance == 2 and hit.t == 4.0
        assert scene.intersect([origin], [direction], 4.5)[0].t == 6.0


# ---- exact surfaces ----


@pytest.mark.parametrize("radius", [1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9])
@pytest.mark.parametrize("height", [1e-6, 1.0, 1e3])
def test_sphere_distance(library, radius, height):
    """t against 50 digits, from normal to grazing incidence, from heights around the radius and far below it."""
    radius = float(np.float64(radius))
    origin = np.array([0.0, 0.0, radius + height * min(radius, 1.0)])
    angles = np.concatenate([np.linspace(0, 1.5, 20), [1.57]])
    horizon = np.arcsin(radius / origin[2])
    angles = angles[angles < horizon]
    directions = np.stack([np.sin(angles), 0 * angles, -np.cos(angles)], axis=1)
    with upload(library, [sphere(matrix=scale(radius))]) as scene:
        hits = scene.intersect(origin, directions)
    for direction, got in zip(directions, hits, strict=True):
        want = reference.sphere_hits(origin, direction, mp.mpf(radius))
        assert want and got.instance == 0
        # The distance of the origin to the surface has an error of one ulp of |o| + r; at angle theta to the normal the error
        # of t is 1/cos theta times that. Eight ulps allow for a dozen operations.
        point = [mp.mpf(float(o)) + want[0] * mp.mpf(float(d)) for o, d in zip(origin, direction, strict=True)]
        cosine = abs(float(reference.dot(reference.vector(direction), reference.normalize(point))))
        assert abs(got.t - float(want[0])) <= 8 * U * (origin[2] + radius) / cosine, (radius, height, direction)
        normal = [float(x) for x in reference.normalize(point)]
        assert np.allclose(got.normal, normal, atol=3e-7 + 8 * U * (origin[2] + radius) / cosine / radius)


def sheared(z=0.0):
    matrix = move(1.0, -2.0, z) @ rotate_y(0.4) @ scale(-1.3, 0.7, 2.0)
    matrix[0, 1] += 0.5
    return matrix


INSIDE_OUT = {
    InstanceKind.SPHERE: lambda p: np.linalg.norm(p, axis=1) - 1,
    InstanceKind.CYLINDER: lambda p: np.maximum(np.hypot(p[:, 0], p[:, 1]) - 1, np.abs(p[:, 2]) - 1),
    InstanceKind.CONE: lambda p: np.maximum(np.hypot(p[:, 0], p[:, 1]) - (1 - p[:, 2]) / 2, -1 - p[:, 2]),
    InstanceKind.PLANE: lambda p: p[:, 2],
}


@pytest.mark.parametrize("kind", INSIDE_OUT)
def test_exact_surfaces_by_their_equation(library, kind):
    """Every hit lies on the surface with an outward normal, and the ray does not cross the surface before it."""
    matrix = sheared(3.0)
    rng = np.random.default_rng(5)
    origins = rng.normal(size=(4000, 3)) * 8 + [0, 0, 3]
    targets = (rng.uniform(-1, 1, (4000, 3)) @ matrix[:3, :3].T) + matrix[:3, 3]
    inverse = np.linalg.inv(matrix)

    def local(p):
        return p @ inverse[:3, :3].T + inverse[:3, 3]

    distance = INSIDE_OUT[kind]
    with upload(library, [Instance(kind=kind, matrix=matrix)]) as scene:
        hits = scene.intersect(origins, targets - origins)
        met = hits.instance == 0
        assert met.mean() > 0.4
        # Positions are double, of a few units: 1e-12 is some thousand roundings.
        assert np.abs(distance(local(hits.position[met]))).max() < 1e-12
        outside = hits.position[met] + 1e-6 * hits.normal[met]
        assert np.all(distance(local(outside)) > 0), "normals point outwards"
        # Along each ray up to its hit, or all the way without one, the sign of the equation never changes.
        end = np.where(met, hits.t * (1 - 1e-9), 10.0)
        sign = np.sign(distance(local(origins)))
        for f in np.linspace(0.0, 1.0, 400):
            p = origins + (targets - origins) * (end * f)[:, None]
            assert np.all(np.sign(distance(local(p))) == sign), f


# ---- the data of a hit ----


def test_attributes_are_interpolated_by_barycentrics(library):
    rng = np.random.default_rng(2)
    mesh = MeshData(
        "one",
        [(0, 0, 0), (2, 0, 0.5), (0, 3, 1.0)],
        [(0, 1, 2)],
        normals=np.array([[(0, 0, 1), (0.1, 0, 1), (-0.1, -0.2, 1)]], np.float32),
        uvs=rng.random((1, 3, 2), np.float32),
        colors=rng.random((1, 3, 3), np.float32),
    )
    b = rng.dirichlet((1, 1, 1), 100)
    for matrix in (np.eye(4), sheared(), move(1e6, 0, 0) @ scale(1e-3)):
        points = b @ mesh.positions.astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
        size = np.abs(matrix[:3, :3]).max()
        origins = points + np.array([0.1, 0.2, 3.0]) * size
        with upload(library, [Instance(matrix=matrix)], [mesh]) as scene:
            hits = scene.intersect(origins, points - origins)
        assert np.all(hits.instance == 0) and np.all(hits.material == 0) and np.all(hits.primitive == 0)
        # The targets are rounded at magnitude |M|: one ulp of double over the triangle's size.
        weight = 64 * U * (1 + np.abs(matrix).max() / size)
        assert np.allclose(hits.t, 1.0, atol=weight) and np.allclose(hits.u, b[:, 1], atol=weight)
        assert np.allclose(hits.v, b[:, 2], atol=weight)
        assert np.allclose(hits.position, points, rtol=0, atol=64 * U * (np.abs(matrix).max() + size * 4))
        # uv and colours: float32 sums of three products of numbers below 1.
        assert np.allclose(hits.uv, b @ mesh.uvs[0], atol=3e-7 + weight)
        assert np.allclose(hits.color, b @ mesh.colors[0], atol=3e-7 + weight)
        # Normals transform by the inverse transpose, on the side of the geometric normal (counter-clockwise from outside).
        normal_matrix = np.linalg.inv(matrix[:3, :3]).T
        shading = (b @ mesh.normals[0].astype(float)) @ normal_matrix.T
        shading /= np.linalg.norm(shading, axis=1, keepdims=True)
        flat = normal_matrix @ np.cross((2, 0, 0.5), (0, 3, 1.0))
        flat /= np.linalg.norm(flat)
        assert np.allclose(hits.geometric_normal, flat, atol=1e-6)
        assert np.all(shading @ flat > 0.5), "the sheared normals stay on one side"
        assert np.allclose(hits.normal, shading, atol=1e-6 + weight)


def test_normals_of_corners_stay_with_their_triangles(library):
    """A square whose two triangles lean to either side along the edge that they share."""
    leaning = np.zeros((2, 3, 3), np.float32)
    leaning[0], leaning[1] = (0.6, 0, 0.8), (-0.6, 0, 0.8)
    mesh = dataclasses.replace(tiny_scenes.quad(), normals=leaning)
    with upload(library, [Instance()], [mesh]) as scene:
        hits = scene.intersect([(0.5, -0.5, 1), (-0.5, 0.5, 1)], (0, 0, -1))
    assert hits.primitive.tolist() == [0, 1]
    assert np.allclose(hits.normal, [(0.6, 0, 0.8), (-0.6, 0, 0.8)], atol=1e-6)


@pytest.mark.parametrize("shading, interpolated", [(0, True), (1, False), (3, True)])
def test_shading_of_the_object(library, shading, interpolated):
    mesh = MeshData(
        "one", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], normals=np.float32([(0, 0, 1), (0.6, 0, 0.8), (0, 0, 1)])
    )
    with upload(library, [Instance(shading=shading)], [mesh]) as scene:
        hit = scene.intersect([(0.5, 0.25, 1)], [(0, 0, -1)])[0]
    assert (abs(hit.normal[0]) > 0.1) == interpolated and np.allclose(hit.geometric_normal, (0, 0, 1))


def test_slots(library):
    """A slot index beyond the last selects the last slot; an instance without slots has no material."""
    mesh = dataclasses.replace(tiny_scenes.quad(), material_slots=np.uint16([0, 7]))
    materials = [tiny_scenes.lambert(i / 4) for i in range(4)]
    snapshot = tiny_scenes.scene(
        [Instance(materials=(2, 3)), Instance(materials=(1,), matrix=move(z=-1)), Instance(materials=(), matrix=move(z=-2))],
        materials,
        meshes=[mesh],
    )
    with Scene.upload(snapshot, library) as scene:
        origins = np.array([(0.5, -0.5, 1.0), (-0.5, 0.5, 1.0)])
        for depth, want in ((0.0, (2, 3)), (1.5, (1, 1)), (2.5, (UINT32_MAX, UINT32_MAX))):
            assert scene.intersect(origins, (0, 0, -1), depth).material.tolist() == list(want)
        assert scene.intersect(origins, (0, 0, -1)).primitive.tolist() == [0, 1]
