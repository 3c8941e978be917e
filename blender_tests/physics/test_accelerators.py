"""Brute force, kd-tree and BVH return equal hits, bit for bit; closed meshes leak no rays."""

import meshes
import numpy as np
import pytest
import tiny_scenes
from tiny_scenes import move, rotate_x, rotate_y, scale

from addon.bindings.abi import UINT32_MAX, Accelerator
from addon.bindings.session import Scene
from addon.bindings.snapshot import Instance


def upload(library, instances, mesh_list, accelerator):
    return Scene.upload(
        tiny_scenes.scene(instances, [tiny_scenes.lambert()], meshes=mesh_list, accelerator=accelerator), library
    )


def answers(library, instances, mesh_list, accelerator, origins, directions, tmin=0.0, tmax=np.inf):
    with upload(library, instances, mesh_list, accelerator) as scene:
        hits = scene.intersect(origins, directions, tmin, tmax)
        occluded = scene.occluded(origins, directions, tmin, tmax)
    return hits, occluded


def assert_same(one, other, what):
    hits, occluded = one
    hits2, occluded2 = other
    different = (
        [i for i in range(len(hits)) if hits[i].tobytes() != hits2[i].tobytes()] if hits.tobytes() != hits2.tobytes() else []
    )
    assert not different, (
        f"{what}: {len(different)} of {len(hits)} differ, first {hits[different[0]]} against {hits2[different[0]]}"
    )
    assert np.array_equal(occluded, occluded2), what
    # Closest hit and any hit must agree.
    assert np.array_equal(occluded, hits.instance != UINT32_MAX), what


@pytest.mark.parametrize("name", meshes.primitives())
def test_primitives(library, name):
    """170 000 rays for each of six meshes: a million rays through all three."""
    mesh = meshes.primitives()[name]
    origins, directions = meshes.rays_at(mesh, 170_000, 3)
    results = [answers(library, [Instance()], [meshes.data(mesh)], a, origins, directions) for a in Accelerator]
    assert (results[0][0].instance == 0).mean() > 0.5
    assert_same(results[0], results[1], "kd-tree and BVH")
    assert_same(results[0], results[2], "brute force and BVH")


