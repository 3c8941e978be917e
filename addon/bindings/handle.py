"""Handles of the library, which are closed at the latest with their owner."""

import weakref

from .abi import check


def _destroy(destroy, handle, _pages):
    destroy(handle)


class Handle:
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
