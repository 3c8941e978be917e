"""The requests of a schedule, and its end, with a session that renders nothing and returns given errors."""

import math
from types import SimpleNamespace

import pytest

from addon.bindings.session import PictureError
from addon.bindings.snapshot import Settings
from addon.measure.schedule import SAMPLES, TARGET, Schedule


def error(value, high, cannot_exclude=0.0):
    return PictureError(value, 0.9 * value, high, cannot_exclude, *[0.0] * 10, 16, 16)


class GivenSession:
    """A picture of two pixels. errors: what it returns, one after the other, the last for ever."""

    def __init__(self, errors=(), **settings):
        self.settings = Settings(**settings)
        self.camera = SimpleNamespace(region_width=2, region_height=1)
        self.errors = list(errors)
        self.ranges = []

    def render(self, first, count):
        self.ranges.append((first, count))

    def wait(self, seconds):
        done = 2 * sum(count for _, count in self.ranges)
        return SimpleNamespace(samples=done, seconds=float(done), finished=True, cancelled=False)

    def error(self, confidence=0.95):
        return self.errors.pop(0) if len(self.errors) > 1 else self.errors[0]

    def refine(self, target, confidence):
        return False


def drive(session, most=100, longest=1.0):
    schedule = Schedule(session)
    schedule.longest = longest
    while schedule.start():
        schedule.wait(0.0)
        assert len(session.ranges) < most
    return schedule


@pytest.mark.parametrize("errors", [(0.05, 0.11), (0.05, 0.09, 0.02)])
def test_the_upper_end_decides_whether_a_target_is_met(errors):
    """Neither the estimate of 5 % nor an upper end of 9 %, to which unseen light may add 2 %, meets a target of 10 %."""
    session = GivenSession([error(*errors), error(0.05, 0.09)], target_error=0.1, samples=1024)
    assert drive(session).reason is TARGET
    # It is looked at after 16 samples, and at the next power of two.
    assert sum(count for _, count in session.ranges) == 32


@pytest.mark.parametrize("samples", [1, 3, 100])
def test_ranges_follow_one_another_up_to_the_samples(samples):
    session = GivenSession(samples=samples)
    assert drive(session).reason is SAMPLES
    assert [first for first, _ in session.ranges] == [
        sum(count for _, count in session.ranges[:n]) for n in range(len(session.ranges))
    ]
    assert sum(count for _, count in session.ranges) == samples


def test_slow_ranges_leave_at_most_four_sums_waiting():
    """A film keeps one sum for each set bit of the samples; lancer_session_create checks the memory of four."""
    session = GivenSession(samples=1000)
    assert drive(session, longest=0.0).reason is SAMPLES
    ends = [first + count for first, count in session.ranges]
    assert len(ends) > 40 and max(end.bit_count() for end in ends[:-1]) == 4 and ends[-1] == 1000


def test_what_a_target_still_needs_grows_with_the_square_of_the_error():
    """At twice the target after 16 samples of two pixels: three times as many again, one each second."""
    session = GivenSession([error(0.1, 0.2)], target_error=0.1, samples=1 << 20)
    schedule = Schedule(session)
    while schedule.samples < 16:
        assert schedule.start()
        schedule.wait(0.0)
    schedule.look()
    seconds, reason = schedule.remaining()
    assert reason is TARGET and seconds == pytest.approx(96.0)
    assert math.isclose(schedule.error.bound, 0.2)


@pytest.mark.parametrize("looks", [0, 3])
def test_rounds_do_not_depend_on_how_often_a_picture_is_shown(looks):
    """Whoever shows a picture asks whether it is the last one, and reads its error, at times that no clock repeats."""
    asked = []

    class Refined(GivenSession):
        def error(self, confidence=0.95):
            # As in the library, the interval widens with the confidence.
            return error(0.1, 0.1 / (1.0 - confidence))

        def refine(self, target, confidence):
            asked.append((target, confidence))
            self.ranges.append((0, 1))
            return True

    schedule = Schedule(Refined(target_error=0.1, samples=1024))
    while len(asked) < 4:
        assert schedule.start() and schedule.wait(0.0).finished
        for _ in range(looks):
            assert not schedule.over
            schedule.look()
    # Each check may be wrong with half the probability of the one before.
    assert asked == [(0.1, 1.0 - 0.1 / 2.0**n) for n in range(1, 5)]
