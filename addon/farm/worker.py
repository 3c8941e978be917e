"""The work of one machine for a picture: it reads the scene once, renders ranges of tiles as parts, and joins parts.

All functions run in the process of a worker. data: a function that returns a snapshot as bytes, called where the scene is not
kept; name: SHA-256 of the bytes, by which it is kept.
"""

import hashlib
import io
import threading
import time
from collections import OrderedDict
from typing import NamedTuple

import numpy as np

from ..bindings.abi import LancerError
from ..bindings.digest import scene_digest
from ..bindings.parts import describe_part
from ..bindings.session import Scene, Session
from ..bindings.snapshot import SceneSnapshot

# Seconds between looks at a running range; other threads of the process go on in between.
_STEP = 0.05
# Scenes that a process keeps: the one in use, and the one before.
_KEPT = 2


class Scenery(NamedTuple):
    """A committed scene with what its sessions need."""

    scene: Scene
    digest: bytes
    camera: object
    settings: object
    messages: tuple


class Decision(NamedTuple):
    """What a picture decides once for all its parts, and what the first worker knows about the scene."""

    split_lights: int
    split_paths: int
    messages: tuple
    figures: dict  # of lancer_statistics


class Made(NamedTuple):
    """A part, the time that it took, and who made it."""

    part: np.ndarray
    seconds: float
    by: tuple  # addresses of workers
    instruction_set: str


# One session renders at a time: it has all threads of the worker.
_lock = threading.Lock()
_scenes = OrderedDict()
_sessions = OrderedDict()


def decide(name, data, threads=0):
    """Return the Decision of a picture."""
    with _lock:
        place = _scenery(name, data, threads)
        with Session(place.scene, place.camera, place.settings) as session:
            session.decide()
            _finish(session)
            statistics = session.statistics()
            figures = {field: getattr(statistics, field) for field in _FIGURES}
            return Decision(statistics.split_lights, statistics.split_paths, place.messages, figures)


_FIGURES = (
    "build_seconds", "triangles", "instances", "lights", "geometry_bytes", "accelerator_bytes", "texture_bytes",
    "features", "kernel", "instruction_set", "threads",
)  # fmt: skip


def prepare(name, data, threads=0):
    """Make the scene ready, so that the first part does not wait for it."""
    with _lock:
        _scenery(name, data, threads)


def render(name, data, splits, ranges, threads=0, address=""):
    """Return the samples of ranges as a Made; splits: numbers of lights and paths, as decided."""
    with _lock:
        before = time.perf_counter()
        session = _session(name, data, splits, threads)
        try:
            session.clear()
            session.render_ranges(ranges)
            _finish(session)
            part = session.export()
            session.clear()
        except BaseException:
            # A session whose range has failed renders nothing more.
            _sessions.pop((name, tuple(splits))).close()
            raise
        return Made(part, time.perf_counter() - before, (address,), session.statistics().instruction_set)


def join(*made):
    """Return one Made of several whose parts belong to one picture; raise LancerError with the name of a wrong part's maker."""
    before = time.perf_counter()
    info = describe_part(made[0].part)
    makers, seconds = {}, 0.0
    with Session.joiner(info.digest, info.camera, info.settings) as session:
        for one in made:
            try:
                session.add(one.part)
            except LancerError as error:
                raise WrongPart(one.by, str(error)) from error
            makers.update(dict.fromkeys(one.by))
            seconds += one.seconds
        part = session.export()
    return Made(part, seconds + time.perf_counter() - before, tuple(makers), made[0].instruction_set)


class WrongPart(LancerError):
    """A part that does not fit. by: addresses of the workers that made it."""

    def __init__(self, by, text):
        super().__init__(text)
        self.by = by

    def __reduce__(self):
        return WrongPart, (self.by, str(self))


def _finish(session):
    while not session.wait(_STEP).finished:
        pass


def _scenery(name, data, threads):
    if name not in _scenes:
        # Free the oldest scene before the new one needs its memory.
        while len(_scenes) >= _KEPT:
            old, place = _scenes.popitem(last=False)
            for key in [key for key in _sessions if key[0] == old]:
                _sessions.pop(key).close()
            place.scene.close()
        snapshot = decoded(name, data())
        digest = scene_digest(snapshot)
        settings = snapshot.settings.replaced(in_parts=True, threads=threads, target_error=0.0, time_limit=0.0)
        camera = snapshot.camera
        snapshot.set("settings", settings)
        scene = Scene.upload(snapshot, release=True)
        scene.set_digest(digest)
        _scenes[name] = Scenery(scene, digest, camera, settings, tuple(scene.messages()))
    _scenes.move_to_end(name)
    return _scenes[name]


def _session(name, data, splits, threads):
    place = _scenery(name, data, threads)
    key = name, tuple(splits)
    if key not in _sessions:
        settings = place.settings.replaced(split_lights=splits[0], split_paths=splits[1])
        _sessions[key] = Session(place.scene, place.camera, settings)
    return _sessions[key]


def encoded(snapshot):
    """Return (name, bytes) of a snapshot."""
    file = io.BytesIO()
    snapshot.save(file)
    data = np.frombuffer(file.getbuffer(), np.uint8)
    return hashlib.sha256(data).hexdigest(), data


def decoded(name, data):
    """Return the snapshot of its bytes; raise LancerError if they were damaged."""
    if hashlib.sha256(data).hexdigest() != name:
        raise LancerError("the scene was damaged on its way to this worker")
    return SceneSnapshot.load(io.BytesIO(data))
