"""start.py bench.ray_sets write JSON: write the file of triangles and rays that the drivers in rays/ read; the answer is JSON.

The rays are those of a path tracer on a snapshot: primary rays in small squares of pixels, two diffuse bounces in the order of
their pixels, and shadow rays towards the first lamp that is not a sun.
"""

import numpy as np

from addon.bindings.enums import LightKind
from addon.bindings.session import Scene
from addon.bindings.snapshot import InstanceTable, MeshData, SceneSnapshot
from tools.bench.peers.geometry import placements
from tools.bench.peers.view import read_view
from tools.harness import workers

# The pixels of squares with this side are neighbours in the file, so that packets of 4, 8 and 16 are coherent.
_SQUARE = 4
# Rays start at this share of the scene's size above surfaces, since not all drivers support an interval of t.
_LIFT = 1e-5


def merged(snapshot):
    """Return all triangles in world space: (positions, triangles)."""
    positions, triangles, first = [], [], 0
    for placed in placements(snapshot):
        for matrix in placed.matrices:
            part = placed.part.placed(matrix)
            positions.append(part.positions)
            triangles.append(part.triangles + first)
            first += len(part.positions)
    return np.concatenate(positions).astype(np.float32), np.concatenate(triangles).astype(np.uint32)


def primary(view, count, random):
    """Return origins and directions of count rays through random points of pixels, row by row of squares of pixels."""
    height = int(np.sqrt(count * view.height / view.width)) // _SQUARE * _SQUARE
    width = count // height // _SQUARE * _SQUARE
    y, x = np.mgrid[0:height, 0:width]
    order = np.lexsort((x.ravel(), y.ravel(), x.ravel() // _SQUARE, y.ravel() // _SQUARE))
    spot = np.stack([x.ravel(), y.ravel()], axis=1)[order] + random.random((width * height, 2))
    directions = view.direction(spot[:, :1] / width, spot[:, 1:] / height)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.broadcast_to(view.origin, directions.shape).copy(), directions


def bounce(hits, directions, random, lift):
    """Return origins, cosine-distributed directions and normals on the visible side of each hit."""
    normals = hits["geometric_normal"].astype(float)
    normals *= -np.sign(np.sum(normals * directions, axis=1, keepdims=True))
    ball = random.normal(size=normals.shape)
    new = normals + ball / np.linalg.norm(ball, axis=1, keepdims=True)
    new /= np.linalg.norm(new, axis=1, keepdims=True)
    return hits["position"] + lift * normals, new, normals


def write(snapshot, path, count=0, seed=1):
    loaded, random = SceneSnapshot.load(snapshot), np.random.default_rng(seed)
    positions, triangles = merged(loaded)
    sets = _sets(loaded, positions, triangles, count, random) if count else []
    with open(path, "wb") as file:
        file.write(np.array([len(positions), len(triangles), len(sets)], np.uint32).tobytes())
        file.write(positions.tobytes())
        file.write(triangles.tobytes())
        for name, is_any, rays in sets:
            file.write(np.array([len(rays), is_any], np.uint32).tobytes() + name.encode().ljust(16, b"\0"))
            file.write(np.ascontiguousarray(rays, np.float32).tobytes())
    return {"triangles": len(triangles), "rays": {name: len(rays) for name, _, rays in sets}}


def _sets(snapshot, positions, triangles, count, random):
    lift = _LIFT * float(np.ptp(positions, axis=0).max())
    mesh = MeshData("all", positions, triangles)
    alone = SceneSnapshot(meshes=(mesh,), instances=InstanceTable.build([{}]), materials=snapshot.materials[:1])
    lamp = next(light for light in snapshot.lights if light.kind in (LightKind.AREA, LightKind.POINT))
    with Scene.upload(alone) as scene:

        def ask(origins, directions):
            hits = scene.intersect(origins, directions)
            found = hits["instance"] == 0
            return hits[found], directions[found]

        first = primary(read_view(snapshot.camera), count, random)
        hits, directions = ask(*first)
        origins, second, normals = bounce(hits, directions, random, lift)
        shadow = _towards(lamp, origins, normals, random)
        hits, directions = ask(origins, second)
        more, third, _ = bounce(hits, directions, random, lift)
    endless = np.inf
    diffuse = np.concatenate([_rays(origins, second, endless), _rays(more, third, endless)])
    return [("primary", 0, _rays(*first, endless)), ("diffuse", 0, diffuse), ("shadow", 1, shadow)]


def _towards(lamp, origins, normals, random):
    """Return rays to points of the lamp above the horizon of the surface; they end just before the lamp."""
    spot = random.random((len(origins), 2)) - 0.5
    size = lamp.size if lamp.kind == LightKind.AREA else (lamp.radius, lamp.radius)
    targets = lamp.matrix[:, 3] + spot @ (lamp.matrix[:, :2] * size).T
    directions = targets - origins
    above = np.sum(directions * normals, axis=1) > 0.0
    return _rays(origins[above], directions[above], 0.999)


def _rays(origins, directions, tmax):
    return np.concatenate([origins, directions, np.full((len(origins), 1), tmax)], axis=1).astype(np.float32)


if __name__ == "__main__":
    workers.answer(write)
