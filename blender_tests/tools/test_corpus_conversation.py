"""Processes of `make corpus`: each answers, or the reason of its end is reported."""

import sys
import textwrap

import pytest

from tools.harness.conversation import Conversation, Ended

WORKER = """
    import json, os, signal, sys, time
    answers = os.fdopen(int(sys.argv[-1]), "w")
    for line in sys.stdin:
        request = json.loads(line)
        print("what libraries print")
        if request["task"] == "kill":
            os.kill(os.getpid(), signal.SIGSEGV)
        if request["task"] == "leave":
            sys.exit(3)
        if request["task"] == "sleep":
            time.sleep(1000)
        if request["task"] == "eat":
            eaten = b"x" * 400_000_000
            time.sleep(1000)
        answer = {"error": "no such thing"} if request["task"] == "raise" else {"said": request["word"] * 100_000}
        answers.write(json.dumps(answer) + "\\n")
        answers.flush()
"""


@pytest.fixture
def talk(tmp_path):
    script = tmp_path / "worker.py"
    script.write_text(textwrap.dedent(WORKER))
    with Conversation([sys.executable, script], tmp_path / "log") as conversation:
        yield conversation


def end_of(talk, task, seconds=60.0, bytes_=4e9):
    with pytest.raises(Ended) as caught:
        talk.ask(task, seconds, bytes_, word="a")
    return caught.value.kind, str(caught.value)


def test_answers_are_whole(talk):
    """They are longer than one read of a pipe."""
    for word in ("a", "b"):
        assert talk.ask("say", 60.0, 4e9, word=word) == {"said": word * 100_000}


def test_an_error_ends_nothing(talk):
    assert end_of(talk, "raise") == ("error", "no such thing")
    assert talk.ask("say", 60.0, 4e9, word="c")["said"][0] == "c"


def test_a_signal_is_named(talk):
    assert end_of(talk, "kill") == ("crash", "ended by SIGSEGV")
    # A process that has ended reports the same again.
    assert end_of(talk, "say") == ("crash", "ended by SIGSEGV")


def test_an_exit_is_a_crash(talk):
    assert end_of(talk, "leave") == ("crash", "ended by exit code 3")


def test_a_hang_ends_with_its_time(talk):
    assert end_of(talk, "sleep", seconds=0.3) == ("timeout", "not done after 0 s")
    assert talk.process.poll() is not None


def test_too_much_memory_ends_it(talk):
    assert end_of(talk, "eat", bytes_=200e6) == ("memory", "needs more than 0.2 GB of memory")
    assert talk.process.poll() is not None
