"""F12 on many machines: the session that a scheduler's workers render."""

import contextlib
from typing import NamedTuple

from ..farm.pipe_pool import PipePool
from ..farm.pool import PoolError
from ..farm.remote_session import RemoteSession
from ..farm.still import set_rounds


class Machines(NamedTuple):
    """Where a scene's pictures are rendered."""

    scheduler: str


def wanted(scene):
    """Return the Machines of a scene; None: this machine renders."""
    own = scene.lancer
    return Machines(own.scheduler.strip()) if own.use_many_machines else None


@contextlib.contextmanager
def opened(machines, snapshot, poll, tell):
    """Context of a RemoteSession. tell(text) reports what the render waits for."""
    if not machines.scheduler:
        raise PoolError("Many Machines is on, but names no scheduler: set Render Properties > Many Machines > Scheduler")
    tell(f"Connecting to {machines.scheduler}")
    pool = PipePool("", machines.scheduler, poll, lambda trouble: tell(f"{machines.scheduler}: {trouble}" if trouble else ""))
    try:
        tell("Sending the scene to the workers")
        with RemoteSession(snapshot, pool, poll) as session:
            yield session
    finally:
        pool.close()


def prepare(schedule):
    """Set the length of rounds, which cost a way to the workers and back."""
    if pool_of(schedule) is not None:
        set_rounds(schedule)


def pool_of(schedule):
    return getattr(schedule.session, "pool", None)


def status(schedule):
    """Yield the part of the progress line about workers."""
    pool = pool_of(schedule)
    if pool is not None:
        yield pool.trouble or f"{pool.workers} worker{'s' * (pool.workers != 1)}"
