"""Calls in the wrong order: each returns a state error with a message and leaves existing work unchanged."""

import ctypes
import threading

import numpy as np
from raw import Raw

from addon.bindings import abi
from addon.bindings.abi import Accelerator, Status


def refused(result, status=Status.ERROR_STATE):
    assert result[0] == status and result[1], result


def test_render_before_commit(raw):
    refused(raw.create_session(raw.filled()))


def test_fill_after_commit(raw):
    scene = raw.committed()
    refused(raw.call("lancer_scene_add_mesh", scene, ctypes.byref(raw.mesh())))
    refused(raw.call("lancer_scene_add_material", scene, ctypes.byref(raw.material())))
    refused(raw.call("lancer_scene_add_light", scene, ctypes.byref(raw.light())))
    refused(raw.add_instances(scene, [raw.instance()]))
    refused(raw.call("lancer_scene_add_image", scene, ctypes.byref(raw.image())))
    refused(raw.call("lancer_scene_set_world", scene, ctypes.byref(raw.world())))
    refused(raw.call("lancer_scene_commit", scene, Accelerator.BVH, 1))


def test_wait_without_commit(raw):
    refused(raw.call("lancer_scene_wait", raw.filled(), 0))


def test_probe_before_commit(raw):
    array = np.zeros(16)
    p = array.ctypes.data
    refused(raw.call("lancer_probe_intersect", raw.filled(), 1, p, p, p, p, ctypes.addressof((abi.Hit * 1)())))


def test_wrong_accelerator(raw):
    result = raw.call("lancer_scene_commit", raw.filled(), 3, 1)
    assert result[0] == Status.ERROR_ARGUMENT and "3" in result[1], result


def test_the_first_sample_must_follow(raw):
    session = raw.session(raw.committed())
    for first in (1, 4, 2**32 - 1):
        result = raw.call("lancer_session_render", session, first, 1)
        assert result[0] in (Status.ERROR_ARGUMENT, Status.ERROR_STATE) and str(first) in result[1], result
    assert raw.call("lancer_session_render", session, 0, 2)[0] == Status.OK
    assert raw.wait("lancer_session_wait", session)[0] == Status.OK
    for first in (0, 1, 3):
        result = raw.call("lancer_session_render", session, first, 1)
        assert result[0] in (Status.ERROR_ARGUMENT, Status.ERROR_STATE) and str(first) in result[1], result
    assert raw.call("lancer_session_render", session, 2, 1)[0] == Status.OK
    assert raw.wait("lancer_session_wait", session)[0] == Status.OK


def test_sample_numbers_do_not_run_over(raw):
    session = raw.session(raw.committed())
    assert raw.call("lancer_session_render", session, 0, 1)[0] == Status.OK
    assert raw.wait("lancer_session_wait", session)[0] == Status.OK
    result = raw.call("lancer_session_render", session, 1, 2**32 - 1)
    if result[0] == Status.OK:
        assert raw.call("lancer_session_cancel", session)[0] == Status.OK
        assert raw.wait("lancer_session_wait", session)[0] == Status.CANCELLED
    else:
        assert result[0] == Status.ERROR_ARGUMENT and result[1]


def test_render_while_running(raw):
    session = raw.session(raw.committed())
    assert raw.call("lancer_session_render", session, 0, 10**6)[0] == Status.OK
    refused(raw.call("lancer_session_render", session, 10**6, 1))
    refused(raw.call("lancer_session_render", session, 0, 1))
    assert raw.call("lancer_session_cancel", session)[0] == Status.OK
    assert raw.wait("lancer_session_wait", session)[0] == Status.CANCELLED


def test_two_sessions_of_one_scene_render_at_once(raw):
    scene = raw.committed()
    sessions = [raw.session(scene) for _ in range(2)]
    for session in sessions:
        assert raw.call("lancer_session_render", session, 0, 64)[0] == Status.OK
    for session in sessions:
        assert raw.wait("lancer_session_wait", session)[0] == Status.OK
    one, two = (raw.read(session, 0, 16 * 16 * 4)[2] for session in sessions)
    assert np.array_equal(one, two)


def test_a_scene_may_go_before_its_sessions(raw):
    """A session keeps its scene's data: destroying the scene's handle during a render does not change the picture."""
    scene = raw.committed()
    pictures = []
    for destroy in (False, True):
        session = raw.session(scene)
        assert raw.call("lancer_session_render", session, 0, 64)[0] == Status.OK
        if destroy:
            assert raw.call("lancer_scene_destroy", scene)[0] == Status.OK
        assert raw.wait("lancer_session_wait", session)[0] == Status.OK
        status, _, picture = raw.read(session, 0, 16 * 16 * 4)
        assert status == Status.OK
        pictures.append(picture)
        assert raw.call("lancer_session_destroy", session)[0] == Status.OK
    assert np.array_equal(*pictures)


