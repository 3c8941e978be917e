"""Rendering of snapshots through the C interface: a committed Scene and the Sessions that render it.

    with Session.upload(snapshot) as session:
        session.render_all(64)
        picture = session.read(Pass.COMBINED)

poll is a function without arguments that is called at least every 0.1 s while waiting; it returns True to cancel.
"""

import ctypes
import dataclasses
import math
import weakref
from dataclasses import dataclass

import numpy as np

from . import abi, marshal
from .abi import LancerError, ObjectKind, Pass, Status, check, load_library
from .mapped_file import MappedPages
from .parts import SessionParts
from .probes import SceneProbes, SessionProbes, microfacet, pixel_filter, sampler
from .snapshot import InstanceTable
from .stock import Stock, file_of, key_of

__all__ = [
    "Cancelled",
    "LancerError",
    "PictureError",
    "Progress",
    "Scene",
    "Session",
    "Statistics",
    "microfacet",
    "pixel_filter",
    "sampler",
]

_STEP = 0.05


class Cancelled(Exception):
    """The user cancelled: poll returned True before there was a result."""


@dataclass(frozen=True)
class Progress:
    fraction: float
    seconds: float
    samples: int
    rays: int
    finished: bool  # the range has ended: done or cancelled
    cancelled: bool


@dataclass(frozen=True)
class Statistics:
    build_seconds: float
    render_seconds: float
    samples: int
    camera_rays: int
    bounce_rays: int
    shadow_rays: int
    invalid_samples: int
    invalid_x: int
    invalid_y: int
    invalid_sample: int
    threads: int
    triangles: int
    instances: int
    lights: int
    geometry_bytes: int
    accelerator_bytes: int
    film_bytes: int
    features: str
    kernel: str
    instruction_set: str
    texture_bytes: int
    mapped_bytes: int
    vertices: int
    split_lights: int
    split_paths: int

    @property
    def rays(self):
        return self.camera_rays + self.bounce_rays + self.shadow_rays

    @property
    def rays_per_second(self):
        return self.rays / self.render_seconds if self.render_seconds > 0 else 0.0


@dataclass(frozen=True)
class PictureError:
    """The error estimate of a picture: lancer_error of lancer.h."""

    error: float  # infinity while it is unknown
    low: float
    high: float
    cannot_exclude: float
    clipped: float
    missing: float
    planned_samples: float
    least_samples: int
    most_samples: int

    @property
    def known(self):
        return math.isfinite(self.error)

    @property
    def bound(self):
        """The upper bound of the error at the requested confidence."""
        return self.high + self.cannot_exclude


def _destroy(destroy, handle, _pages):
    destroy(handle)


class _Handle:
    """Owner of a handle. close() may be called repeatedly; garbage collection closes the handle too."""

    def _own(self, library, destroy, handle, pages):
        """pages: the MappedPages that the library reads as long as it has the handle; None without a scene."""
        self.library = library
        self.handle = handle
        self.pages = pages
        self._finalizer = weakref.finalize(self, _destroy, destroy, handle, pages)

    def close(self):
        self._finalizer()

    @property
    def is_open(self):
        return self._finalizer.alive

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _check(self, status):
        return check(status, self.library)


