"""The tasks of a picture as Dask's workers run them."""

import os
import random

from distributed import Variable, get_client, get_worker, wait

from . import worker

# Seconds that a worker waits for the bytes of a scene to be announced.
_PATIENCE = 60
# Copies of a scene of which a worker takes the first that is there.
_CHOICES = 3


class Parcel:
    """The names of Variables of the scheduler, each of which holds a copy of a snapshot's bytes.

    Dask would send the bytes anew with tasks that depend on them: a worker that lacks the scene fetches them once, from any of
    the workers that keep a copy.
    """

    def __init__(self, names):
        self.names = tuple(names)

    def __call__(self):
        names = random.sample(self.names, min(_CHOICES, len(self.names)))
        copies = [Variable(name, client=get_client()).get(timeout=_PATIENCE) for name in names]
        # Some copies may be lost with their workers, or not be made yet.
        there = wait(copies, timeout=_PATIENCE, return_when="FIRST_COMPLETED").done
        return next(copy for copy in copies if copy in there).result()


def _threads():
    """Return the threads of a session, which has the whole worker."""
    return int(os.environ.get("LANCER_THREADS", 0)) or get_worker().state.nthreads


def _told(work, *arguments):
    """Return the result of work, or its failure with this worker's address: a raised exception would not tell who failed."""
    try:
        return work(*arguments)
    except worker.WrongPart as error:
        return Failure(str(error), error.by)
    except Exception as error:
        return Failure(f"{type(error).__name__}: {error}", (get_worker().address,))


class Failure:
    """A task that could not be done."""

    def __init__(self, text, by):
        self.text, self.by = text, by


def copy(data):
    """Return a copy of a scene's bytes, which this worker keeps: Dask forgets plain replicas within seconds."""
    return data.copy()


def decide(name, parcel):
    return _told(worker.decide, name, parcel, _threads())


def prepare(name, parcel):
    return _told(worker.prepare, name, parcel, _threads())


def render(name, parcel, splits, ranges):
    return _told(worker.render, name, parcel, splits, ranges, _threads(), get_worker().address)


def join(*made):
    failed = [one for one in made if isinstance(one, Failure)]
    return failed[0] if failed else _told(worker.join, *made)
