"""A scheduler of Dask as the client of a still knows it: waited for, connected again after its restart, and given the scene."""

import asyncio
import concurrent.futures
import time
import uuid

from distributed import Client, Variable

from . import dask_tasks
from .pool import NoAddress, PoolError

# Seconds between attempts to connect, and between looks at the list of workers.
_PAUSE = 0.5
_FRESH = 1.0
# Seconds between looks while results come.
_STEP = 0.05
# Workers for each copy of the scene.
_RECEIVERS = 16
# Statuses of a future whose result is gone.
_LOST = ("cancelled", "lost", "error")
# Wrong parts after which a worker gets no more tasks.
_MOST_STRIKES = 2


def gathered(client, futures, look):
    """Return the results of futures. Until they are here, call look() many times a second; it may raise to give up."""
    fetching = asyncio.run_coroutine_threadsafe(client.gather(futures, asynchronous=True), client.loop.asyncio_loop)
    try:
        while not concurrent.futures.wait([fetching], _STEP).done:
            look()
    finally:
        fetching.cancel()
    return fetching.result()


class _Copy:
    """A scene's bytes on a worker, announced to all workers by a variable, under whose name a lost copy is replaced."""

    def __init__(self, client):
        self.variable = Variable(f"lancer-{uuid.uuid4().hex}", client=client)
        self.address = self.future = None

    def set(self, address, future):
        self.address, self.future = address, future
        self.variable.set(future)

    @property
    def is_lost(self):
        return self.future is None or self.future.status in _LOST

    @property
    def is_there(self):
        return self.future is not None and self.future.status == "finished"


