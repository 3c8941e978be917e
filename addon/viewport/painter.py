"""The thread of one view: builds the scene that is wanted, renders the view that is wanted, ever finer. Knows no bpy data."""

import dataclasses
import logging
import threading
import time
from typing import NamedTuple

import numpy as np

from .. import denoise, priority
from ..bindings.abi import LancerError
from ..bindings.schedule import Schedule
from ..bindings.session import Cancelled, PictureError, Scene, Session
from ..bindings.snapshot import SceneSnapshot, Settings
from ..export.view import View
from ..pace import Pace
from .sizes import PixelSizes

_STEP = 0.005
# Seconds that work may take before what is wanted later ends it: a view that moves all the time must show something, too.
_BRIEF = 0.25
# Of the picture that refines: seconds between two that are shown, and the share of the time for showing, for asking for the
# error, for denoising.
_SHOW_EVERY, _SHOW_SHARE = 0.15, 0.1
_ERROR_EVERY, _ERROR_SHARE = 0.5, 0.03
_DENOISE_EVERY, _DENOISE_SHARE = 0.3, 0.3
# Times as many samples as what guides the denoising now was made of are worth better guides.
_BETTER_GUIDES = 4


class Wanted(NamedTuple):
    contents: SceneSnapshot  # another object is another scene; its camera has no meaning
    settings: Settings
    view: View
    finest: int  # side of a pixel in the region's
    coarsest: int
    denoising: bool


class Picture(NamedTuple):
    image: np.ndarray  # (height, width, 4), premultiplied, scene-linear, row 0 is the bottom one
    wanted: Wanted
    size: int  # side of its pixels in the region's
    samples: int
    error: PictureError | None
    denoised: bool


class Painter(threading.Thread):
    """picture is the newest one; failure is why there is none of what is wanted; messages are the library's own."""

    def __init__(self):
        super().__init__(name="lancer viewport", daemon=True)
        self.picture = None
        self.failure = ""
        self.messages = ()
        self.waits = False  # for another one's render: nothing is refined beyond what was asked for first
        self._changed = threading.Condition()
        self._wanted = None
        self._served = None
        self._closing = False
        self._scene = self._contents = None
        self._sizes = PixelSizes()

    def want(self, wanted):
        with self._changed:
            self._wanted = wanted
            self._changed.notify()

    def close(self):
        """Asks for the end, without waiting for it."""
        with self._changed:
            self._closing = True
            self._changed.notify()

    @property
    def is_busy(self):
        return self.is_alive() and self._served is not self._wanted

    @property
    def is_building(self):
        return self.is_busy and self._contents is not self._wanted.contents

    def run(self):
        priority.lower()
        while (wanted := self._next()) is not None:
            try:
                if self._contents is wanted.contents:
                    self._refine(wanted)
                    self._served = wanted
                else:
                    self._build(wanted)
                self.failure = ""
            except Cancelled:
                continue
            except LancerError as error:
                self._fail(wanted, str(error))
            except MemoryError:
                self._fail(wanted, "not enough memory for this scene")
            except Exception as error:
                logging.getLogger(__name__).exception("the viewport failed")
                self._fail(wanted, f"{type(error).__name__}: {error}")
        self._drop()

    def _next(self):
        """What is wanted and not yet served; None at the end."""
        with self._changed:
            self._changed.wait_for(lambda: self._closing or self._wanted is not self._served)
            return None if self._closing else self._wanted

    def _fail(self, wanted, text):
        self.failure = text
        self._served = wanted

    def _is_over(self, began, same):
        """Whether work on something older may end: same tells of what is wanted now whether that work serves it, too."""
        if self._closing:
            return True
        return not same(self._wanted) and time.monotonic() - began > _BRIEF

    def _drop(self):
        self._contents = None
        if self._scene is not None:
            self._scene.close()
            self._scene = None

    def _build(self, wanted):
        # Two scenes at once would take twice the memory.
        self._drop()
        began = time.monotonic()
        self._scene = Scene.upload(
            wanted.contents, poll=lambda: self._is_over(began, lambda now: now.contents is wanted.contents)
        )
        self.messages = self._scene.messages()
        self._contents = wanted.contents

    def _refine(self, wanted):
        rectangle = wanted.view.rectangle
        size = self._sizes.first(rectangle, wanted.finest, wanted.coarsest)
        shown = False
        while size > wanted.finest:
            self._render(wanted, size, brief=not shown)
            shown = True
            size = self._sizes.after(size, rectangle, wanted.finest)
        self._render(wanted, size, brief=not shown)

    def _render(self, wanted, size, brief):
        """One sample of the view with pixels of that size; at the finest, all samples. brief: let be finished what is brief."""
        began = time.monotonic()
        is_last = size == wanted.finest
        settings = wanted.settings if is_last else dataclasses.replace(wanted.settings, samples=1)
        camera = wanted.view.coarser(size)
        with Session(self._scene, camera, settings) as session:
            schedule = Schedule(session)
            shown = _Shown(session, schedule, wanted, size, self._is_wanted)
            while schedule.start():
                while not schedule.wait(_STEP).finished:
                    may_finish = brief and schedule.samples == 0
                    if self._is_over(began if may_finish else 0.0, lambda now: now is wanted):
                        schedule.cancel()
                        raise Cancelled
                if schedule.samples == 1:
                    self._sizes.learn(camera.width * camera.height, time.monotonic() - began)
                picture = shown.picture(denoising=wanted.denoising and is_last)
                if picture is not None:
                    self.picture = picture
                schedule.longest = shown.interval
                self._pause(wanted)

    def _is_wanted(self, wanted):
        return self._wanted is wanted and not self._closing

    def _pause(self, wanted):
        """Gives way to another render, as long as nothing else is wanted."""
        with self._changed:
            while self.waits and self._is_wanted(wanted):
                self._changed.wait(0.1)
        if not self._is_wanted(wanted):
            raise Cancelled


class _Shown:
    """Which of the states of a session are shown, and as what."""

    def __init__(self, session, schedule, wanted, size, is_wanted):
        self._session, self._schedule, self._wanted, self._size = session, schedule, wanted, size
        self._is_wanted = is_wanted
        self._picture, self._error = Pace(_SHOW_SHARE, _SHOW_EVERY), Pace(_ERROR_SHARE, _ERROR_EVERY)
        self._denoising = Pace(_DENOISE_SHARE, _DENOISE_EVERY)
        self._guides, self._guided_by = None, 0
        self._made = None

    @property
    def interval(self):
        return self._picture.interval

    def picture(self, denoising):
        """The Picture as it is now; None where it is too early for another one."""
        samples = self._schedule.samples
        if samples > 1 and (self._error.due or self._schedule.over):
            self._error.spend(self._schedule.look)
        pace, make = (self._denoising, self._denoised) if denoising else (self._picture, self._session.read)
        if not (pace.due or self._schedule.over):
            return None
        pace.spend(lambda: self._make(make))
        return Picture(self._made, self._wanted, self._size, samples, self._schedule.error, denoising)

    def _make(self, make):
        self._made = make()

    def _denoised(self):
        def poll():
            return not self._is_wanted(self._wanted)

        samples = self._schedule.samples
        # Few samples make rough guides.
        if samples >= _BETTER_GUIDES * self._guided_by and self._guided_by < denoise.GUIDE_SAMPLES:
            self._guides, self._guided_by = denoise.render_guides(self._session, poll), samples
        denoised, failure = denoise.apply(self._session, poll, guides=self._guides)
        if failure:
            raise LancerError(failure)
        if denoised is None:
            raise Cancelled
        return denoised.image