@pytest.mark.parametrize("name", meshes.CLOSED + meshes.OPEN)
def test_models(library, name):
    """A million rays over six real meshes with BVH and kd-tree; slow brute force for some of the rays."""
    mesh = meshes.model(name)
    origins, directions = meshes.rays_at(mesh, 170_000, 4)
    data = [meshes.data(mesh, name)]
    bvh, kdtree = (answers(library, [Instance()], data, a, origins, directions) for a in (Accelerator.BVH, Accelerator.KDTREE))
    assert_same(bvh, kdtree, "kd-tree and BVH")
    some = slice(0, 60_000_000 // len(mesh.faces))
    brute = answers(library, [Instance()], data, Accelerator.BRUTE_FORCE, origins[some], directions[some])
    assert_same((bvh[0][some], bvh[1][some]), brute, "brute force and BVH")


@pytest.mark.slow
@pytest.mark.parametrize("name", meshes.CLOSED + meshes.OPEN)
def test_models_by_brute_force(library, name):
    """The million rays of test_models against brute force, which takes minutes."""
    mesh = meshes.model(name)
    origins, directions = meshes.rays_at(mesh, 170_000, 4)
    data = [meshes.data(mesh, name)]
    brute, bvh = (
        answers(library, [Instance()], data, a, origins, directions) for a in (Accelerator.BRUTE_FORCE, Accelerator.BVH)
    )
    assert_same(bvh, brute, "brute force and BVH")


def crowd():
    """Return meshes and exact shapes, mirrored, sheared, instanced, with sizes from 1e-3 to 1e3, near and far."""
    rng = np.random.default_rng(7)
    shapes = [meshes.data(m, n) for n, m in meshes.primitives().items()]
    instances = []
    for i in range(60):
        matrix = move(*rng.normal(size=3) * 5) @ rotate_x(rng.random() * 6) @ rotate_y(rng.random() * 6)
        matrix = matrix @ scale(*(10 ** rng.uniform(-1, 0.5, 3) * np.where(rng.random(3) < 0.3, -1, 1)))
        matrix[0, 1] += rng.normal() * 0.2
        instances.append(Instance(mesh=i % len(shapes), kind=i % 5, matrix=matrix))
    instances.append(Instance(mesh=0, matrix=move(1e4, 0, 0) @ scale(1e3)))
    instances.append(Instance(mesh=1, matrix=scale(1e-3)))
    # Two instances at the same place: the lower instance number wins.
    instances += [Instance(mesh=1, matrix=move(1, 1, 1))] * 2
    return instances, shapes


def test_instances(library):
    instances, shapes = crowd()
    rng = np.random.default_rng(8)
    count = 100_000
    origins = rng.normal(size=(count, 3)) * 8
    origins[:1000] += 1e6
    directions = rng.normal(size=(count, 3)) * 3 - origins
    directions *= 10 ** rng.uniform(-6, 6, (count, 1))
    tmin, tmax = rng.uniform(0, 0.5, count) / 10, np.where(rng.random(count) < 0.5, np.inf, 1.0)
    rays = origins, directions, tmin, tmax
    bvh, kdtree = (answers(library, instances, shapes, a, *rays) for a in (Accelerator.BVH, Accelerator.KDTREE))
    assert len(np.unique(bvh[0].instance)) > 40
    assert_same(bvh, kdtree, "kd-tree and BVH")
    some = slice(0, 5000)
    brute = answers(library, instances, shapes, Accelerator.BRUTE_FORCE, *(a[some] for a in rays))
    assert_same((bvh[0][some], bvh[1][some]), brute, "brute force and BVH")


def test_coincident_surfaces_have_one_order(library):
    """At equal distances the lower instance number wins, in every accelerator."""
    mesh = meshes.primitives()["box"]
    instances = [Instance()] * 3
    origins, directions = meshes.rays_at(mesh, 20_000, 9)
    for a in Accelerator:
        hits, _ = answers(library, instances, [meshes.data(mesh)], a, origins, directions)
        assert set(np.unique(hits.instance)) == {0, UINT32_MAX}, a


def leaks(library, mesh, matrix, accelerator, count):
    """Return the number of rays from inside without a hit, aimed at random, at vertices and at midpoints of edges."""
    vertices = np.asarray(mesh.vertices, np.float32).astype(float)
    edges = vertices[mesh.edges_unique].mean(axis=1)
    rng = np.random.default_rng(11)
    inside = meshes.points_inside(mesh, 16)
    pick = rng.integers(len(inside), size=count)
    third = count // 3
    targets = np.concatenate(
        [
            vertices[rng.integers(len(vertices), size=third)],
            edges[rng.integers(len(edges), size=third)],
            inside[pick[2 * third :]] + rng.normal(size=(count - 2 * third, 3)),
        ]
    )

    def place(p):
        return p @ matrix[:3, :3].T + matrix[:3, 3]

    origins = place(inside[pick])
    with upload(library, [Instance(matrix=matrix)], [meshes.data(mesh)], accelerator) as scene:
        return int(np.sum(~scene.occluded(origins, place(targets) - origins)))


PLACES = {"here": np.eye(4), "tiny": scale(1e-6), "huge": scale(1e9), "far": move(148376.0, 1234.0, -223423.0)}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", ["box", "icosphere", "bumpy", "torus"])
def test_closed_primitives_are_watertight(library, name, place):
    mesh = meshes.primitives()[name]
    assert mesh.is_watertight
    for accelerator in Accelerator:
        assert leaks(library, mesh, PLACES[place], accelerator, 30_000) == 0, accelerator


@pytest.mark.parametrize("name", meshes.CLOSED)
def test_closed_models_are_watertight(library, name):
    mesh = meshes.model(name)
    assert mesh.is_watertight
    for accelerator in (Accelerator.BVH, Accelerator.KDTREE):
        assert leaks(library, mesh, np.eye(4), accelerator, 100_000) == 0, accelerator
