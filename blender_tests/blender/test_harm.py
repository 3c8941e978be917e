"""The order of messages, their counts and their severities."""

import dataclasses
import math

import numpy as np
from check_scenes import LAMP, placed, scene, sheet

from addon.bindings.session import Session
from addon.messages.messages import Messages
from addon.messages.severity import Severity


def test_what_hurts_most_comes_first():
    messages = Messages()
    messages.add("a setting differs")
    messages.add("a hint", severity=Severity.HINT)
    messages.add("an object is left out", severity=Severity.LEFT_OUT)
    messages.add("a picture is missing", severity=Severity.WRONG)
    messages.add("another setting differs", severity=Severity.DIFFERENT)
    messages.add("an object is left out", severity=Severity.LEFT_OUT)
    messages.add("no picture", severity=Severity.FAILED)
    messages.add("slow", severity=Severity.WASTE)
    assert messages.lines() == list(messages) == [
        "no picture", "a picture is missing", "an object is left out (2 times)", "a setting differs",
        "another setting differs", "slow", "a hint",
    ]  # fmt: skip


def test_what_is_told_twice_keeps_its_greatest_harm_and_its_key():
    messages = Messages()
    messages.add("the same", "node:Bevel", Severity.HINT)
    messages.add("the same", severity=Severity.WRONG)
    (message,) = messages.told()
    assert message == ("the same", "node:Bevel", Severity.WRONG, 2)
    assert messages.missing() == {"node:Bevel": 2}


def test_merging_gives_what_is_new():
    messages = Messages(["known"])
    more = Messages(["known", "new"], Severity.WRONG)
    more.add("new", severity=Severity.WRONG)
    assert messages.merge(more).told() == [("new", "", Severity.WRONG, 2)]
    assert messages.told() == [("known", "", Severity.WRONG, 2), ("new", "", Severity.WRONG, 2)]
    assert len(messages.merge(more)) == 0


def test_messages_of_the_library_have_their_harm():
    """Messages of the library: faces without area are a hint, an object left out is LEFT_OUT."""
    flat = dataclasses.replace(sheet(), triangles=np.array([[0, 1, 2], [0, 1, 1]], np.uint32))
    dark = dataclasses.replace(LAMP, matrix=np.full((3, 4), np.nan))
    things = [placed(), placed(matrix=np.full((4, 4), np.nan))]
    with Session.upload(scene(things, [flat], lights=(dark,))) as session:
        told = Messages.of_library(session.messages()).told()
    assert [message.severity for message in told] == [Severity.LEFT_OUT, Severity.LEFT_OUT, Severity.HINT], told
    assert sorted(message.text.split("'")[0] for message in told[:2]) == ["light ", "object "]
    assert "without area" in told[2].text


def test_a_colour_that_is_none_is_replaced_channel_by_channel():
    messages = Messages()
    assert messages.color((0.5, 0.0, 2.0), "it", "colour", 1.0) == (0.5, 0.0, 2.0) and not len(messages)
    assert messages.color((math.inf, -1.0, math.nan), "it", "colour", 1.0) == (1.0, 0.0, 1.0)
    assert len(messages) == 1


def test_a_number_out_of_its_range_is_told():
    """Half a step of single precision beyond a limit is rounding; more is told."""
    messages = Messages()
    limit = float(np.float32(math.pi))
    assert messages.number(limit, "it", "angle", 0.0, 0.0, math.pi) == math.pi and not len(messages)
    assert messages.number(4.0, "it", "angle", 0.0, 0.0, 3.0) == 3.0
    assert messages.number(math.nan, "it", "angle", 1.0, 0.0, 3.0) == 1.0
    assert messages.lines() == ["it: angle is 4, 3 is used", "it: angle is nan, 1 is used"]
