"""Denoising in a background thread, while the session goes on; the caller polls."""

import threading

from ..bindings import shadowed
from ..bindings.enums import Catchers, Pass
from ..bindings.session import Cancelled
from ..denoise import denoiser, shadows
from ..denoise.plan import plan

# Passes of the session that denoising needs besides Combined.
GUIDES = (Pass.ALBEDO, Pass.DENOISING_NORMAL)


class Cleaner:
    """Denoises the pictures of a session that it gets, one at a time. Leaving the with statement cancels the work."""

    def __init__(self, session):
        self._session = session
        self._given_up = threading.Event()
        self._thread = self._image = self._error = self._what = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._given_up.set()

    @property
    def is_busy(self):
        """Whether a picture was given whose result was not taken yet."""
        return self._thread is not None

    def give(self, what, samples):
        """Denoise the session's current picture, with that many samples; what: comes back with the result."""
        guides = [self._session.read(source) for source in GUIDES]
        if self._session.settings.catchers != Catchers.OBJECTS:
            clean, picture = shadows.denoise_parts, shadowed.parts_of(self._session)
        else:
            clean, picture = denoiser.denoise, self._session.read(Pass.COMBINED)
        arguments = clean, picture, guides, plan(guides[0].shape[0] * guides[0].shape[1], samples)
        self._what = what
        self._thread = threading.Thread(target=self._work, args=arguments, name="lancer viewport denoising", daemon=True)
        self._thread.start()

    def take(self):
        """Return (what, image) of the given picture, or None while it is not denoised; raise the error of a failure."""
        if self._thread is None or self._thread.is_alive():
            return None
        self._thread = None
        if self._error is not None:
            error, self._error = self._error, None
            raise error
        return self._what, self._image

    def _work(self, clean, picture, guides, how):
        threads = self._session.settings.threads
        try:
            self._image = clean(picture, *guides, plan=how, threads=threads, poll=self._given_up.is_set).image
        except Cancelled:
            pass
        except Exception as error:
            self._error = error