class Scene(_Handle, SceneProbes):
    """A scene in the library: create, fill, commit; upload() does all three.

    before: a committed scene that differs little; the commit makes only the parts that differ. Both may be closed in any order,
    also by another thread: a scene that is closed already is as none.
    stock: the Stock of the scenes that share objects; a scene without one shares those of before, or none.
    """

    def __init__(self, library=None, before=None, stock=None):
        handle = ctypes.c_uint64()
        library = before.library if before is not None else library or load_library()
        if before is not None:
            status = library.lancer_scene_edit(before.handle, ctypes.byref(handle))
            if status == Status.ERROR_HANDLE:
                before = None
            else:
                check(status, library)
        if before is None:
            check(library.lancer_scene_create(ctypes.byref(handle)), library)
        self._own(library, library.lancer_scene_destroy, handle.value, MappedPages())
        self._stock = stock or (Stock() if before is None else before._stock)
        self._parts = []
        self._instances = None if before is None else before._instances

    @classmethod
    def upload(cls, snapshot, library=None, poll=None, release=False, before=None, stock=None, filled=None):
        """Return a committed scene with the accelerator and threads of the snapshot's settings.

        release: see fill. filled: is called when all records are copied, before the commit.
        """
        scene = cls(library, before, stock)
        try:
            scene.fill(snapshot, poll, release)
            if filled is not None:
                filled()
            scene.commit(snapshot.settings.accelerator, snapshot.settings.threads, poll)
        except BaseException:
            scene.close()
            raise
        return scene

    def fill(self, snapshot, poll=None, release=False):
        """Copy the snapshot into the library, which reads Blocks in place.

        release: remove each part from the snapshot when copied, to save memory; it is not known again.
        """
        for _ in self.filling(snapshot, release):
            _obey(poll)

    def filling(self, snapshot, release=False):
        """Run fill() in steps: yield after each record that was copied, so that the caller can poll."""
        images = yield from self._set(ObjectKind.IMAGE, snapshot, "images", (), release)
        yield from self._set(ObjectKind.MESH, snapshot, "meshes", (), release)
        yield from self._set(ObjectKind.MATERIAL, snapshot, "materials", images, release)
        yield from self._set(ObjectKind.LIGHT, snapshot, "lights", images, release)
        world, made = self._stock.part(self.library, ObjectKind.WORLD, snapshot.world, 0, images, not release)
        self._give(ObjectKind.WORLD, [world])
        if made:
            yield
        if snapshot.instances is not self._instances:
            self._set_instances(snapshot.instances)
            self._instances = snapshot.instances
            yield
        if release:
            snapshot.set("instances", InstanceTable())
            self._instances = None

    def _set(self, kind, snapshot, name, images, release):
        """Give the scene the objects of one kind; yield after each that was made, and return all Parts."""
        records = list(reversed(getattr(snapshot, name)))
        if release:
            snapshot.set(name, ())
        parts = []
        while records:
            # The struct holds addresses of the record's arrays: keep the record until it is copied.
            record = records.pop()
            if kind == ObjectKind.IMAGE and file_of(record) is not None:
                self.pages.add(file_of(record))
            part, made = self._stock.part(self.library, kind, record, len(parts), images, not release)
            parts.append(part)
            if made:
                yield
        self._give(kind, parts)
        return parts

    def _give(self, kind, parts):
        handles = np.array([part.handle for part in parts], np.uint64)
        self._check(self.library.lancer_scene_set_objects(self.handle, int(kind), len(handles), handles.ctypes.data))
        self._parts.extend(parts)

    def _set_instances(self, table):
        self._check(self.library.lancer_scene_clear_instances(self.handle))
        if not len(table):
            return
        self._check(self.library.lancer_scene_add_instances(self.handle, *marshal.instances(table)))
        if table.infos is not None:
            self._check(self.library.lancer_scene_set_object_infos(self.handle, len(table.infos), table.infos.ctypes.data))
        for attribute in table.attributes:
            self._check(self.library.lancer_scene_add_object_attribute(self.handle, *marshal.object_attribute(attribute)))

    def likeness(self, snapshot):
        """Return how many meshes of a snapshot may be those of this scene, by name and size."""
        known = {part.key for part in self._parts}
        return sum(key_of(ObjectKind.MESH, mesh) in known for mesh in snapshot.meshes)

    def set_digest(self, digest):
        """Name the scene in parts of pictures: 32 bytes of bindings.digest.scene_digest."""
        if len(digest) != 32:
            raise ValueError(f"a digest has 32 bytes, not {len(digest)}")
        self._check(self.library.lancer_scene_set_digest(self.handle, bytes(digest)))

    def commit(self, accelerator=abi.Accelerator.BVH, threads=0, poll=None):
        self.begin_commit(accelerator, threads)
        while not self.is_committed(_STEP):
            if poll is not None and poll():
                self._check(self.library.lancer_scene_cancel(self.handle))
                while not self.is_committed(_STEP):
                    pass
                raise Cancelled

    def begin_commit(self, accelerator=abi.Accelerator.BVH, threads=0):
        self._check(self.library.lancer_scene_commit(self.handle, int(accelerator), int(threads)))

    def is_committed(self, seconds=0.0):
        """Wait at most that long and return whether the commit has ended; raise LancerError if it failed."""
        status = self._check(self.library.lancer_scene_wait(self.handle, int(seconds * 1000)))
        self.pages.keep_under()
        return status is not Status.RUNNING

    def messages(self):
        """Return one line for each part of the scene that the library left out or replaced."""
        needed = ctypes.c_size_t()
        self._check(self.library.lancer_scene_messages(self.handle, None, 0, ctypes.byref(needed)))
        text = ctypes.create_string_buffer(max(1, needed.value))
        self._check(self.library.lancer_scene_messages(self.handle, text, len(text), None))
        return text.value.decode("utf-8", "replace").splitlines()


