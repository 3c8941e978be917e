"""Whether Blender renders with Lancer now, and how that is ended before the add-on is taken away.

In a window Blender renders in a thread of its own, which uses the engine's class until the whole job is over: all view layers,
all frames. Handlers tell when that is.
"""

import contextlib
import threading
import time

import bpy
from bpy.app.handlers import persistent

from ..host import main_thread

_PATIENCE = 0.05  # seconds between two looks
# Seconds that Blender has for its own work after the engine's. Its end is not told where another add-on removes our handlers.
_LONGEST = 10.0

_over = threading.Event()
_over.set()
_enough = threading.Event()
_thread = None  # that renders
_working = False


@contextlib.contextmanager
def working():
    """For what the engine does in a render."""
    global _working
    _begin()
    _working = True
    try:
        yield
    finally:
        _working = False


def is_running():
    return not _over.is_set()


def is_ending():
    """Whether the add-on goes away: the engine has to come to an end."""
    return _enough.is_set()


def _end():
    """Ends the render that goes on in another thread, and waits for it."""
    _enough.set()
    if _thread is threading.current_thread():
        return
    until = time.monotonic() + _LONGEST
    while not _over.wait(_PATIENCE) and (_working or time.monotonic() < until):
        main_thread.serve()


def _begin():
    global _thread
    _thread = threading.current_thread()
    _over.clear()


@persistent
def _begun(scene, *_):
    # Blender's own work before the engine's first takes time, too.
    if scene.render.engine == main_thread.ENGINE:
        _begin()


@persistent
def _ended(*_):
    _over.set()


_HANDLERS = (("render_init", _begun), ("render_complete", _ended), ("render_cancel", _ended))


def register():
    _enough.clear()
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    """Comes first, while all of the add-on is there for the render that is ended."""
    _end()
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
