"""What the parts of a picture cost: their bytes, and the seconds to render, export, join, judge and read them.

The scene is one of the benchmark's lifelike ones; its picture is small, as all figures are per pixel or per byte.
"""

import statistics
import time

import numpy as np

from addon.bindings.digest import scene_digest
from addon.bindings.enums import Pass
from addon.bindings.session import Scene, Session
from addon.bindings.snapshot import SceneSnapshot
from addon.denoise import view_layer
from addon.farm import worker
from addon.farm.cut import whole_range
from tools.bench import jobs
from tools.harness.errors import luminance
from tools.harness.places import BUILD

SCENE = "daylight"
# Passes of a picture that is denoised.
DENOISED = (Pass.COMBINED, *view_layer.PASSES)
# Tasks of a round in this measurement, and samples of its rounds.
_TASKS, _ROUNDS = 8, ((0, 1), (1, 1), (2, 2))
# Samples of a tile from which its cost and noise are taken.
_MAPPED = 16
# A still for which the pilot searches as for the simulated ones: its pixels are at their greatest number.
_PLANNED = 4096
_LOOKS = 20


def load(name=SCENE, width=480, height=270):
    """Return the snapshot of a benchmark's scene, as exported once into build/scaling."""
    path = BUILD / "scaling" / f"{name}_{width}.npz"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        jobs.in_blender("snapshot", path=str(path), name=name, threads=0, width=width, height=height, samples=_PLANNED)
    return SceneSnapshot.load(str(path))


def with_settings(snapshot, **fields):
    """Return the snapshot with other settings, and no other end than its samples."""
    return snapshot.replaced(settings=snapshot.settings.replaced(target_error=0.0, time_limit=0.0, **fields))


def _seconds(work, count=1):
    """Return the median seconds of a call, and its last result."""
    found = []
    for _ in range(count):
        before = time.perf_counter()
        made = work()
        found.append(time.perf_counter() - before)
    return statistics.median(found), made


def of_scene(snapshot, threads):
    """Return the costs of bringing the scene to a worker, and of its pilot; they remain prepared in this process."""
    encode, (name, data) = _seconds(lambda: worker.encoded(snapshot))
    digest, _ = _seconds(lambda: scene_digest(snapshot))
    decode, _ = _seconds(lambda: worker.decoded(name, data))
    prepare, _ = _seconds(lambda: worker.prepare(name, lambda: data, threads))
    pilot, decision = _seconds(lambda: worker.decide(name, None, threads))
    return {
        "scene_bytes": data.nbytes,
        "encode_seconds": encode + digest,
        "load_seconds": decode,
        "prepare_seconds": prepare,
        "pilot_seconds": pilot,
    }, (name, (decision.split_lights, decision.split_paths))


def of_parts(snapshot, name, splits, threads):
    """Return the sizes of parts, and the costs at a worker and at the client, per byte or per pixel."""
    settings = snapshot.settings.replaced(in_parts=True, split_lights=splits[0], split_paths=splits[1])
    pixels = snapshot.camera.region_width * snapshot.camera.region_height
    with Session.joiner(scene_digest(snapshot), snapshot.camera, settings) as film:
        tiles = len(film.tiles())
        rounds = [
            [worker.render(name, None, splits, whole_range(first, count, tiles)[i::_TASKS], threads) for i in range(_TASKS)]
            for first, count in _ROUNDS
        ]
        head_bytes = film.export().nbytes
        adding = [
            _seconds(lambda made_by=made_by: [film.add(one.part) for one in made_by])[0]
            / sum(one.part.nbytes for one in made_by)
            for made_by in rounds
        ]
        pixels_of_tile = int(film.tiles()[0])
        joining, _ = _seconds(lambda: worker.join(*rounds[0][:2]), 3)
        joined = sum(made.part.nbytes for made in rounds[0][:2])
        told, _ = _seconds(film.statistics, _LOOKS)
        error, _ = _seconds(film.error, 3)
        plan, _ = _seconds(film.plan, 3)
        read, _ = _seconds(lambda: [film.read(which) for which in settings.passes], 3)
    with Session.joiner(scene_digest(snapshot), snapshot.camera, settings) as film:
        film.add(rounds[0][0].part)
        export, part = _seconds(film.export, 5)
    # The first range of a tile is the least that a worker can be asked for.
    start, _ = _seconds(lambda: worker.render(name, None, splits, whole_range(0, 1, tiles)[:1], threads), _LOOKS)

    def size(first, count):
        return worker.render(name, None, splits, whole_range(first, count, 1), threads).part.nbytes

    return {
        "head_bytes": head_bytes,
        **sizes(head_bytes, pixels_of_tile, size),
        "join_seconds_per_byte": statistics.median(adding),
        "worker_join_seconds_per_byte": joining / joined,
        "export_seconds_per_byte": export / part.nbytes,
        "statistics_seconds_per_tile": told / tiles,
        "error_seconds_per_pixel": error / pixels,
        "plan_seconds_per_pixel": plan / pixels,
        "read_seconds_per_pixel": read / pixels,
        "start_seconds": start,
    }


def sizes(head_bytes, pixels, size):
    """Return the bytes of parts by their parts; size(first, count): bytes of a part of one tile with that many pixels."""
    one, two, with_first = size(1, 1), size(1, 2), size(0, 1)
    # Samples 1 and 2 are two sums, each with 8 bytes of its own; a tile has 16.
    of_sum = (two - one - 8) // pixels
    of_tile = (one - head_bytes - 24) // pixels - of_sum
    return {"sum_bytes": of_sum, "tile_bytes": of_tile, "first_bytes": (with_first - one) // pixels}


def of_samples(snapshot, threads):
    """Return the seconds of a pixel's sample with all threads."""
    with Session.upload(snapshot) as session:
        session.render_all(1)
        seconds, _ = _seconds(lambda: _range(session, 1, 2))
    return seconds / (2 * snapshot.camera.region_width * snapshot.camera.region_height)


def _range(session, first, count):
    session.render(first, count)
    while not session.wait(1.0).finished:
        pass


def maps(snapshot):
    """Return rows of squares of 16 x 16 pixels: the cost of a sample, relative to the mean, and its relative variance."""
    settings = snapshot.settings.replaced(in_parts=True, threads=1, passes=(Pass.COMBINED, Pass.ERROR))
    with Scene.upload(snapshot) as scene:
        scene.set_digest(scene_digest(snapshot))
        with Session(scene, snapshot.camera, settings) as session:
            tiles = session.tiles()
            costs = np.array([_seconds(lambda i=i: _tile(session, i))[0] for i in range(len(tiles))])
            error, picture = session.read(Pass.ERROR)[..., 0], luminance(session.read(Pass.COMBINED))
    level = np.abs(picture) + 0.01 * np.abs(picture).mean()
    relative = _MAPPED * (error / level) ** 2
    rows, columns = -(-relative.shape[0] // 16), -(-relative.shape[1] // 16)
    noise = [[float(relative[16 * y : 16 * y + 16, 16 * x : 16 * x + 16].mean()) for x in range(columns)] for y in range(rows)]
    # A square is two tiles.
    each = (costs / np.maximum(tiles, 1)).reshape(-1, 2).mean(axis=1).reshape(rows, columns)
    return {"costs": (each / each.mean()).tolist(), "noise": noise}


def _tile(session, number):
    session.render_ranges(whole_range(0, _MAPPED, number + 1)[number:])
    while not session.wait(1.0).finished:
        pass
