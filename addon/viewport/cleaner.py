"""Denoising beside everything else: Open Image Denoise in a thread, which is asked whether it is over."""

import threading

from ..bindings.enums import Pass
from ..bindings.session import Cancelled
from ..denoise import denoiser

# Passes of the session that it needs beside Combined.
GUIDES = (Pass.ALBEDO, Pass.DENOISING_NORMAL)


class Cleaner:
    """Denoises what a session has now; leaving the with statement gives it up."""

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
        """Once it is over; raises what went wrong."""
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
