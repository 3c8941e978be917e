"""What a picture needs of many machines: an interface for all roads, and the road within this process.

A road hands tasks to workers and returns their parts. It retries what gets lost; who judges a part is its caller.
"""

import queue
import threading
from typing import NamedTuple

from ..bindings.abi import LancerError
from . import worker


class Done(NamedTuple):
    """The end of a task. made: a worker.Made, or None with the failure as a sentence."""

    task: object
    made: object = None
    failure: str = ""
    by: tuple = ()


class PoolError(LancerError):
    """The machines cannot go on; the text says what to do."""


class NoAddress(PoolError):
    """The text that names a scheduler is no address."""


class LocalPool:
    """One worker, in a thread of this process.

    All pools have these methods. poll: a function that is called while waiting, and returns True to cancel.
    """

    address = "this machine"

    def __init__(self, threads=0):
        self._threads = threads
        self._tasks = queue.Queue()
        self._done = queue.Queue()
        self._waiting = 0
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()

    def open(self, name, data, poll=None):
        """Bring a scene to the workers: a snapshot as bytes, and their SHA-256 as its name."""
        self._scene = name, lambda: data

    def decide(self, poll=None):
        """Return the worker.Decision of the scene's picture; None if poll cancelled."""
        return worker.decide(*self._scene, self._threads)

    @property
    def workers(self):
        """The number of workers now."""
        return 1

    @property
    def waiting(self):
        """The number of submitted tasks that have not ended."""
        return self._waiting

    @property
    def trouble(self):
        """A sentence about what the pool waits for, for the progress line; "" while all is well."""
        return ""

    def submit(self, task, splits):
        self._waiting += 1
        self._tasks.put((task, splits))

    def ended(self, seconds):
        """Wait at most that long and return a list of Done."""
        found = []
        try:
            found.append(self._done.get(timeout=seconds))
            while True:
                found.append(self._done.get_nowait())
        except queue.Empty:
            pass
        self._waiting -= len(found)
        return found

    def refuse(self, by, why):
        """Report that a part was wrong: its workers are avoided. Raise PoolError if no other worker is left."""
        raise PoolError(f"this machine renders wrong parts: {why}")

    def cancel(self):
        """Forget all tasks that have not ended."""
        while self._waiting:
            try:
                self._tasks.get_nowait()
                self._waiting -= 1
            except queue.Empty:
                self.ended(0.05)

    def close(self):
        self.cancel()
        self._tasks.put(None)
        self._thread.join()

    def _work(self):
        while (item := self._tasks.get()) is not None:
            task, splits = item
            try:
                pieces = [
                    worker.render(*self._scene, splits, task.piece(i), self._threads, self.address) for i in range(task.pieces)
                ]
                self._done.put(Done(task, worker.join(*pieces) if len(pieces) > 1 else pieces[0]))
            except Exception as error:
                self._done.put(Done(task, failure=f"{type(error).__name__}: {error}", by=(self.address,)))
