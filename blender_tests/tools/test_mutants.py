"""The list of faults stays true: each line is there once, and the tests that must fail are there."""

import re
from collections import Counter
from types import SimpleNamespace

import pytest

from tools.harness.places import ROOT
from tools.mutants import page, tests
from tools.mutants.faults import Fault, read_faults
from tools.mutants.tree import Broken

FAULTS = read_faults()
FOLDERS = {"core": ROOT / "core" / "src", "addon": ROOT / "addon"}
_GTEST = re.compile(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+), (\w+)\)", re.MULTILINE)


def texts(folder, pattern):
    return [path.read_text(encoding="utf-8") for path in sorted((ROOT / folder).glob(pattern))]


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_its_line_is_there_once(fault):
    text = (ROOT / fault.file).read_text(encoding="utf-8")
    assert fault.applied(text) != text
    assert fault.about and fault.find == fault.find.strip()
    assert bool(fault.gtest) or bool(fault.pytest)
    assert not fault.is_core or fault.switched().count(f"{fault.number:#010x}u") == 1


def test_there_are_a_hundred_and_each_changes_another_line():
    assert len(FAULTS) >= 100
    assert max(Counter((fault.file, fault.find, fault.put) for fault in FAULTS).values()) == 1


@pytest.mark.parametrize("side", FOLDERS)
def test_every_room_has_some_and_they_are_in_theirs(side):
    rooms = {path.parent.relative_to(FOLDERS[side]).parts[0] for path in FOLDERS[side].glob("*/*.*") if "__" not in str(path)}
    found = {fault.room: fault for fault in FAULTS if fault.is_core == (side == "core")}
    assert rooms - {"lib"} <= set(found)
    for fault in FAULTS:
        if fault.is_core == (side == "core") and fault.room in rooms:
            assert (ROOT / fault.file).relative_to(FOLDERS[side]).parts[0] == fault.room, fault.name


def test_named_tests_are_there():
    known = {f"{suite}.{name}" for text in texts("core/tests", "**/*.cpp") for suite, name in _GTEST.findall(text)}
    for fault in FAULTS:
        for name in filter(None, fault.gtest.split(":")):
            pattern = re.compile(name.replace(".", r"\.").replace("*", ".*"))
            assert any(pattern.fullmatch(one) for one in known), f"{fault.name}: {name}"
        for name in fault.pytest:
            file, *functions = name.split("::")
            text = (ROOT / "blender_tests" / file).read_text(encoding="utf-8")
            functions = [one.split("[")[0] for one in functions]
            assert all(re.search(rf"^def {one}\(", text, re.MULTILINE) for one in functions), f"{fault.name}: {name}"


FAULT = Fault("room/fault", "about", "file", find="if a > b:", put="if a < b:", gtest="A.B")


def test_a_fault_is_one_whole_line_and_keeps_its_place():
    assert FAULT.applied("x\n    if a > b:\n        pass\n") == "x\n    if a < b:\n        pass\n"


@pytest.mark.parametrize("text", ["", "if a > b:  # why\n", "if a > b:\n    if a > b:\n"])
def test_a_line_that_is_not_there_once_is_an_error(text):
    with pytest.raises(ValueError, match="room/fault"):
        FAULT.applied(text)


@pytest.mark.parametrize("line, failure", [
    ("exit 0", None),
    ("echo '[  FAILED  ] A.B (0 ms)'; exit 1", "A.B"),
    ("kill -SEGV $$", "ended by signal 11"),
    ("exit 1", Broken),
    ("echo '[  PASSED  ] 0 tests.'", Broken),
])  # fmt: skip
def test_a_test_that_fails_or_crashes_kills(tmp_path, line, failure):
    """A program that does not run its tests proves nothing."""
    program = tmp_path / "program"
    program.write_text(f"#!/bin/sh\n{line}\n")
    program.chmod(0o755)
    tree = SimpleNamespace(root=tmp_path, program=program)
    if failure is Broken:
        with pytest.raises(Broken):
            tests.failed(tree, FAULT)
    else:
        assert tests.failed(tree, FAULT) == failure


def test_the_sentence_counts_verdicts():
    rows = [{"verdict": verdict} for verdict in ("killed", "killed", "broken")]
    assert page.sentence(rows) == "3 faults: 2 killed, 0 survived, 1 broken"
