"""Many renders in one process: the memory after the last render equals that after the tenth."""

import os
import subprocess
import sys

import blenders
import pytest
from blenders import MODULE
from conftest import HERE

FEW, MANY = 30, 300
# Greatest relative growth of the process after its tenth render.
MOST_GROWTH = 0.01

# Renders a rich snapshot repeatedly, every second time with a round of refinement, and prints the memory after the tenth and
# the last render.
LOOP = """
import sys
sys.path[:0] = sys.argv[2:]
import conftest, dataclasses, gc
from addon.bindings.abi import Pass
from addon.bindings.session import Session
from memory_now import held
from rich_snapshot import rich
held_after = []
even = rich()
refined = dataclasses.replace(even, settings=dataclasses.replace(even.settings, samples=4, target_error=0.01))
for number in range(int(sys.argv[1])):
    with Session.upload(refined if number % 2 else even) as session:
        assert session.render_all(2)
        if session.settings.refines:
            assert session.refine()
            while not session.wait(0.05).finished:
                pass
        for which in Pass:
            session.read(which)
        session.error(), session.statistics(), session.messages(), session.debug_sample(1, 1, 0)
    gc.collect()
    held_after.append(held())
print(held_after[9]["resident"], held_after[-1]["resident"], held_after[9]["given"], held_after[-1]["given"])
"""


def through_bindings(renders):
    """Return the memory after the tenth and after the last render, resident and allocated bytes."""
    places = [HERE, os.path.join(HERE, "helpers"), os.path.join(HERE, "blender", "in_blender")]
    command = [sys.executable, "-c", LOOP, str(renders), *places]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-3000:]
    resident, resident_end, given, given_end = map(int, done.stdout.split())
    return (resident, given), (resident_end, given_end)


def assert_steady(renders):
    (resident, given), (resident_end, given_end) = through_bindings(renders)
    assert given_end <= given * (1.0 + MOST_GROWTH), (given, given_end)
    assert resident_end <= resident * (1.0 + MOST_GROWTH), (resident, resident_end)


def test_some_renders_leave_nothing():
    assert_steady(FEW)


@pytest.mark.slow
def test_many_renders_leave_nothing():
    assert_steady(MANY)


def assert_steady_in_blender(tmp_path, renders):
    """Subtract Blender's own growth per render, measured with an empty engine."""
    got = {engine: blenders.run(MODULE, tmp_path, "memory_cases", "renders", engine, renders) for engine in ("LANCER", "EMPTY")}
    for kind in ("given", "resident"):
        tenth, last = got["LANCER"][kind]
        own = last - tenth - max(0, got["EMPTY"][kind][1] - got["EMPTY"][kind][0])
        assert own <= tenth * MOST_GROWTH, (kind, got["LANCER"][kind], got["EMPTY"][kind])


def test_some_pictures_leave_nothing(tmp_path):
    assert_steady_in_blender(tmp_path, FEW)


@pytest.mark.slow
def test_many_pictures_leave_nothing(tmp_path):
    assert_steady_in_blender(tmp_path, MANY)
