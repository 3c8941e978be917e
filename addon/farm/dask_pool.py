"""The road over Dask: its scheduler places, moves and repeats the work; this file only asks.

A lost worker's tasks go to others, which is Dask's work; so is a worker that joins. Handled here: tasks that a restarted
scheduler has forgotten, tasks that one slow worker keeps.
"""

import queue
import statistics
import time
import uuid

from . import dask_tasks
from .dask_scheduler import Scheduler
from .pool import Done, PoolError

# Seconds to wait for a scheduler or a first worker.
_PATIENCE = 600.0
# A task is given to a second worker, too, if all are handed out and it takes this many times as long as the others.
_SLOW = 3.0
# Attempts to find a worker that can begin.
_MOST_FAILURES = 4
_STEP = 0.05
# Parts that one join takes.
_FAN = 4
# Parts that are fetched at once: the memory of this process holds them.
_MOST_FETCHED = 32


class _Attempt:
    """One way of a task through the scheduler. futures: all of it, the last one is the result."""

    def __init__(self, task, splits, futures):
        self.task, self.splits, self.futures = task, splits, futures
        self.started = time.monotonic()


class DaskPool:
    """address: of a scheduler, as tcp://host:8786, or a distributed.LocalCluster. Methods: as pool.LocalPool."""

    def __init__(self, address, poll=None, patience=_PATIENCE):
        self.address = address
        self._attempts = {}  # lists of _Attempt by the task's number
        self._arrived = queue.Queue()
        self._times = []  # seconds of tasks
        self._scheduler = Scheduler(address, poll, patience)

    def open(self, name, data, poll=None):
        self._scheduler.send(name, data)

    def decide(self, poll=None):
        failures = []
        while len(failures) < _MOST_FAILURES:
            scheduler = self._scheduler
            future = self._client.submit(dask_tasks.decide, *scheduler.scene, pure=False, workers=scheduler.choice())
            scheduler.prepare()
            while not future.done():
                if poll is not None and poll():
                    return None
                if self._is_lost(poll):
                    break
                # The task waits for a scene that is lost with its workers, until the scene is brought again.
                scheduler.workers()
                time.sleep(_STEP)
            if not future.done() or future.status in ("cancelled", "lost"):
                continue
            try:
                made = scheduler.results([future])[0]
            except Exception as error:
                if self._is_lost(poll):
                    continue
                made = dask_tasks.Failure(f"{type(error).__name__}: {error}", ())
            if not isinstance(made, dask_tasks.Failure):
                return made
            failures.append(f"{', '.join(made.by) or 'a worker'}: {made.text}")
            self.refuse(made.by, made.text)
        raise PoolError(f"{_MOST_FAILURES} workers could not begin; the last one, {failures[-1]}")

    @property
    def workers(self):
        return len(self._scheduler.workers())

    @property
    def trouble(self):
        return self._scheduler.trouble

    @property
    def waiting(self):
        return len(self._attempts)

    def submit(self, task, splits):
        self._attempts.setdefault(task.number, []).append(self._begin(task, splits))

    def ended(self, seconds):
        found, until = [], time.monotonic() + seconds
        while not found and (left := until - time.monotonic()) > 0.0:
            self._is_lost(None)
            # As in decide().
            self._scheduler.workers()
            self._help_slow()
            attempts = self._arrivals(min(left, 0.2))
            results = self._results(attempts)
            for attempt in attempts:
                found += self._end_of(attempt, results)
        return found

    def refuse(self, by, why):
        self._scheduler.refuse(by, why)

    def cancel(self):
        attempts, self._attempts = self._attempts, {}
        self._drop([attempt for several in attempts.values() for attempt in several])

    def close(self):
        self.cancel()
        self._scheduler.close()

    @property
    def dashboard(self):
        """The address of Dask's dashboard."""
        return self._client.dashboard_link

    @property
    def _client(self):
        return self._scheduler.client

    def _begin(self, task, splits, workers=None):
        """Submit the pieces of a task and their joins."""
        key = f"lancer-{task.number}-{uuid.uuid4().hex[:8]}"
        options = {"pure": False, "workers": workers or self._scheduler.choice()}
        name, parcel = self._scheduler.scene
        futures = [
            self._client.submit(
                dask_tasks.render, name, parcel, splits, task.piece(i), key=f"{key}-{i}", priority=-task.number, **options
            )
            for i in range(task.pieces)
        ]
        layer = futures
        while len(layer) > 1:
            joins = [layer[i : i + _FAN] for i in range(0, len(layer), _FAN)]
            layer = [
                self._client.submit(
                    dask_tasks.join, *some, key=f"join-{key}-{len(futures) + i}", priority=-task.number, **options
                )
                if len(some) > 1
                else some[0]
                for i, some in enumerate(joins)
            ]
            futures = futures + [future for future in layer if future not in futures]
        attempt = _Attempt(task, splits, futures)
        layer[0].add_done_callback(lambda _: self._arrived.put(attempt))
        return attempt

    def _arrivals(self, seconds):
        """Return attempts that have ended; wait at most that long for the first one."""
        found = []
        try:
            found.append(self._arrived.get(timeout=seconds))
            while len(found) < _MOST_FETCHED:
                found.append(self._arrived.get_nowait())
        except queue.Empty:
            pass
        return found

    def _results(self, attempts):
        """Return results by key, of many workers at once; those that are missing have to be asked for."""
        futures = [one.futures[-1] for one in attempts if one in self._attempts.get(one.task.number, ())]
        futures = [future for future in futures if future.status == "finished"]
        if len(futures) < 2:
            return {}
        try:
            results = self._scheduler.results(futures)
        except Exception:
            # One of them fails: each is asked for its own failure.
            return {}
        return {future.key: made for future, made in zip(futures, results, strict=True)}

    def _end_of(self, attempt, results):
        """Return the Dones of an attempt that has ended: none if its task has ended before, or if it begins again."""
        task = attempt.task
        others = self._attempts.get(task.number, [])
        if attempt not in others:
            return []
        future = attempt.futures[-1]
        try:
            made = results[future.key] if future.key in results else self._scheduler.results([future])[0]
        except Exception as error:
            made = None
            if future.status in ("cancelled", "lost") or isinstance(error, (OSError, TimeoutError)):
                # The scheduler has forgotten it: begin again.
                if not self._is_lost(None):
                    others.remove(attempt)
                    if not others:
                        others.append(self._begin(task, attempt.splits))
                return []
            failure = Done(task, None, f"{type(error).__name__}: {error}")
        if isinstance(made, dask_tasks.Failure):
            failure = Done(task, None, made.text, made.by)
            made = None
        self._attempts.pop(task.number)
        self._drop([other for other in others if other is not attempt])
        if made is None:
            return [failure]
        self._times.append(time.monotonic() - attempt.started)
        return [Done(task, made)]

    def _drop(self, attempts):
        futures = [future for attempt in attempts for future in attempt.futures]
        if futures and self._scheduler.is_running:
            self._client.cancel(futures)

    def _help_slow(self):
        """Give the longest task to a second worker, too, while workers have nothing to do."""
        if len(self._times) < 3 or len(self._attempts) >= self.workers:
            return
        usual = statistics.median(self._times[-50:])
        now = time.monotonic()
        for several in list(self._attempts.values()):
            if len(several) == 1 and now - several[0].started > _SLOW * usual:
                attempt = several[0]
                busy = {address for where in self._client.who_has(attempt.futures).values() for address in where}
                busy |= self._processing(attempt)
                free = [address for address in self._scheduler.workers() if address not in busy]
                if free:
                    several.append(self._begin(attempt.task, attempt.splits, free))

    def _processing(self, attempt):
        keys = {future.key for future in attempt.futures}
        return {address for address, tasks in self._client.processing().items() if keys & set(tasks)}

    def _is_lost(self, poll):
        """Whether the scheduler was lost; connects to the new one, and hands all tasks out again."""
        if self._scheduler.is_running:
            return False
        self._scheduler.reconnect(poll)
        for number, several in list(self._attempts.items()):
            self._attempts[number] = [self._begin(several[0].task, several[0].splits)]
        return True
