"""Graphs that fold: the same values by fewer nodes."""

import blenders
import pytest
from blenders import MODULE


@pytest.fixture
def case(tmp_path):
    return lambda name, *arguments: blenders.run(MODULE, tmp_path, "fold_cases", name, *arguments)


def test_folded_programs_give_the_same_bits(case):
    """Of every float, infinities and NaN too."""
    got = case("programs", 60)
    assert got["differ"] == [] and got["not finite"] > 100
    assert got["folded"] < 0.9 * got["plain"]


def test_what_cycles_leaves_out_gives_the_same_numbers(case):
    """Powers of and by 1, sums with 0, mixes by 0 and 1 ...: all finite numbers are those of the node that is left out."""
    got = case("as_cycles")
    assert got["rules"] > 60 and got["differ"] == []
