"""Stills by real workers: processes of Dask that are killed, come late, or send rubbish, and a scheduler that is restarted."""

import dataclasses
import threading

import pytest
import small_cluster
from distributed import Client
from rich_snapshot import rich

from addon.bindings.session import Session
from addon.farm.dask_pool import DaskPool
from addon.farm.remote_session import RemoteSession
from addon.farm.still import render_still
from addon.measure.schedule import SAMPLES, TARGET, Schedule

# A worker that sends parts with one wrong bit.
RUBBISH = """
from addon.farm import dask_tasks, worker

def render(*arguments, right=worker.render):
    made = right(*arguments)
    made.part[len(made.part) // 2] ^= 1
    return made

worker.render = render
"""


def delayed(seconds):
    """Return the code of a worker that takes so much longer for each task."""
    return f"""
import time
from addon.farm import worker

def render(*arguments, right=worker.render):
    time.sleep({seconds})
    return right(*arguments)

worker.render = render
"""


def snapshot(**settings):
    plain = rich()
    camera = dataclasses.replace(plain.camera, width=80, height=60, region_width=80, region_height=60)
    settings = {"samples": 128, "split_lights": 0, "split_paths": 0, "passes": (0, 1, 24)} | settings
    # Motion adds noise that leaves nothing for splits to remove.
    still = dataclasses.replace(plain.instances, motions=())
    return dataclasses.replace(plain, camera=camera, settings=plain.settings.replaced(**settings), instances=still, motion=None)


def alone(scene):
    """Return the passes, error and reason of a render by one session."""
    with Session.upload(scene) as session:
        schedule = Schedule(session)
        while schedule.start():
            while not schedule.wait(0.05).finished:
                pass
        return [session.read(which) for which in scene.settings.passes], session.error(), schedule.reason


def expect_the_same(session, schedule, expected):
    passes, error, reason = expected
    assert schedule.reason is reason and session.error() == error
    for which, picture in zip(session.settings.passes, passes, strict=True):
        assert session.read(which).tobytes() == picture.tobytes(), which


@pytest.fixture(scope="module")
def by_samples():
    return alone(snapshot())


@pytest.fixture
def cluster(tmp_path):
    with small_cluster.cluster(tmp_path) as made:
        yield made


def render(cluster, scene, expected, then=None, at=0.1):
    """Render by the cluster, call then() once when that share is done, and compare; return the RemoteSession."""
    happened = []

    def tell(fraction, _text):
        if then is not None and fraction >= at and not happened:
            happened.append(True)
            then()

    pool = DaskPool(cluster.address)
    try:
        with RemoteSession(scene, pool) as session:
            schedule = render_still(session, tell)
            expect_the_same(session, schedule, expected)
            assert then is None or happened, "the render ended before anything happened"
            return session
    finally:
        pool.close()


def test_two_workers_give_the_bits_of_one_process(cluster, by_samples):
    copies = []
    cluster.wait_for_workers(2)

    def count_copies():
        with Client(cluster.address, set_as_default=False) as client:
            copies.extend(holders for key, holders in client.who_has().items() if key.startswith(("ndarray", "copy")))

    session = render(cluster, snapshot(), by_samples, count_copies)
    assert len(session.makers) == 2 and not session.refused
    # The scene is not lost with one worker.
    assert len(set(copies)) == 2
    assert by_samples[2] is SAMPLES
    # Workers that decided for themselves would not be noticed where a sample follows one light and one path.
    assert max(session.splits) > 1


def test_rounds_to_a_target_error_are_those_of_one_process(cluster):
    scene = snapshot(samples=512, target_error=0.35)
    expected = alone(scene)
    session = render(cluster, scene, expected)
    assert expected[2] is TARGET and expected[1].least_samples < expected[1].most_samples
    assert len(session.makers) == 2


def test_a_killed_worker_loses_nothing(cluster, by_samples):
    render(cluster, snapshot(), by_samples, lambda: cluster.stop(cluster.processes[1]))


def test_the_scene_is_brought_again_when_all_its_workers_are_gone(cluster, by_samples):
    def replace():
        for worker in cluster.processes[1:3]:
            cluster.stop(worker)
        cluster.start_worker()

    session = render(cluster, snapshot(), by_samples, replace)
    # No task has waited for the scene in vain, and no worker is blamed.
    assert len(session.makers) == 3 and not session.refused


def test_a_late_worker_helps(tmp_path, by_samples):
    with small_cluster.cluster(tmp_path, workers=0) as cluster:
        # Each of these tasks takes as long as the late worker's first look at the scene: it does not come too late.
        for _ in range(2):
            cluster.start_worker(delayed(0.5))

        def come():
            cluster.start_worker()
            cluster.wait_for_workers(3)

        session = render(cluster, snapshot(), by_samples, come)
        assert len(session.makers) == 3


def test_a_restarted_scheduler_gets_the_rest(cluster, by_samples):
    def restart():
        cluster.stop(cluster.scheduler)

        def again():
            cluster.start_scheduler()
            cluster.start_worker()

        threading.Thread(target=again).start()

    render(cluster, snapshot(), by_samples, restart)


def test_a_worker_that_sends_rubbish_is_named_and_avoided(cluster, by_samples):
    cluster.start_worker(RUBBISH)
    cluster.wait_for_workers(3)
    session = render(cluster, snapshot(), by_samples)
    # It is avoided after two wrong parts; of the tasks that are handed out by then, two for each worker, it may have the rest.
    assert 1 <= len(session.refused) <= 2 + 2 * 3 and all("damaged" in sentence for sentence in session.refused)
    named = {sentence.split(": ")[0] for sentence in session.refused}
    assert len(named) == 1 and named.isdisjoint(session.makers)


def test_a_slow_workers_task_is_given_to_another(cluster, by_samples):
    # Far longer than all others need for the picture.
    cluster.start_worker(delayed(10.0))
    cluster.wait_for_workers(3)
    session = render(cluster, snapshot(), by_samples)
    assert len(session.makers) == 2
