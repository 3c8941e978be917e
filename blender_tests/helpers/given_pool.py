"""A pool of workers within the test's process: it renders rightly, and a test decides what comes back, and when."""

import itertools
import weakref
from collections import Counter

from addon.farm import worker
from addon.farm.pool import Done

# Looks at the pool without anything that comes or goes, after which a picture would wait for ever.
_PATIENCE = 5000


class GivenPool:
    """Methods: as addon.farm.pool.LocalPool. Parts are rendered when their task is submitted: all of them are in memory.

    workers: number; change it at any time. render(task, made, attempt): returns what comes back for a task, by default made;
    a text is a failure. deliver(waiting): takes the Dones that come now out of a list, by default all. speed: pixel samples per
    second of a worker, as parts tell it.
    """

    address = "the test"
    trouble = ""

    def __init__(self, workers=2, render=None, deliver=None, speed=100.0):
        self._idle = 0
        self.workers = workers
        self.render = render or (lambda task, made, attempt: made)
        self.deliver = deliver or (lambda waiting: [waiting.pop(0) for _ in list(waiting)])
        self.speed = speed
        self.submitted = Counter()  # attempts by the task's number
        self.tasks = {}
        self.refusals = []  # (by, why)
        self.bytes = 0
        self.alive = self.most_alive = self.most_waiting = 0
        self.parts, self._open = [], set()
        self._names = itertools.cycle(range(97))

    def open(self, name, data, poll=None):
        self.scene = name, lambda: data

    def decide(self, poll=None):
        return None if poll is not None and poll() else worker.decide(*self.scene, threads=1)

    @property
    def workers(self):
        self._idle += 1
        assert self._idle < _PATIENCE, "the session waits for parts that never come"
        return self._workers

    @workers.setter
    def workers(self, number):
        self._workers = number

    @property
    def waiting(self):
        return len(self._open)

    def submit(self, task, splits):
        assert task.number not in self._open, "a task is on its way twice"
        self._idle = 0
        self.submitted[task.number] += 1
        self.tasks[task.number] = task
        self._open.add(task.number)
        self.most_waiting = max(self.most_waiting, len(self._open))
        names = [f"worker {next(self._names) % max(1, self._workers)}" for _ in range(task.pieces)]
        pieces = [worker.render(*self.scene, splits, task.piece(i), 1, name) for i, name in enumerate(names)]
        made = worker.join(*pieces) if len(pieces) > 1 else pieces[0]
        made = self.render(task, made._replace(seconds=task.samples / self.speed), self.submitted[task.number])
        if isinstance(made, str):
            self.parts.append(Done(task, failure=made, by=(names[0],)))
            return
        self._count(made.part)
        self.parts.append(Done(task, made))

    def _count(self, part):
        self.alive += 1
        self.most_alive = max(self.most_alive, self.alive)
        self.bytes += part.nbytes
        weakref.finalize(part, self._forget)

    def _forget(self):
        self.alive -= 1

    def ended(self, seconds):
        found = self.deliver(self.parts)
        self._idle = 0 if found else self._idle
        self._open -= {done.task.number for done in found}
        return found

    def refuse(self, by, why):
        self.refusals.append((by, why))

    def cancel(self):
        self.parts.clear()
        self._open.clear()

    def close(self):
        self.cancel()
