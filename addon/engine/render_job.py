"""State of Blender's render job with Lancer, and its end before the add-on is unregistered.

In a window Blender renders in a thread of its own, which uses the engine's class until the whole job has ended: all view
layers, all frames. Handlers signal the end.
"""

import contextlib
import threading
import time

from bpy.app.handlers import persistent

from ..host import main_thread
from ..host.registering import add_handlers, remove_handlers

_PATIENCE = 0.05  # seconds between checks
# Longest seconds of Blender's own work after the engine's; without the limit a removed handler would block for ever.
_LONGEST = 10.0

_over = threading.Event()
_over.set()
_enough = threading.Event()
_thread = None  # the render thread
_working = False


@contextlib.contextmanager
def working():
    """Context of the engine's work in a render."""
    global _working
    _begin()
    _working = True
    try:
        yield
    finally:
        _working = False


@contextlib.contextmanager
def baking():
    """Context of the engine's work in a bake, which Blender tells by no handler."""
    with working():
        yield
    _over.set()


def is_running():
    return not _over.is_set()


def is_ending():
    """Whether the add-on is being unregistered, so that the engine must end."""
    return _enough.is_set()


def _end():
    """End a render in another thread and wait for it."""
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
    # The job begins before Blender first calls the engine.
    if scene.render.engine == main_thread.ENGINE:
        _begin()


@persistent
def _ended(*_):
    _over.set()


_HANDLERS = (("render_init", _begun), ("render_complete", _ended), ("render_cancel", _ended))


def register():
    _enough.clear()
    add_handlers(_HANDLERS)


def unregister():
    """End a running render; call this before other modules unregister."""
    _end()
    remove_handlers(_HANDLERS)
