"""Builds the scene that a view wants and renders what it shows, ever finer. Knows no bpy data.

The library works in threads of its own. Here nothing waits for it: step() goes on as far as it can, in the thread that calls
it. Blender reads contexts of scripts without Python's lock in places, so a thread of Python's would end it now and then.
"""

import dataclasses
import logging
import time
from typing import NamedTuple

import numpy as np

from ..bindings.abi import LancerError
from ..bindings.enums import Pass
from ..bindings.session import PictureError, Scene, Session
from ..bindings.snapshot import SceneSnapshot, Settings
from ..denoise import view_layer as denoise
from ..export.view import View
from ..host import priority
from ..measure.schedule import Schedule, TimeShare
from .cleaner import GUIDES, Cleaner
from .sizes import PixelSizes

# Seconds that work may take before what is wanted later ends it: a view that moves all the time must show something, too.
_BRIEF = 0.25
# Of copying a scene into the library, between two other things that Blender does.
_PIECE = 0.02
# Of the picture that refines: seconds between two that are shown, and the share of the time for showing and for denoising.
_SHOW_EVERY, _SHOW_SHARE = 0.15, 0.1
_DENOISE_EVERY, _DENOISE_SHARE = 0.3, 0.5


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


class Painter:
    """picture is the newest one; failure is why there is none of what is wanted; messages are lines of the library's."""

    def __init__(self):
        self.picture = None
        self.failure = ""
        self.messages = ()
        self.waits = False  # for a render of others: nothing is refined beyond the sample that is being made
        self._wanted = self._served = None
        self._scene = self._contents = None
        self._sizes = PixelSizes()
        self._work = None  # a generator, which yields where it would have to wait
        self._works_on = None  # the Wanted that it serves
        self._began = 0.0
        self._brief = False  # whether it may be finished, if it is soon, though another thing is wanted by now

    def want(self, wanted):
        self._wanted = wanted

    @property
    def is_busy(self):
        return self._served is not self._wanted

    @property
    def is_building(self):
        return self.is_busy and self._contents is not self._wanted.contents

    def step(self):
        """Does what can be done now."""
        try:
            while self.is_busy and self._advance():
                pass
        except LancerError as error:
            self._fail(str(error))
        except MemoryError:
            self._fail("not enough memory for this scene")
        except Exception as error:
            logging.getLogger(__name__).exception("the viewport failed")
            self._fail(f"{type(error).__name__}: {error}")

    def close(self):
        """Ends all work and frees what the library holds."""
        self._stop()
        self._drop()
        self._wanted = self._served = None

    def _advance(self):
        """Whether there is more to do at once."""
        if self._work is None:
            self._begin(self._wanted)
        elif self._is_late():
            self._stop()
            return True
        try:
            next(self._work)
        except StopIteration:
            self._work = None
            return True
        return False

    def _begin(self, wanted):
        self._works_on, self._began = wanted, time.monotonic()
        self._brief = True
        self._work = self._refine(wanted) if self._contents is wanted.contents else self._build(wanted)

    def _is_late(self):
        """Whether what is being done is not wanted any more."""
        now, then = self._wanted, self._works_on
        building = self._contents is not then.contents
        if now is then or building and now.contents is then.contents:
            return False
        return not self._brief or time.monotonic() - self._began > _BRIEF

    def _stop(self):
        if self._work is not None:
            self._work.close()
            self._work = None

    def _fail(self, text):
        self._work = None
        self.failure = text
        self._served = self._wanted

    def _drop(self):
        self._contents = None
        if self._scene is not None:
            self._scene.close()
            self._scene = None

    def _build(self, wanted):
        # Two scenes at once would take twice the memory.
        self._drop()
        scene, contents = Scene(), wanted.contents
        try:
            yield from self._filled(scene, contents)
            settings = contents.settings
            priority.lowered(lambda: scene.begin_commit(settings.accelerator, settings.threads))
            while not scene.is_committed():
                yield
        except BaseException:
            scene.close()
            raise
        self.messages, self.failure = scene.messages(), ""
        self._scene, self._contents = scene, contents

    @staticmethod
    def _filled(scene, contents):
        began = time.monotonic()
        for _ in scene.filling(contents):
            if time.monotonic() - began > _PIECE:
                yield
                began = time.monotonic()

    def _refine(self, wanted):
        rectangle = wanted.view.rectangle
        size = self._sizes.first(rectangle, wanted.finest, wanted.coarsest)
        while size > wanted.finest:
            yield from self._render(wanted, size, 1)
            size = self._sizes.after(size, rectangle, wanted.finest)
        yield from self._render(wanted, size, wanted.settings.samples)
        self._served, self.failure = wanted, ""

    def _render(self, wanted, size, samples):
        """The view with pixels of that size."""
        denoising = wanted.denoising and size == wanted.finest
        passes = (Pass.COMBINED, *GUIDES) if denoising else (Pass.COMBINED,)
        settings = dataclasses.replace(wanted.settings, samples=samples, passes=passes)
        camera = wanted.view.coarser(size)
        with priority.lowered(lambda: Session(self._scene, camera, settings)) as session:
            schedule = Schedule(session)
            schedule.longest = _SHOW_EVERY
            shown = TimeShare(_DENOISE_SHARE, _DENOISE_EVERY) if denoising else TimeShare(_SHOW_SHARE, _SHOW_EVERY)
            looked = 1
            while schedule.start():
                while not (progress := schedule.wait(0.0)).finished:
                    yield
                if schedule.samples == 1:
                    # Without what every picture takes, however coarse.
                    self._sizes.learn(camera.width * camera.height, progress.seconds)
                # To ask for the error takes as long as to draw some pictures.
                if schedule.samples >= 2 * looked or samples > 1 and schedule.over:
                    looked = schedule.samples
                    schedule.look()
                if shown.due or schedule.over:
                    with shown.spending():
                        clean = (yield from self._clean(session)) if denoising else None
                        image = session.read() if clean is None else clean
                    self.picture = Picture(image, wanted, size, schedule.samples, schedule.error, clean is not None)
                    schedule.longest = max(_SHOW_EVERY, shown.interval)
                    self._brief = False
                while self.waits:
                    yield

    def _clean(self, session):
        """The picture without its noise; None, with a message, where that fails."""
        try:
            with Cleaner(session) as cleaner:
                while not cleaner.is_over:
                    yield
                return cleaner.image()
        except (LancerError, MemoryError) as error:
            line = f"{error or 'there is not enough memory for denoising'}; {denoise.AS_IT_IS}"
            if line not in self.messages:
                self.messages = (*self.messages, line)
        return None
