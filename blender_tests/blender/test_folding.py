"""Graphs that fold: the same values by fewer nodes."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

both = pytest.mark.parametrize("which", [MODULE, PROGRAM])


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


@both
def test_of_60_nodes_13_are_left(tmp_path, which):
    """The panel tells them, and the export leaves them; programs of random nodes show that results keep their bits."""
    got = blenders.run(which, tmp_path, "fold_cases", "sixty")
    assert (got["total"], got["left"], got["first"]) == (60, 13, "Voronoi Texture")
    plain, folded = got["nodes"]
    assert folded < plain / 2


@both
def test_nodes_of_groups_count_as_often_as_they_are_used(tmp_path, which):
    """Both uses give the same number: the nodes of the one that is read first are left."""
    got = blenders.run(which, tmp_path, "fold_cases", "groups")
    assert (got["total"], got["left"]) == (6, 2)
    assert set(got["names"]) == {"Use 0 / Checker Texture", "Use 0 / Math"}
