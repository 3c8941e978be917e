"""The tasks of a picture as Dask's workers run them."""

import contextlib
import os
import random
import time
from asyncio import CancelledError

from distributed import Variable, get_client, get_worker

from ..bindings.abi import LancerError
from . import worker

# Seconds that a worker waits for a lost scene, and for one that is on its way; seconds between two looks.
_PATIENCE, _LONGEST, _STEP = 60.0, 600.0, 0.2
# Seconds after which a worker looks for another copy: its own thread may be needed for the one that it waits for.
_LOYALTY = 20.0


class Parcel:
    """The names of Variables of the scheduler, each of which holds a copy of a snapshot's bytes.

    Dask would send the bytes anew with tasks that depend on them: a worker that lacks the scene fetches them once, from a
    worker that keeps a copy. number: that of a copy to be made among the names, which are a binary tree; None for a reader. A
    reader takes a leaf, so that the network is left to copies that others wait for.
    """

    def __init__(self, names, number=None):
        self.names, self.number = tuple(names), number

    def choose(self, chance=random):
        """Return the name of the copy that serves best. chance: the module random, or a random.Random."""
        if self.number:
            return self.names[(self.number - 1) // 2]
        return chance.choice(self.names[len(self.names) // 2 :])

    def __call__(self):
        name, begun = self.choose(), time.monotonic()
        hopeful = chosen = begun  # when a copy was last on its way, and when this one was chosen
        while (now := time.monotonic()) - hopeful < _PATIENCE and now - begun < _LONGEST:
            copy = Variable(name, client=get_client()).get(timeout=_PATIENCE)
            if copy.status == "finished":
                with contextlib.suppress(Exception, CancelledError):
                    return copy.result()
            if copy.status == "pending":
                hopeful = now
            # The client replaces a copy that is lost with its worker under its name.
            if copy.status != "pending" or now - chosen >= _LOYALTY:
                name, chosen = random.choice(self.names), now
            time.sleep(_STEP)
        raise LostScene("the scene is lost with the workers that had it")


class LostScene(LancerError):
    """No worker has the bytes of a scene any more."""


def _threads():
    """Return the threads of a session, which has the whole worker."""
    return int(os.environ.get("LANCER_THREADS", 0)) or get_worker().state.nthreads


def _told(work, *arguments):
    """Return the result of work, or its failure with this worker's address: a raised exception would not tell who failed."""
    try:
        return work(*arguments)
    except worker.WrongPart as error:
        return Failure(str(error), error.by)
    except LostScene as error:
        # The client brings it again; this worker is not to blame.
        return Failure(str(error), ())
    except Exception as error:
        return Failure(f"{type(error).__name__}: {error}", (get_worker().address,))


class Failure:
    """A task that could not be done."""

    def __init__(self, text, by):
        self.text, self.by = text, by


def copy(parcel):
    """Return the bytes of a scene, which this worker keeps: Dask forgets the replicas of dependencies within seconds."""
    return parcel()


def decide(name, parcel):
    return _told(worker.decide, name, parcel, _threads())


def prepare(name, parcel):
    return _told(worker.prepare, name, parcel, _threads())


def render(name, parcel, splits, ranges):
    return _told(worker.render, name, parcel, splits, ranges, _threads(), get_worker().address)


def join(*made):
    failed = [one for one in made if isinstance(one, Failure)]
    return failed[0] if failed else _told(worker.join, *made)
