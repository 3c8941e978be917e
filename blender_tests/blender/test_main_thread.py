"""Work run in Blender's main thread for other threads, in the bpy module of this Python and in Debian's Blender."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name: blenders.run(which, tmp_path, "thread_cases", name)


def test_another_thread_has_its_work_done_by_the_main_one(case):
    got = case("asked")
    assert got["here"] is True and got["by main"] is True
    assert got["error"] == "ZeroDivisionError"
    # Esc ends the wait; posted work is done later, cancelled work is not.
    assert got["cancelled"] == "Cancelled" and got["before"] == [] and got["done"] == ["posted"]


def test_esc_ends_the_reading_of_tiles(case):
    got = case("stopped")
    assert got["end"] == "cancelled" and got["tiles"] == 3
