"""Pointiness finds vertices at one place, in few steps even where many vertices have one sum of coordinates."""

import blenders
import pytest
from blenders import MODULE, PROGRAM


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_vertices_at_one_place(which, tmp_path):
    got = blenders.run(which, tmp_path, "pointiness_cases", "equals")
    assert "Warning" not in got["console"]
    assert all(got["agree"].values()), got["agree"]
    # Two for each of eight grids, whose cells hold two vertices each. Up to 400 vertices of the plane have one sum.
    assert got["steps"] == 16
