"""The reported error and renders to a target or time limit, on four small scenes. `make accuracy` runs more scenes."""

import dataclasses
import functools

import numpy as np
import pytest
from scipy import stats
from significance import LEVEL
from tiny_scenes import showroom
from tools.accuracy import figures, scenes
from tools.harness.errors import Reference, luminance

from addon.bindings.abi import LancerError, Pass, Status
from addon.bindings.session import Scene, Session
from addon.bindings.snapshot import Settings
from addon.measure import schedule as schedules
from addon.measure.schedule import CANCELLED, SAMPLES, TARGET, TIME, Schedule

SEEDS = 6
BUILDERS = {scene.__name__: scene for scene in (scenes.half_black, scenes.soft_shadow, scenes.glossy, scenes.swing)}
FOREVER = 1 << 22
NAN = float("nan")


def settings(snapshot, **fields):
    return dataclasses.replace(snapshot, settings=dataclasses.replace(snapshot.settings, **fields))


def finished(session):
    while not session.wait(0.1).finished:
        pass


@functools.cache
def measured(name):
    """Return (snapshot, reference) of a scene of 1536 pixels, small enough to converge here."""
    snapshot = scenes.at_size(BUILDERS[name](), 48, 32)
    parts = []
    with Scene.upload(snapshot) as scene:
        for seed in range(4):
            wanted = dataclasses.replace(snapshot.settings, threads=0, samples=512, seed=1001 + seed)
            with Session(scene, snapshot.camera, wanted) as session:
                session.render_all()
                parts.append(luminance(session.read()))
    return snapshot, Reference(np.stack(parts))


def test_bars_hold_the_pixels_and_intervals_the_errors():
    inside, pixels, held = 0, 0, 0
    for name in BUILDERS:
        snapshot, reference = measured(name)
        for seed in range(SEEDS):
            with Session.upload(settings(snapshot, threads=0, samples=64, seed=seed)) as session:
                session.render_all()
                told, picture = session.error(), luminance(session.read())
                good = figures.inside(picture, session.read(Pass.ERROR)[..., 0], reference)
            inside += int(good[reference.noisy].sum())
            pixels += int(reference.noisy.sum())
            held += told.low <= reference.distance(picture) <= told.bound
    # The promise is 95 +- 1.5 % over many scenes, plus the binomial deviation of that many independent pixels. At 64 samples
    # the variance of these four falls faster than 1/N, where halves overestimate it: errors 1.2 times too large hold 98.1 %.
    low, high = (stats.binom.ppf(p, pixels, share) for p, share in ((LEVEL, 0.935), (1.0 - LEVEL, 0.981)))
    assert low <= inside <= high, f"{inside / pixels:.4f}"
    # The promise for pictures is 93 %.
    assert held >= stats.binom.ppf(LEVEL, SEEDS * len(BUILDERS), 0.93)


def test_targets_are_met_without_bias():
    met, scores = 0, []
    for name in BUILDERS:
        snapshot, reference = measured(name)
        pictures = []
        for seed in range(SEEDS):
            with Session.upload(settings(snapshot, threads=0, samples=FOREVER, seed=seed, target_error=0.15)) as session:
                schedule = drive(session)
                assert schedule.reason is TARGET
                assert schedule.error.bound <= 0.15
                pictures.append(luminance(session.read()))
            met += reference.distance(pictures[-1]) <= 0.15
        scores.append(figures.bias(np.stack(pictures), reference)["whole"])
    assert met >= stats.binom.ppf(LEVEL, SEEDS * len(BUILDERS), 0.95)
    assert np.abs(scores).max() <= 4.0, scores


def drive(session, schedule=None, watch=lambda: None):
    schedule = schedule or Schedule(session)
    while schedule.start():
        while not schedule.wait(0.01).finished:
            watch()
    return schedule


def room(**fields):
    return showroom(40, **{"samples": FOREVER, "target_error": 0.4, "passes": (Pass.COMBINED,), **fields})


@functools.cache
def refined(threads, tile_size):
    """Return the reason, the bits and the PictureError of a render to a target."""
    with Session.upload(room(threads=threads, tile_size=tile_size)) as session:
        schedule = drive(session)
        told = dataclasses.replace(session.error(), clipped=0.0, missing=0.0)
        return schedule.reason, session.read().tobytes(), session.read(Pass.ERROR).tobytes(), told


