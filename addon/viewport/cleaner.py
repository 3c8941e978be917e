"""Denoising in a background thread, which the caller polls."""

import threading

from ..bindings.enums import Pass
from ..bindings.session import Cancelled
from ..denoise import denoiser

# Passes of the session that denoising needs besides Combined.
GUIDES = (Pass.ALBEDO, Pass.DENOISING_NORMAL)


class Cleaner:
    """Denoises a session's current picture; leaving the with statement cancels the work."""

    def __init__(self, session):
        self._arguments = [session.read(source) for source in (Pass.COMBINED, *GUIDES)]
        self._threads = session.settings.threads
        self._given_up = threading.Event()
        self._image = self._error = None
        self._thread = threading.Thread(target=self._work, name="lancer viewport denoising", daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._given_up.set()

    @property
    def is_over(self):
        return not self._thread.is_alive()

    def image(self):
        """Return the denoised image after is_over; raise the error if denoising failed."""
        if self._error is not None:
            raise self._error
        return self._image

    def _work(self):
        try:
            self._image = denoiser.denoise(*self._arguments, threads=self._threads, poll=self._given_up.is_set).image
        except Cancelled:
            pass
        except Exception as error:
            self._error = error