class Scheduler:
    """address: as tcp://host:8786, or a distributed.LocalCluster; patience: seconds to wait for it and for a first worker.

    client: the distributed.Client; trouble: a sentence about what is waited for, or "".
    """

    def __init__(self, address, poll, patience):
        self.address, self.trouble, self.client = address, "", None
        self._patience = patience
        self._scene = None
        self._copies = []  # of the scene's bytes
        self._strikes = {}
        self._addresses, self._looked = (), 0.0
        self._prepared, self._preparing = set(), []
        self._connect(poll)

    @property
    def is_running(self):
        return self.client.status == "running"

    def reconnect(self, poll):
        """Connect to the scheduler that comes after a lost one, and send it the scene."""
        self._copies = []
        self.client.close(timeout=1)
        self._connect(poll)
        self.send(*self._scene)

    def send(self, name, data):
        """Bring the scene's bytes to some workers, from which the others fetch them: one alone would be slow, or be lost."""
        self._scene = name, data
        self._prepared, self._preparing = set(), []
        self._copies = [_Copy(self.client)]
        self._addresses = tuple(self.client.nthreads())
        self._copy_scene()

    @property
    def scene(self):
        """The first two arguments of tasks that need the scene."""
        return self._scene[0], self._parcel

    def prepare(self):
        """Let workers that are new read the scene before they get a task."""
        for address in self.workers():
            if address not in self._prepared:
                self._prepared.add(address)
                # Dask forgets a task whose future nobody keeps.
                self._preparing.append(self.client.submit(dask_tasks.prepare, *self.scene, workers=[address], pure=False))

    def results(self, futures):
        """Return the results of futures. One that is lost with its worker is made anew, which may need the scene again."""

        def look():
            if not self.is_running:
                raise ConnectionError("the scheduler is lost")
            self.workers()

        return gathered(self.client, futures, look)

    def workers(self):
        """Return the addresses of workers that get tasks, and see to it that the scene is with some of them."""
        if time.monotonic() - self._looked > _FRESH:
            try:
                self._addresses = tuple(self.client.nthreads())
                self._copy_scene()
            except (OSError, TimeoutError):
                return self._addresses
            self._looked = time.monotonic()
        return [address for address in self._addresses if self._strikes.get(address, 0) < _MOST_STRIKES]

    @property
    def _parcel(self):
        return dask_tasks.Parcel([copy.variable.name for copy in self._copies])

    def _copy_scene(self):
        """Replace copies that were lost with their workers, and add some when more workers have come."""
        if not self._copies or not self._addresses:
            return
        lost = [copy for copy in self._copies if copy.is_lost]
        # A copy that is still being made waits for another one that is there.
        if not any(copy.is_there for copy in self._copies):
            self._send_bytes(lost.pop() if lost else self._copies[0])
        there = [copy for copy in self._copies if copy.is_there]
        used = {copy.address for copy in self._copies if not copy.is_lost}
        # A worker that is new may be waiting for a copy, and could not make it meanwhile.
        free = [address for address in self._addresses if address not in used]
        free.sort(key=lambda address: address not in self._prepared)
        # A copy that is replaced comes from one that is there, so that no two copies wait for each other.
        for copy, address in zip([copy for copy in lost if copy.is_lost], free, strict=False):
            self._make(copy, address, there)
            free = free[1:]
        count = len(self._addresses)
        for address in free[: max(0, min(count, 2 + count // _RECEIVERS) - len(self._copies))]:
            self._copies.append(_Copy(self.client))
            self._make(self._copies[-1], address, self._copies, len(self._copies) - 1)

    def _make(self, copy, address, sources, number=None):
        """Let a worker make a copy from one of the sources; number: of a new copy among them."""
        parcel = dask_tasks.Parcel([one.variable.name for one in sources], number)
        copy.set(address, self.client.submit(dask_tasks.copy, parcel, workers=[address], allow_other_workers=True, pure=False))

    def _send_bytes(self, copy):
        """Bring the scene's bytes from this machine to a worker."""
        address = self._addresses[0]
        options = {"workers": [address], "hash": False}
        try:
            future = self.client.scatter(self._scene[1], direct=True, **options)
        except (OSError, TimeoutError):
            # Workers behind the scheduler, which this machine cannot reach: all data go through it.
            self.client.direct_to_workers = False
            future = self.client.scatter(self._scene[1], direct=False, **options)
        copy.set(address, future)

    def choice(self):
        """Return the workers among which Dask chooses; None: all."""
        allowed = self.workers()
        return allowed if len(allowed) < len(self._addresses) else None

    def refuse(self, by, why):
        """Note that workers have failed. Raise PoolError if no other one is left."""
        for address in by:
            self._strikes[address] = self._strikes.get(address, 0) + 1
        self._looked = 0.0
        if self.client.nthreads() and not self.workers():
            raise PoolError(f"all workers fail, the last one because {why}")

    def close(self):
        self._preparing = []
        for copy in self._copies if self.is_running else ():
            copy.variable.delete()
        self.client.close()

    def _connect(self, poll):
        """Connect to the scheduler; wait for one that is not there."""
        until = time.monotonic() + self._patience
        while True:
            try:
                self.client = Client(self.address, timeout=5, direct_to_workers=True, set_as_default=False, name="lancer")
                break
            except (OSError, TimeoutError) as error:
                self.trouble = f"waiting for the scheduler {self.address}"
                if time.monotonic() > until or poll is not None and poll():
                    raise PoolError(f"there is no scheduler at {self.address}: {error}") from error
                time.sleep(_PAUSE)
            except ValueError as error:
                raise NoAddress(f"{self.address} is no address of a scheduler: {error}") from error
            except TypeError as error:
                # Certificates are missing from Dask's configuration.
                raise PoolError(f"the scheduler at {self.address} cannot be spoken to: {error}") from error
        while not self.client.nthreads():
            self.trouble = "waiting for workers"
            if time.monotonic() > until or poll is not None and poll():
                raise PoolError(f"the scheduler at {self.address} has no workers")
            time.sleep(_PAUSE)
        self.trouble = ""
        self._looked = 0.0