class Session(_Handle, SessionParts, SessionProbes):
    """A film over a committed scene. The scene stays open when the session closes, unless upload() created it."""

    def __init__(self, scene, camera, settings):
        library = scene.library
        self._create(library, scene, camera, settings, library.lancer_session_create, scene.handle)

    def _create(self, library, scene, camera, settings, create, identity):
        handle = ctypes.c_uint64()
        arguments = ctypes.byref(marshal.camera(camera)), ctypes.byref(marshal.settings(settings))
        check(create(identity, *arguments, ctypes.byref(handle)), library)
        self._own(library, library.lancer_session_destroy, handle.value, None if scene is None else scene.pages)
        self.scene = scene
        self.camera = camera
        self.settings = settings
        self._owns_scene = False

    @classmethod
    def joiner(cls, digest, camera, settings, library=None):
        """Return a session without a scene, which joins parts of pictures and cannot render; settings.refines must be set."""
        library = library or load_library()
        session = cls.__new__(cls)
        session._create(library, None, camera, settings, library.lancer_session_create_joiner, bytes(digest))
        return session

    @classmethod
    def upload(cls, snapshot, library=None, poll=None, release=False, before=None, stock=None, filled=None):
        """Create the scene and the session of a snapshot; close() frees both. release, filled: see Scene.upload."""
        scene = Scene.upload(snapshot, library, poll, release, before, stock, filled)
        try:
            session = cls(scene, snapshot.camera, snapshot.settings)
        except BaseException:
            scene.close()
            raise
        session._owns_scene = True
        return session

    def close(self):
        super().close()
        if self._owns_scene:
            self.scene.close()

    def render(self, first, count):
        """Start samples first to first + count - 1 of every pixel in the background; wait() reports their progress."""
        self._check(self.library.lancer_session_render(self.handle, int(first), int(count)))

    def wait(self, seconds):
        """Wait at most that long and return the Progress of the range."""
        progress = abi.Progress()
        milliseconds = max(0, round(seconds * 1000))
        status = self._check(self.library.lancer_session_wait(self.handle, milliseconds, ctypes.byref(progress)))
        if self.pages is not None:
            self.pages.keep_under()
        return Progress(
            progress.fraction,
            progress.seconds,
            progress.samples,
            progress.rays,
            finished=status is not Status.RUNNING,
            cancelled=status is Status.CANCELLED,
        )

    def cancel(self):
        self._check(self.library.lancer_session_cancel(self.handle))

    def stop(self):
        """Cancel, but keep a power of two of samples per pixel, so that the session can continue."""
        self._check(self.library.lancer_session_stop(self.handle))

    def refine(self, target=0.0, confidence=0.95):
        """Start a round that doubles the samples of the pixels that reduce the error most; False if no pixel is left.

        Requires settings.refines.
        """
        return self._check(self.library.lancer_session_refine(self.handle, float(target), float(confidence))) is Status.OK

    def error(self, confidence=0.95):
        """Return the PictureError of the film's current state."""
        raw = abi.Error()
        self._check(self.library.lancer_session_error(self.handle, float(confidence), ctypes.byref(raw)))
        return PictureError(**{f.name: getattr(raw, f.name) for f in dataclasses.fields(PictureError)})

    def render_all(self, samples=None, poll=None):
        """Render samples 0 to samples - 1, by default the settings' number; return False if poll cancelled."""
        self.render(0, self.settings.samples if samples is None else samples)
        while True:
            progress = self.wait(_STEP)
            if progress.finished:
                return not progress.cancelled
            if poll is not None and poll():
                self.cancel()

    def read(self, which=Pass.COMBINED):
        """Return one pass of the region as (height, width, channels) float32; row 0 is the bottom row."""
        which = Pass(which)
        out = np.empty((self.camera.region_height, self.camera.region_width, which.channels), np.float32)
        self._check(self.library.lancer_session_read(self.handle, int(which), out.ctypes.data, out.size))
        return out

    def statistics(self):
        raw = abi.Statistics()
        self._check(self.library.lancer_session_statistics(self.handle, ctypes.byref(raw)))
        values = {f.name: getattr(raw, f.name) for f in dataclasses.fields(Statistics)}
        return Statistics(**{k: v.decode("utf-8", "replace") if isinstance(v, bytes) else v for k, v in values.items()})

    def messages(self):
        return self.scene.messages() if self.scene is not None else []

    def debug_sample(self, x, y, s, capacity=64):
        """Trace sample s of pixel (x, y) again; return its RGBA and its vertices (a record array of lancer_vertex)."""
        rgba = np.zeros(4, np.float32)
        vertices = np.zeros(capacity, np.dtype(abi.Vertex))
        count = ctypes.c_uint32()
        arguments = int(x), int(y), int(s), rgba.ctypes.data, vertices.ctypes.data, capacity, ctypes.byref(count)
        self._check(self.library.lancer_debug_sample(self.handle, *arguments))
        return rgba, vertices[: min(capacity, count.value)].view(np.recarray)


def _obey(poll):
    if poll is not None and poll():
        raise Cancelled
