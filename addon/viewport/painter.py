"""Building of a view's scene and progressive rendering of the view. No bpy data.

The library works in threads of its own, and the painter never waits for it: step() does the work that is possible without
waiting, in the calling thread. There is no Python thread, since Blender accesses script contexts without Python's lock in
places and a thread can then crash it.
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
from ..host import priority, shared_scenes
from ..measure.schedule import Schedule, TimeShare
from .cleaner import GUIDES, Cleaner
from .sizes import PixelSizes

# Seconds of work that a later request does not interrupt, so that a view in constant motion shows something too.
_BRIEF = 0.25
# Seconds of copying a scene into the library before Blender gets control again.
_PIECE = 0.02
# While a picture refines: least seconds between updates, and the share of the time for showing.
_SHOW_EVERY, _SHOW_SHARE = 0.15, 0.1
# Pictures, shown or not, from one that is denoised to the next: most of the time is for samples.
_DENOISE_EACH = 2


class Wanted(NamedTuple):
    contents: SceneSnapshot  # compared by identity; its camera is ignored
    settings: Settings
    view: View
    finest: int  # side of a pixel in pixels of the region
    coarsest: int
    denoising: bool


class ViewPicture(NamedTuple):
    image: np.ndarray  # (height, width, 4), premultiplied, scene-linear, row 0 at the bottom
    wanted: Wanted
    size: int  # side of its pixels in pixels of the region
    samples: int
    error: PictureError | None
    denoised: bool


class Painter:
    """picture: the newest ViewPicture; failure: why the wanted view cannot be rendered; messages: lines of the library."""

    def __init__(self):
        self.picture = None
        self.failure = ""
        self.messages = ()
        self.waits = False  # during another render: finish the current range only
        self._wanted = self._served = None
        self._scene = self._contents = None
        self._sizes = PixelSizes()
        self._work = None  # a generator that yields where it would have to wait
        self._works_on = None  # the Wanted that _work serves
        self._began = 0.0
        self._brief = False  # whether _work may still finish within _BRIEF after a newer request

    def want(self, wanted):
        self._wanted = wanted

    @property
    def is_busy(self):
        return self._served is not self._wanted

    @property
    def is_building(self):
        return self.is_busy and self._contents is not self._wanted.contents

    def step(self):
        """Do all work that is possible without waiting."""
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
        """End all work and free the library's scene."""
        self._stop()
        self._drop()
        self._wanted = self._served = None

    def _advance(self):
        """Take one step of the work; return whether another step is possible without waiting."""
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
        """Whether the current work is obsolete and must end."""
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
        contents = wanted.contents
        before = self._scene or shared_scenes.nearest(contents)
        scene = Scene(before=before, stock=shared_scenes.stock)
        try:
            yield from self._filled(scene, contents)
            settings = contents.settings
            priority.lowered(lambda: scene.begin_commit(settings.accelerator, settings.threads))
            while not scene.is_committed():
                yield
        except BaseException:
            scene.close()
            raise
        self._drop()
        self.messages, self.failure = scene.messages(), ""
        self._scene, self._contents = scene, contents
        shared_scenes.remember(scene)

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
        """Render the view with pixels of that size."""
        denoising = wanted.denoising and size == wanted.finest
        passes = (Pass.COMBINED, *GUIDES) if denoising else (Pass.COMBINED,)
        blended = wanted.settings.blended_features or denoising
        settings = dataclasses.replace(wanted.settings, samples=samples, passes=passes, blended_features=blended)
        camera = wanted.view.coarser(size)
        with priority.lowered(lambda: Session(self._scene, camera, settings)) as session, Cleaner(session) as cleaner:
            schedule = Schedule(session)
            schedule.longest = _SHOW_EVERY
            shown = TimeShare(_SHOW_SHARE, _SHOW_EVERY)
            looked, pictures, clean = 1, 0, False
            while schedule.start():
                while not (progress := schedule.wait(0.0)).finished:
                    clean = self._take(cleaner) or clean
                    yield
                if schedule.samples == 1:
                    # progress.seconds excludes the constant cost of each picture.
                    self._sizes.learn(camera.width * camera.height, progress.seconds)
                # Reading the error takes as long as drawing several pictures: do it each time the samples have doubled.
                if schedule.samples >= 2 * looked or samples > 1 and schedule.over:
                    looked = schedule.samples
                    schedule.look()
                    # Blender gets control before the picture is read, too.
                    yield
                if shown.due or schedule.over:
                    with shown.spending():
                        about = ViewPicture(None, wanted, size, schedule.samples, schedule.error, False)
                        # A noisy picture would flicker between denoised ones.
                        if not clean:
                            self.picture = about._replace(image=session.read())
                    while denoising and schedule.over and cleaner.is_busy:
                        clean = self._take(cleaner) or clean
                        yield
                    if denoising and not cleaner.is_busy and (pictures % _DENOISE_EACH == 0 or schedule.over):
                        cleaner.give(about, schedule.samples)
                        pictures = 0
                    pictures += 1
                    schedule.longest = max(_SHOW_EVERY, shown.interval)
                    self._brief = False
                while self.waits:
                    yield
            while cleaner.is_busy:
                self._take(cleaner)
                yield

    def _take(self, cleaner):
        """Show the denoised picture if it is ready, and return whether it is; add a message if denoising failed."""
        try:
            taken = cleaner.take()
        except (LancerError, MemoryError) as error:
            line = f"{error or 'there is not enough memory for denoising'}; {denoise.AS_IT_IS}"
            if line not in self.messages:
                self.messages = (*self.messages, line)
            return False
        if taken is not None:
            about, image = taken
            self.picture = about._replace(image=image, denoised=True)
        return taken is not None