@pytest.mark.parametrize("threads, tile_size", [(2, 0), (1, 5), (3, 37), (2, 256)])
def test_refined_pictures_have_the_same_bits(threads, tile_size):
    reason, picture, bars, told = refined(1, 0)
    assert told.most_samples > told.least_samples, "nothing was refined"
    assert refined(threads, tile_size) == (reason, picture, bars, told)


def test_a_target_out_of_reach_gives_the_bits_of_even_samples():
    with Session.upload(room(target_error=1e-9, samples=128)) as session:
        schedule = drive(session)
        assert schedule.reason is SAMPLES
        got = session.read()
        assert session.error().least_samples == session.error().most_samples == 128
    with Session.upload(room(target_error=0.0, samples=128)) as session:
        session.render_all()
        assert session.read().tobytes() == got.tobytes()


@pytest.mark.parametrize("samples", [1, 48, 100])
def test_samples_end_a_render_that_cannot_double(samples):
    with Session.upload(room(target_error=1e-9, samples=samples)) as session:
        assert drive(session).reason is SAMPLES
        assert session.error().least_samples == session.error().most_samples == samples


def test_even_renders_end_with_their_samples():
    with Session.upload(room(target_error=0.0, samples=37)) as session:
        schedule = drive(session)
        assert (schedule.reason, schedule.samples, schedule.error) == (SAMPLES, 37, None)


def is_power_of_two(count):
    return count > 0 and count & (count - 1) == 0


def test_what_stopping_takes_back_is_no_bias():
    """Stopping discards 63 of 127 samples; their shares of clamped and missing light must be discarded too."""
    with Session.upload(room(clamp_indirect=0.05, max_bounces=1)) as session:
        session.render_all(64)
        before = session.error()
        session.render(64, 63)
        finished(session)
        session.stop()
        finished(session)
        after = session.error()
    # Otherwise both shares would nearly double.
    assert after.most_samples == 64 and before.clipped > 0.01 and before.missing > 0.001
    assert after.clipped < 1.5 * before.clipped and after.missing < 1.5 * before.missing


def test_stopping_leaves_powers_of_two():
    snapshot = room(samples=FOREVER, threads=2)
    with Session.upload(snapshot) as session:
        session.render(0, 8)
        finished(session)
        session.render(8, FOREVER - 8)
        while session.wait(0.01).samples < 20 * 40 * 40:
            pass
        session.stop()
        finished(session)
        told, got = session.error(), session.read()
        assert is_power_of_two(told.least_samples) and is_power_of_two(told.most_samples)
        # Every pixel equals that of a render with equal samples for one of these numbers of samples.
        found = np.zeros(got.shape[:2], bool)
        count = told.least_samples
        with Session.upload(snapshot) as even:
            even.render(0, count)
            finished(even)
            while True:
                found |= (even.read() == got).all(axis=2)
                if count == told.most_samples:
                    break
                even.render(count, count)
                finished(even)
                count *= 2
        assert found.all()
        # Repeated waits and a cancel after the end have no effect, and the session can continue.
        assert not session.wait(0.0).cancelled
        session.cancel()
        assert not session.wait(0.0).cancelled
        assert session.refine(0.0)
        finished(session)
        assert session.error().least_samples == 2 * told.least_samples


class Clock:
    """A clock that advances by one second per call."""

    def __init__(self):
        self.now = 0.0

    def monotonic(self):
        self.now += 1.0
        return self.now


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(schedules, "time", clock)
    return clock


def drive_until(session, clock, schedule):
    """Return the time at which the schedule stopped the session."""
    stopped, stop = [], session.stop
    session.stop = lambda: stopped.append(clock.now) or stop()
    drive(session, schedule)
    return stopped[0] if stopped else clock.now


# Calls of the clock for each range besides the checks of the time limit: at its start and at its end.
OTHER_LOOKS = 2


@pytest.mark.parametrize("limit", [1.0, 30.0, 100.0])
def test_time_ends_a_render_on_powers_of_two(clock, limit):
    with Session.upload(room(target_error=0.0, time_limit=limit, samples=FOREVER)) as session:
        schedule = Schedule(session)
        begun = clock.now
        ended = drive_until(session, clock, schedule)
        assert schedule.reason is TIME
        assert limit <= ended - begun <= limit + 1.0 + OTHER_LOOKS or schedule.samples == 1
        told = session.error()
        assert is_power_of_two(told.least_samples) and is_power_of_two(told.most_samples)
        assert not schedule.start()


def test_the_first_sample_is_there_however_late_it_is(clock):
    with Session.upload(room(target_error=0.0, time_limit=1.0, samples=FOREVER)) as session:
        schedule = drive(session, Schedule(session, started=-1000.0))
        assert (schedule.reason, schedule.samples) == (TIME, 1)
        assert session.error().least_samples == session.error().most_samples == 1


