"""Cases that share a Blender: each starts afresh, and one that fails, crashes or hangs costs no other."""

import blender_server
import blenders
import pytest
from blenders import MODULE, PROGRAM


@pytest.fixture(params=[MODULE, PROGRAM])
def case(request, tmp_path):
    return lambda name, **how: blenders.attempt(request.param, tmp_path, "server_cases", name, **how)


def test_nothing_of_a_case_reaches_the_next(case):
    code, said, value = case("leave")
    assert code == 0 and value is True, said
    assert case("look")[2] == []


def test_cases_share_a_process_and_may_have_their_own(case):
    shared = case("process")[2]
    assert case("process")[2] == shared
    assert case("process", alone=True)[2] != shared and case("process", LANCER_OTHER="1")[2] != shared


@pytest.mark.parametrize("end, said", [("fails", "this case fails"), ("aborts", "")])
def test_a_bad_end_is_that_of_its_case_alone(case, end, said):
    before = case("process")[2]
    code, output, value = case(end)
    assert code != 0 and value is None and said in output
    code, _, after = case("process")
    assert code == 0 and after != before


def test_a_case_that_hangs_is_ended(tmp_path, monkeypatch):
    blenders.run(MODULE, tmp_path, "server_cases", "process")
    monkeypatch.setattr(blender_server, "LONGEST", 1)
    code, _, value = blenders.attempt(MODULE, tmp_path, "server_cases", "hangs")
    assert code != 0 and value is None
    monkeypatch.undo()
    assert blenders.run(MODULE, tmp_path, "server_cases", "process")