def test_destroy_while_rendering(raw):
    for _ in range(20):
        scene = raw.committed()
        session = raw.session(scene, settings=raw.settings(threads=2))
        assert raw.call("lancer_session_render", session, 0, 10**6)[0] == Status.OK
        assert raw.call("lancer_session_destroy", session)[0] == Status.OK
        assert raw.call("lancer_scene_destroy", scene)[0] == Status.OK


def test_destroy_while_building(raw):
    rng = np.random.default_rng(1)
    for _ in range(5):
        scene = raw.scene()
        positions = rng.random((60000, 3))
        mesh = raw.mesh(positions=positions, triangles=rng.integers(0, 60000, (100000, 3)))
        assert raw.call("lancer_scene_add_mesh", scene, ctypes.byref(mesh))[0] == Status.OK
        raw.call("lancer_scene_add_material", scene, ctypes.byref(raw.material()))
        assert raw.add_instances(scene, [raw.instance()])[0] == Status.OK
        assert raw.call("lancer_scene_commit", scene, Accelerator.BVH, 2)[0] == Status.OK
        assert raw.call("lancer_scene_destroy", scene)[0] == Status.OK


def test_cancelled_build(raw):
    """A cancelled build returns CANCELLED unless it has already ended; a cancelled scene accepts no session."""
    rng = np.random.default_rng(2)
    scene = raw.scene()
    mesh = raw.mesh(positions=rng.random((300000, 3)), triangles=rng.integers(0, 300000, (400000, 3)))
    assert raw.call("lancer_scene_add_mesh", scene, ctypes.byref(mesh))[0] == Status.OK
    raw.call("lancer_scene_add_material", scene, ctypes.byref(raw.material()))
    assert raw.add_instances(scene, [raw.instance()])[0] == Status.OK
    assert raw.call("lancer_scene_commit", scene, Accelerator.KDTREE, 1)[0] == Status.OK
    assert raw.call("lancer_scene_cancel", scene)[0] == Status.OK
    status, _ = raw.wait("lancer_scene_wait", scene)
    assert status in (Status.CANCELLED, Status.OK)
    if status == Status.CANCELLED:
        refused(raw.create_session(scene))


def test_waits_and_cancels_of_idle_handles_are_harmless(raw):
    scene = raw.committed()
    session = raw.session(scene)
    assert raw.call("lancer_scene_wait", scene, 0)[0] == Status.OK
    assert raw.call("lancer_scene_cancel", scene)[0] == Status.OK
    assert raw.call("lancer_session_cancel", session)[0] == Status.OK
    assert raw.call("lancer_session_wait", session, 0, None)[0] in (Status.OK, Status.CANCELLED, Status.ERROR_STATE)
    assert raw.call("lancer_session_render", session, 0, 1)[0] == Status.OK
    assert raw.wait("lancer_session_wait", session)[0] == Status.OK


def test_empty_range(raw):
    session = raw.session(raw.committed())
    status, message = raw.call("lancer_session_render", session, 0, 0)
    if status == Status.OK:
        assert raw.wait("lancer_session_wait", session)[0] == Status.OK
    else:
        assert status == Status.ERROR_ARGUMENT and message


def test_empty_scene(raw):
    """An empty scene is valid: black, with alpha 1."""
    scene = raw.scene()
    assert raw.commit(scene)[0] == Status.OK
    session = raw.session(scene)
    assert raw.call("lancer_session_render", session, 0, 1)[0] == Status.OK
    assert raw.wait("lancer_session_wait", session)[0] == Status.OK
    picture = raw.read(session, 0, 16 * 16 * 4)[2].reshape(-1, 4)
    assert np.all(picture == (0, 0, 0, 1))


def test_messages_are_kept_per_thread(raw):
    """The message of a failure in one thread is not visible in another."""
    refused(raw.call("lancer_scene_destroy", 0), Status.ERROR_HANDLE)
    here = raw.library.lancer_last_error()
    elsewhere = []
    thread = threading.Thread(target=lambda: elsewhere.append(raw.library.lancer_last_error()))
    thread.start()
    thread.join()
    assert elsewhere == [b""] and raw.library.lancer_last_error() == here != b""


def test_many_threads_on_one_scene(raw):
    """Probes and sessions of one scene run in several threads while other scenes are created and destroyed."""
    scene = raw.committed()
    failures = []

    def work():
        other = Raw(raw.library)
        for _ in range(10):
            session = other.session(scene)
            if other.call("lancer_session_render", session, 0, 4)[0] != Status.OK:
                failures.append("render")
            if other.wait("lancer_session_wait", session)[0] != Status.OK:
                failures.append("wait")
            if other.call("lancer_session_destroy", session)[0] != Status.OK:
                failures.append("destroy")

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failures == []
