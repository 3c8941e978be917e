"""Work that only Blender's main thread may do, run there for the render thread.

In a window Blender renders in a separate thread while the main thread draws and handles input; only the main thread may create
and remove data. In background mode, and when a script waits for the render, there is only the main thread.

Only the main thread may start a timer, and F12 calls no Python there. So a timer runs as long as Lancer is the engine of any
scene, slowly before a render and fast during one.
"""

import contextlib
import contextvars
import queue
import threading
from concurrent import futures

import bpy
from bpy.app.handlers import persistent

from .registering import add_handlers, remove_handlers

ENGINE = "LANCER"

_QUICK, _SLOW = 0.01, 0.1  # seconds between calls of the timer: during a render, and otherwise
_PATIENCE = 0.05  # seconds between checks whether the user has cancelled

_asked = queue.SimpleQueue()
_obey = contextvars.ContextVar("obey", default=None)
_serving = False
_owner = object()  # of the message bus subscriptions to changes of the engine


@contextlib.contextmanager
def obeying(obey):
    """Context in which long work calls obey() repeatedly; obey raises Cancelled if the user cancels. None: never."""
    token = _obey.set(obey)
    try:
        look()
        yield
    finally:
        _obey.reset(token)


def look():
    """Raise Cancelled if the user has cancelled."""
    obey = _obey.get()
    if obey is not None:
        obey()


def run(work):
    """Run work() in the main thread and return its result; raise its exception, or Cancelled before it has started."""
    if _is_here():
        return work()
    future = _ask(work)
    while not futures.wait((future,), _PATIENCE).done:
        try:
            look()
        except BaseException:
            if future.cancel():
                raise
            # The work is already running: wait for its result.
            break
    return future.result()


def post(work):
    """Run work() in the main thread later, without waiting for it."""
    if _is_here():
        work()
    else:
        _ask(work)


def _is_here():
    return not _serving or threading.current_thread() is threading.main_thread()


def _ask(work):
    future = futures.Future()
    _asked.put((future, work))
    return future


def serve():
    """Run all posted work. Call it from the main thread only."""
    with contextlib.suppress(queue.Empty):
        while True:
            future, work = _asked.get_nowait()
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(work())
                except BaseException as error:
                    future.set_exception(error)


def _tick():
    global _serving
    serve()
    rendering = bpy.app.is_job_running("RENDER")
    _serving = rendering or any(scene.render.engine == ENGINE for scene in bpy.data.scenes)
    if not _serving:
        return None
    return _QUICK if rendering else _SLOW


@persistent
def _look(*_):
    """Start the timer after a possible change of the scenes or of a scene's engine; _tick ends it if Lancer is not used."""
    global _serving
    if not _serving:
        _serving = True
        bpy.app.timers.register(_tick, persistent=True)


@persistent
def _loaded(*_):
    # Loading a file ends all subscriptions.
    _subscribe()
    _look()


def _subscribe():
    for key in ((bpy.types.RenderSettings, "engine"), (bpy.types.Window, "scene")):
        bpy.msgbus.subscribe_rna(key=key, owner=_owner, args=(), notify=_look)


_HANDLERS = (("load_post", _loaded), ("undo_post", _look), ("redo_post", _look))


def register():
    # Timers never run in background mode.
    if not bpy.app.background:
        add_handlers(_HANDLERS)
        _loaded()


def unregister():
    global _serving
    if bpy.app.background:
        return
    remove_handlers(_HANDLERS)
    bpy.msgbus.clear_by_owner(_owner)
    _serving = False
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    serve()
