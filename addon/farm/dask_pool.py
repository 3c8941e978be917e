"""The road over Dask: its scheduler places, moves and repeats the work; this file only asks.

A lost worker's tasks go to others, which is Dask's work; so is a worker that joins. Handled here: a scheduler that was
restarted, tasks that one slow worker keeps, workers that send rubbish.
"""

import queue
import statistics
import time
import uuid

from distributed import Client, Variable

from . import dask_tasks
from .pool import Done, NoAddress, PoolError

# Seconds to wait for a scheduler or a first worker.
_PATIENCE = 600.0
# Seconds between attempts to connect, and between looks at the list of workers.
_PAUSE = 0.5
_FRESH = 1.0
# Wrong parts after which a worker gets no more tasks.
_MOST_STRIKES = 2
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
        self.trouble = ""
        self._patience = patience
        self._client = None
        self._scene = None
        self._parcel = None  # the variable that keeps the scene's bytes with the workers
        self._attempts = {}  # lists of _Attempt by the task's number
        self._arrived = queue.Queue()
        self._strikes = {}
        self._times = []  # seconds of tasks
        self._addresses, self._looked = (), 0.0
        self._prepared, self._preparing = set(), []
        self._connect(poll)

    def open(self, name, data, poll=None):
        self._scene = name, data
        self._send(poll)

    def decide(self, poll=None):
        failures = []
        while len(failures) < _MOST_FAILURES:
            workers = self._allowed() if self._strikes else None
            future = self._client.submit(dask_tasks.decide, self._scene[0], self._parcel_of(), pure=False, workers=workers)
            self._prepare()
            while not future.done():
                if poll is not None and poll():
                    return None
                if self._is_lost(poll):
                    break
                time.sleep(_STEP)
            if not future.done() or future.status in ("cancelled", "lost"):
                continue
            try:
                made = future.result()
            except Exception as error:
                made = dask_tasks.Failure(f"{type(error).__name__}: {error}", ())
            if not isinstance(made, dask_tasks.Failure):
                return made
            failures.append(f"{', '.join(made.by) or 'a worker'}: {made.text}")
            self.refuse(made.by, made.text)
        raise PoolError(f"{_MOST_FAILURES} workers could not begin; the last one, {failures[-1]}")

    @property
    def workers(self):
        return len(self._allowed())

    @property
    def waiting(self):
        return len(self._attempts)

    def submit(self, task, splits):
        self._attempts.setdefault(task.number, []).append(self._begin(task, splits))

    def ended(self, seconds):
        found, until = [], time.monotonic() + seconds
        while not found and (left := until - time.monotonic()) > 0.0:
            self._is_lost(None)
            self._help_slow()
            attempts = self._arrivals(min(left, 0.2))
            results = self._results(attempts)
            for attempt in attempts:
                found += self._end_of(attempt, results)
        return found

    def refuse(self, by, why):
        for address in by:
            self._strikes[address] = self._strikes.get(address, 0) + 1
        self._looked = 0.0
        if self._client.nthreads() and not self._allowed():
            raise PoolError(f"all workers fail, the last one because {why}")

    def cancel(self):
        attempts, self._attempts = self._attempts, {}
        self._drop([attempt for several in attempts.values() for attempt in several])

    def close(self):
        self.cancel()
        self._preparing = []
        if self._parcel is not None and self._client.status == "running":
            self._parcel.delete()
        self._client.close()

    @property
    def dashboard(self):
        """The address of Dask's dashboard."""
        return self._client.dashboard_link

    def _connect(self, poll):
        """Connect to the scheduler; wait for one that is not there."""
        until = time.monotonic() + self._patience
        while True:
            try:
                self._client = Client(self.address, timeout=5, direct_to_workers=True, set_as_default=False, name="lancer")
                break
            except (OSError, TimeoutError) as error:
                self.trouble = f"waiting for the scheduler {self.address}"
                if time.monotonic() > until or poll is not None and poll():
                    raise PoolError(f"there is no scheduler at {self.address}: {error}") from error
                time.sleep(_PAUSE)
            except ValueError as error:
                raise NoAddress(f"{self.address} is no address of a scheduler: {error}") from error
        while not self._client.nthreads():
            self.trouble = "waiting for workers"
            if time.monotonic() > until or poll is not None and poll():
                raise PoolError(f"the scheduler at {self.address} has no workers")
            time.sleep(_PAUSE)
        self.trouble = ""
        self._looked = 0.0

    def _send(self, poll):
        """Bring the scene's bytes to one worker; the others fetch them from each other."""
        name, data = self._scene
        self._parcel = Variable(f"lancer-{uuid.uuid4().hex}", client=self._client)
        try:
            future = self._client.scatter(data, hash=False, direct=True)
        except (OSError, TimeoutError):
            # Workers behind the scheduler, which this machine cannot reach: all data go through it.
            self._client.direct_to_workers = False
            future = self._client.scatter(data, hash=False, direct=False)
        self._parcel.set(future)
        self._prepared, self._preparing = set(), []

    def _parcel_of(self):
        return dask_tasks.Parcel(self._parcel.name)

    def _prepare(self):
        """Let workers that are new read the scene before they get a task."""
        for address in self._allowed():
            if address not in self._prepared:
                self._prepared.add(address)
                # Dask forgets a task whose future nobody keeps.
                self._preparing.append(
                    self._client.submit(dask_tasks.prepare, self._scene[0], self._parcel_of(), workers=[address], pure=False)
                )

    def _allowed(self):
        """Return the addresses of workers that get tasks."""
        if time.monotonic() - self._looked > _FRESH:
            try:
                self._addresses = tuple(self._client.nthreads())
            except (OSError, TimeoutError):
                return self._addresses
            self._looked = time.monotonic()
        return [address for address in self._addresses if self._strikes.get(address, 0) < _MOST_STRIKES]

    def _begin(self, task, splits, workers=None):
        """Submit the pieces of a task and their joins."""
        if workers is None and len(self._allowed()) < len(self._addresses):
            workers = self._allowed()
        key = f"lancer-{task.number}-{uuid.uuid4().hex[:8]}"
        options = {"pure": False, "workers": workers}
        name, parcel = self._scene[0], self._parcel_of()
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
            results = self._client.gather(futures)
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
            made = results[future.key] if future.key in results else future.result()
        except Exception as error:
            made = None
            if future.status in ("cancelled", "lost") or isinstance(error, (OSError, TimeoutError)):
                # The scheduler has forgotten it: begin again.
                others.remove(attempt)
                if not self._is_lost(None) and not others:
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
        if futures and self._client.status == "running":
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
                free = [address for address in self._allowed() if address not in busy]
                if free:
                    several.append(self._begin(attempt.task, attempt.splits, free))

    def _processing(self, attempt):
        keys = {future.key for future in attempt.futures}
        return {address for address, tasks in self._client.processing().items() if keys & set(tasks)}

    def _is_lost(self, poll):
        """Whether the scheduler was lost; connects to the new one, and hands all tasks out again."""
        if self._client.status == "running":
            return False
        self._client.close(timeout=1)
        self._connect(poll)
        self._send(poll)
        for number, several in list(self._attempts.items()):
            self._attempts[number] = [self._begin(several[0].task, several[0].splits)] if several else []
        return True
