"""What only Blender's main thread may do, done there for the thread that renders.

In a window Blender renders in a thread of its own while the main one draws and obeys the user; to make and to remove data is
safe in the main one only. In the background, and where a script waits for the render, both are one.

Only the main thread may begin a timer, and F12 calls no Python there: so a slow one waits as long as Lancer is the engine of a
scene, and is quick in a render.
"""

import contextlib
import contextvars
import queue
import threading
from concurrent import futures

import bpy
from bpy.app.handlers import persistent

ENGINE = "LANCER"

_QUICK, _SLOW = 0.01, 0.1  # seconds between the main thread's looks: in a render, and before
_PATIENCE = 0.05  # between two looks whether the user still waits

_asked = queue.SimpleQueue()
_obey = contextvars.ContextVar("obey", default=None)
_serving = False
_owner = object()  # of what is heard of changes of the engine


@contextlib.contextmanager
def obeying(obey):
    """Within it, long work calls obey() again and again, which raises Cancelled when the user has enough; None never does."""
    token = _obey.set(obey)
    try:
        look()
        yield
    finally:
        _obey.reset(token)


def look():
    """Raises Cancelled when the user has enough."""
    obey = _obey.get()
    if obey is not None:
        obey()


def run(work):
    """What work() gives, done by the main thread."""
    if _is_here():
        return work()
    future = _ask(work)
    while not futures.wait((future,), _PATIENCE).done:
        try:
            look()
        except BaseException:
            if future.cancel():
                raise
            # It is being done right now, and its giver wants to know what came of it.
            break
    return future.result()


def post(work):
    """Has work() done by the main thread some time; nobody waits."""
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
    """Does what is asked for; for the main thread alone."""
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
    """The file's scenes may have changed, or the engine of one."""
    global _serving
    if not _serving:
        _serving = True
        bpy.app.timers.register(_tick, persistent=True)


@persistent
def _loaded(*_):
    # Loading ends all subscriptions.
    _subscribe()
    _look()


def _subscribe():
    for key in ((bpy.types.RenderSettings, "engine"), (bpy.types.Window, "scene")):
        bpy.msgbus.subscribe_rna(key=key, owner=_owner, args=(), notify=_look)


_HANDLERS = (("load_post", _loaded), ("undo_post", _look), ("redo_post", _look))


def register():
    # Timers never come in the background.
    if not bpy.app.background:
        for name, handler in _HANDLERS:
            getattr(bpy.app.handlers, name).append(handler)
        _loaded()


def unregister():
    global _serving
    if bpy.app.background:
        return
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    bpy.msgbus.clear_by_owner(_owner)
    _serving = False
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    serve()
