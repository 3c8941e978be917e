"""The work of one machine: which scenes it keeps, and what it says of faults."""

import pickle

import pytest
from picture_parts import different, joiner, room, told

from addon.bindings.session import LancerError, Session
from addon.farm import worker
from addon.farm.cut import whole_range

SPLITS = (2, 2)


@pytest.fixture(autouse=True)
def kept():
    """Begin and end without scenes."""

    def forget():
        for session in worker._sessions.values():
            session.close()
        for place in worker._scenes.values():
            place.scene.close()
        worker._sessions.clear()
        worker._scenes.clear()

    forget()
    yield
    forget()


class Sent:
    """A snapshot on its way; asked: how often its bytes were."""

    def __init__(self, snapshot):
        self.snapshot, self.asked = snapshot, 0
        self.name, self.bytes = worker.encoded(snapshot)

    def data(self):
        self.asked += 1
        return self.bytes

    def render(self, first=0, count=4, splits=SPLITS):
        tiles = len(joiner(self.snapshot).tiles())
        return worker.render(self.name, self.data, splits, whole_range(first, count, tiles), 1, "here")


def test_parts_are_those_of_the_snapshot():
    """Also where it has a target error and a time limit, which are the client's."""
    sent = Sent(room(8, target_error=0.5, time_limit=1.0))
    made = [sent.render(0, 5), sent.render(5, 3)]
    with joiner(sent.snapshot) as picture, Session.upload(sent.snapshot) as whole:
        for one in made:
            picture.add(one.part)
        whole.render_all(8)
        assert different(told(picture), told(whole)) == []
    assert sent.asked == 1 and made[0].by == ("here",) and made[0].seconds > 0.0


def test_the_scene_in_use_and_the_one_before_are_kept():
    first, second, third = sents = [Sent(room(8, seed=seed)) for seed in range(3)]
    parts = [sent.render().part.tobytes() for sent in (first, second)]
    # A use makes a scene the last one in use.
    assert first.render().part.tobytes() == parts[0]
    closed = worker._sessions[second.name, SPLITS]
    third.render()
    assert list(worker._scenes) == [first.name, third.name] and [sent.asked for sent in sents] == [1, 1, 1]
    assert {name for name, _ in worker._sessions} == {first.name, third.name}
    with pytest.raises(LancerError, match="no such session"):
        closed.statistics()
    assert second.render().part.tobytes() == parts[1]
    assert [sent.asked for sent in sents] == [1, 2, 1] and list(worker._scenes) == [third.name, second.name]


def test_a_scene_is_made_ready_once():
    sent = Sent(room(16, split_lights=0, split_paths=0))
    worker.prepare(sent.name, sent.data, 1)
    decision = worker.decide(sent.name, sent.data, 1)
    made = sent.render(0, 4, (decision.split_lights, decision.split_paths))
    assert sent.asked == 1 and (decision.split_lights, decision.split_paths) == (2, 1)
    with Session.upload(sent.snapshot) as whole:
        whole.render_all(4)
        assert (whole.statistics().split_lights, whole.statistics().split_paths) == (2, 1)
        assert whole.messages() == list(decision.messages)
        assert decision.figures["lights"] == whole.statistics().lights > 0
        assert made.instruction_set == whole.statistics().instruction_set


def test_a_damaged_scene_is_refused():
    sent = Sent(room())
    sent.bytes = sent.bytes[:-1]
    with pytest.raises(LancerError, match="damaged on its way to this worker"):
        sent.render()
    assert not worker._scenes


def test_a_failed_session_is_replaced(monkeypatch):
    """When a range fails, as for want of memory, the library's session only can be read."""
    failed = []

    class FailsOnce(Session):
        def render_ranges(self, ranges):
            if not failed:
                failed.append(self)
                raise LancerError("out of memory")
            super().render_ranges(ranges)

        def clear(self):
            if self in failed:
                raise LancerError("session: a range failed; its film can only be read")
            super().clear()

    monkeypatch.setattr(worker, "Session", FailsOnce)
    sent = Sent(room())
    with pytest.raises(LancerError, match="out of memory"):
        sent.render()
    assert sent.render().part.nbytes > 0 and sent.asked == 1


def test_a_join_tells_all_makers_and_the_seconds():
    sent = Sent(room())
    made = [sent.render(number, 1)._replace(by=(f"worker {number % 2}",), seconds=4.0) for number in (3, 0, 2)]
    joined = worker.join(*made)
    assert joined.by == ("worker 1", "worker 0") and joined.seconds >= 12.0
    assert joined.instruction_set == made[0].instruction_set


def test_a_wrong_part_of_a_join_names_its_maker():
    sent, other = Sent(room()), Sent(room(seed=3))
    right, wrong = sent.render(0, 1), other.render(1, 1)._replace(by=("that one",))
    with pytest.raises(worker.WrongPart, match="^part: its setting seed is 3, the session's 0$") as raised:
        worker.join(right, wrong)
    # The error goes from one machine to another.
    again = pickle.loads(pickle.dumps(raised.value))
    for error in (raised.value, again):
        assert error.by == ("that one",) and str(error) == "part: its setting seed is 3, the session's 0"
