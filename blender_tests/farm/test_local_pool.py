"""The pool of one worker within this process."""

import threading

import pytest
from picture_parts import different, finish, told
from remote_pictures import PICTURES, expected

from addon.farm import worker
from addon.farm.pool import LocalPool, PoolError
from addon.farm.remote_session import RemoteSession
from addon.farm.still import render_still


def test_the_local_pool_renders_the_same():
    pool = LocalPool(threads=1)
    with RemoteSession(PICTURES["unreached target"][0], pool) as session:
        render_still(session)
        assert different(told(session), expected("unreached target")[0]) == []
        assert set(session.makers) == {pool.address} and session.refused == [] and pool.waiting == 0
    pool.close()
    assert not pool._thread.is_alive()


def test_the_local_pool_forgets_cancelled_tasks(monkeypatch):
    begun, may_end = threading.Event(), threading.Event()
    render, ended = worker.render, LocalPool.ended

    def held(*arguments):
        begun.set()
        may_end.wait()
        return render(*arguments)

    def let_end(pool, seconds):
        may_end.set()
        return ended(pool, seconds)

    pool = LocalPool(threads=1)
    with RemoteSession(PICTURES["samples"][0], pool) as session, monkeypatch.context() as patched:
        patched.setattr(worker, "render", held)
        patched.setattr(LocalPool, "ended", let_end)
        try:
            session.render(0, 64)
            # One task is in work, and one waits.
            begun.wait()
            session.stop()
            assert pool.waiting == 0 and pool.ended(0.0) == [] and session.statistics().samples == 0
        finally:
            may_end.set()
        # It can go on.
        session.render(64, 1)
        finish(session)
        assert session.statistics().samples == 36 * 20
    pool.close()


def test_the_local_pools_failure_ends_the_picture(monkeypatch):
    def fail(*_):
        raise MemoryError("none left")

    pool = LocalPool(threads=1)
    with RemoteSession(PICTURES["samples"][0], pool) as session:
        monkeypatch.setattr(worker, "render", fail)
        with pytest.raises(PoolError, match="this machine .*MemoryError: none left"):
            render_still(session)
    pool.close()
