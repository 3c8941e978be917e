"""A scheduler of Dask as the client of a still knows it: waited for, connected again after its restart, and given the scene."""

import time
import uuid

from distributed import Client, Variable

from . import dask_tasks
from .pool import NoAddress, PoolError

# Seconds between attempts to connect, and between looks at the list of workers.
_PAUSE = 0.5
_FRESH = 1.0
# Workers that fetch the scene from one that got it from the client.
_RECEIVERS = 16
# Wrong parts after which a worker gets no more tasks.
_MOST_STRIKES = 2


class Scheduler:
    """address: as tcp://host:8786, or a distributed.LocalCluster; patience: seconds to wait for it and for a first worker.

    client: the distributed.Client; trouble: a sentence about what is waited for, or "".
    """

    def __init__(self, address, poll, patience):
        self.address, self.trouble, self.client = address, "", None
        self._patience = patience
        self._scene = None
        self._parcels = []  # variables, each of which keeps a copy of the scene's bytes with a worker
        self._bytes = None  # the future of the first copy
        self._strikes = {}
        self._addresses, self._looked = (), 0.0
        self._prepared, self._preparing = set(), []
        self._connect(poll)

    @property
    def is_running(self):
        return self.client.status == "running"

    def reconnect(self, poll):
        """Connect to the scheduler that comes after a lost one, and send it the scene."""
        self._bytes = None
        self.client.close(timeout=1)
        self._connect(poll)
        self.send(*self._scene)

    def send(self, name, data):
        """Bring the scene's bytes to some workers, from which the others fetch them: one alone would be slow, or be lost."""
        self._scene = name, data
        try:
            future = self.client.scatter(data, hash=False, direct=True)
        except (OSError, TimeoutError):
            # Workers behind the scheduler, which this machine cannot reach: all data go through it.
            self.client.direct_to_workers = False
            future = self.client.scatter(data, hash=False, direct=False)
        self._bytes, self._parcels = future, []
        self._keep(future)
        self._looked = 0.0
        self._prepared, self._preparing = set(), []

    @property
    def scene(self):
        """The first two arguments of tasks that need the scene."""
        return self._scene[0], dask_tasks.Parcel(parcel.name for parcel in self._parcels)

    def prepare(self):
        """Let workers that are new read the scene before they get a task."""
        for address in self.workers():
            if address not in self._prepared:
                self._prepared.add(address)
                # Dask forgets a task whose future nobody keeps.
                self._preparing.append(self.client.submit(dask_tasks.prepare, *self.scene, workers=[address], pure=False))

    def workers(self):
        """Return the addresses of workers that get tasks."""
        if time.monotonic() - self._looked > _FRESH:
            try:
                self._addresses = tuple(self.client.nthreads())
                self._copy_scene()
            except (OSError, TimeoutError):
                return self._addresses
            self._looked = time.monotonic()
        return [address for address in self._addresses if self._strikes.get(address, 0) < _MOST_STRIKES]

    def _copy_scene(self):
        """Copy the scene's bytes to further workers, when more workers have come."""
        count = len(self._addresses)
        while self._bytes is not None and len(self._parcels) < min(count, 2 + count // _RECEIVERS):
            place = {"workers": [self._addresses[-len(self._parcels)]], "allow_other_workers": True}
            self._keep(self.client.submit(dask_tasks.copy, self._bytes, pure=False, **place))

    def _keep(self, future):
        self._parcels.append(Variable(f"lancer-{uuid.uuid4().hex}", client=self.client))
        self._parcels[-1].set(future)

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
        for parcel in self._parcels if self.is_running else ():
            parcel.delete()
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
