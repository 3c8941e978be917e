"""What only Blender's main thread may do, done there for the thread that renders.

In a window Blender renders in a thread of its own while the main one draws and obeys the user; to make and to remove data is
safe in the main one only. In the background, and where a script waits for the render, both are one.
"""

import contextlib
import contextvars
import queue
import threading
from concurrent import futures

import bpy

_INTERVAL = 0.01  # of the main thread's looks
_PATIENCE = 0.05  # between two looks whether the user still waits

_asked = queue.SimpleQueue()
_obey = contextvars.ContextVar("obey", default=None)
_serving = False


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


def _serve():
    with contextlib.suppress(queue.Empty):
        while True:
            future, work = _asked.get_nowait()
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(work())
                except BaseException as error:
                    future.set_exception(error)
    return _INTERVAL


def register():
    global _serving
    # Timers never come in the background.
    if not bpy.app.background:
        bpy.app.timers.register(_serve, persistent=True)
        _serving = True


def unregister():
    global _serving
    if _serving:
        _serving = False
        bpy.app.timers.unregister(_serve)
        _serve()
