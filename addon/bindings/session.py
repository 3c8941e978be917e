"""Rendering of snapshots through the C interface: the Sessions that render a committed Scene.

    with Session.upload(snapshot) as session:
        session.render_all(64)
        picture = session.read(Pass.COMBINED)

poll is a function without arguments that is called at least every 0.1 s while waiting; it returns True to cancel.
"""

import ctypes
import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from . import abi, marshal
from .abi import LancerError, Pass, Status, check, load_library
from .handle import Handle
from .numbered_pass import NumberedPass
from .parts import SessionParts
from .probes import SessionProbes, microfacet, pixel_filter, sampler
from .scene import STEP, Cancelled, Scene

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
    clipped_direct: float
    cut: float
    no_caustics: float
    filtered: float
    filtered_error: float
    guessed: float
    guessed_error: float
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


class Session(Handle, SessionParts, SessionProbes):
    """A film over a committed scene. The scene stays open when the session closes, unless upload() created it."""

    def __init__(self, scene, camera, settings):
        library = scene.library
        self._create(library, scene, camera, settings, library.lancer_session_create, scene.handle)

    def _create(self, library, scene, camera, settings, create, identity, *more):
        handle = ctypes.c_uint64()
        arguments = ctypes.byref(marshal.camera(camera)), ctypes.byref(marshal.settings(settings)), *more
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
    def bake(cls, scene, camera, settings, texels):
        """Return a session whose pixels are the Texels of a surface; the camera has their width and height."""
        session = cls.__new__(cls)
        create, bake = scene.library.lancer_session_create_bake, texels.as_struct()
        session._create(scene.library, scene, camera, settings, create, scene.handle, ctypes.byref(bake))
        return session

    @classmethod
    def upload(cls, snapshot, library=None, poll=None, release=False, before=None, stock=None, filled=None, digest=None):
        """Create the scene and the session of a snapshot; close() frees both. release, filled: see Scene.upload.

        digest: names the scene in parts of pictures.
        """
        scene = Scene.upload(snapshot, library, poll, release, before, stock, filled)
        try:
            if digest is not None:
                scene.set_digest(digest)
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
            progress = self.wait(STEP)
            if progress.finished:
                return not progress.cancelled
            if poll is not None and poll():
                self.cancel()

    def read(self, which=Pass.COMBINED):
        """Return one pass of the region as (height, width, channels) float32; row 0 is the bottom row.

        which: a Pass, or a NumberedPass.
        """
        is_numbered = isinstance(which, NumberedPass)
        which = which if is_numbered else Pass(which)
        address = which.address if is_numbered else int(which)
        out = np.empty((self.camera.region_height, self.camera.region_width, which.channels), np.float32)
        self._check(self.library.lancer_session_read(self.handle, address, out.ctypes.data, out.size))
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