def test_what_comes_after_the_last_sample_is_part_of_the_time(clock):
    with Session.upload(room(target_error=0.0, time_limit=1000.0, samples=FOREVER)) as session:
        schedule = Schedule(session)
        begun = clock.now
        schedule.reserve = 980.0
        ended = drive_until(session, clock, schedule)
        assert schedule.reason is TIME
        assert 20.0 <= ended - begun <= 21.0 + OTHER_LOOKS or schedule.samples == 1


def test_what_remains_is_unknown_until_the_error_is():
    """With a target a huge limit of samples must not be reported as hours before the error is first read."""
    with Session.upload(room(samples=FOREVER, target_error=0.01)) as session:
        schedule = Schedule(session)
        for _ in range(3):
            assert schedule.start()
            while not schedule.wait(0.05).finished:
                pass
        assert schedule.remaining()[0] == np.inf
        schedule.look()
        seconds, reason = schedule.remaining()
        assert 0.0 < seconds < np.inf and reason is TARGET
    with Session.upload(room(samples=64, target_error=0.0)) as session:
        schedule = Schedule(session)
        schedule.start()
        while not schedule.wait(0.05).finished:
            pass
        assert schedule.remaining()[1] is SAMPLES and schedule.remaining()[0] < np.inf


def test_a_cancelled_render_says_so():
    with Session.upload(room(samples=FOREVER, target_error=1e-9)) as session:
        schedule = Schedule(session)
        assert drive(session, schedule, schedule.cancel).reason is CANCELLED
        assert not schedule.start()


def test_bars_can_be_read_while_rendering():
    with Session.upload(room(samples=FOREVER)) as session:
        assert np.isinf(session.read(Pass.ERROR)).all()
        assert not session.error().known
        session.render(0, 2)
        finished(session)
        before = session.read(Pass.ERROR)
        assert np.isfinite(before).all() and session.error().known
        session.render(2, FOREVER - 2)
        for _ in range(5):
            session.wait(0.01)
            assert np.isfinite(session.read(Pass.ERROR)).all()
            told = session.error()
            assert told.low <= told.error <= told.high < np.inf
        session.stop()
        finished(session)
        # Further samples change the error.
        assert session.error().least_samples >= 2
        assert (session.read(Pass.ERROR) != before).any()


def refused(session, text):
    with pytest.raises(LancerError, match=text) as error:
        session.refine(0.1)
    assert error.value.status is Status.ERROR_STATE


def test_refining_is_refused_in_wrong_states():
    with Session.upload(room(target_error=0.0)) as session:
        session.render_all(64)
        refused(session, "not created to be refined")
    with Session.upload(room(samples=FOREVER)) as session:
        refused(session, "every pixel needs 2 samples")
        session.render_all(1)
        refused(session, "every pixel needs 2 samples")
        session.render(1, 47)
        finished(session)
        refused(session, "48 samples are not a power of two")
        session.render(48, FOREVER - 48)
        refused(session, "still being rendered")
        session.cancel()
        finished(session)
        refused(session, "was cancelled")
    with Session.upload(room(samples=FOREVER)) as session:
        session.render_all(64)
        assert session.refine(0.2)
        finished(session)
        assert session.error().most_samples > session.error().least_samples
        with pytest.raises(LancerError, match="can only be refined"):
            session.render(64, 64)


@pytest.mark.parametrize(
    "target, confidence",
    [(-1.0, 0.95), (float("nan"), 0.95), (float("inf"), 0.95), (0.1, 0.0), (0.1, 1.0), (0.1, float("nan"))],
)
def test_wrong_targets_are_refused(target, confidence):
    with Session.upload(room()) as session:
        session.render_all(2)
        with pytest.raises(LancerError) as error:
            session.refine(target, confidence)
        assert error.value.status is Status.ERROR_ARGUMENT


def test_a_cancelled_session_stays_so():
    with Session.upload(room(samples=FOREVER)) as session:
        session.render(0, FOREVER)
        session.wait(0.01)
        session.cancel()
        while not session.wait(0.05).finished:
            pass
        before = session.read()
        session.stop()
        assert session.wait(0.0).cancelled
        assert (session.read() == before).all()


def test_a_time_limit_or_a_target_asks_for_refinement():
    assert Settings(time_limit=1.0).refines and Settings(target_error=0.1).refines and not Settings().refines
