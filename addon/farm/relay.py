"""The process between Blender and a scheduler: it reads commands from standard input and writes results to standard output."""

import contextlib
import os
import queue
import sys
import threading
import time

from . import pipe
from .dask_pool import DaskPool
from .dask_worker import local_cluster
from .pool import PoolError

# Seconds between looks at the streams and the pool, and between reports of its state.
_STEP = 0.05
_TELL_EVERY = 0.5


def relay(address):
    """Serve until the standard input ends. address: as in the add-on's panel."""
    # Whatever a library prints must not get into the messages.
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    commands = queue.Queue()
    threading.Thread(target=_read, args=(sys.stdin.buffer, commands), daemon=True).start()
    pool = None
    try:
        with _cluster_of(address) as place:
            pool = DaskPool(place, lambda: _is_over(commands))
            _serve(pool, commands, out)
    except PoolError as error:
        pipe.write(out, {"is": "failed", "text": str(error)})
    finally:
        if pool is not None:
            pool.close()


def _cluster_of(address):
    """Return a context of what DaskPool connects to."""
    return local_cluster() if address == "local" else contextlib.nullcontext(address)


def _read(stream, commands):
    while (item := pipe.read(stream)) is not None:
        commands.put(item)
    commands.put(None)


def _is_over(commands):
    """Whether the input has ended, which is the last command."""
    return bool(commands.queue) and commands.queue[-1] is None


def _serve(pool, commands, out):
    told, tasks = 0.0, {}
    while True:
        if time.monotonic() - told > _TELL_EVERY:
            told = time.monotonic()
            state = {"workers": pool.workers, "trouble": pool.trouble, "dashboard": pool.dashboard}
            pipe.write(out, {"is": "state", **state})
        # Obey all commands that are there before the next part is waited for.
        try:
            item = commands.get_nowait() if pool.waiting else commands.get(timeout=_STEP)
        except queue.Empty:
            for done in pool.ended(_STEP) if pool.waiting else ():
                _write_done(out, done)
            continue
        if item is None:
            return
        message, data = item
        do = message["do"]
        if do == "open":
            pool.open(message["name"], data, lambda: _is_over(commands))
        elif do == "decide":
            decision = pool.decide(lambda: _is_over(commands))
            if decision is None:
                return
            pipe.write(out, {"is": "decided", **decision._asdict()})
        elif do == "submit":
            task, splits = pipe.task_of(message, data)
            tasks[task.number] = task
            pool.submit(task, splits)
        elif do == "refuse":
            pool.refuse(message["by"], message["why"])
        elif do == "cancel":
            pool.cancel()
            pipe.write(out, {"is": "cancelled"})


def _write_done(out, done):
    message = {"is": "ended", "number": done.task.number, "failure": done.failure, "by": list(done.by)}
    if done.made is None:
        pipe.write(out, message)
        return
    made = done.made
    message |= {"seconds": made.seconds, "made_by": list(made.by), "instruction_set": made.instruction_set}
    pipe.write(out, message, made.part)
