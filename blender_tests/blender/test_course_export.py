"""The course's settings in Blender's data, exported in the bpy module of this Python and in Debian's Blender 3.4.1."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name: blenders.run(which, tmp_path, "course_cases", name)


def test_polygons_come_where_classic_shades_them_flat(case):
    got = case("polygons")
    # Three, four and two triangles.
    numbers, means = got["CLASSIC"]["flat"]
    assert numbers == [0] * 3 + [1] * 4 + [2] * 2
    # Blender's face centre is the mean of the vertices; both are float sums of six numbers up to 22.
    assert [pytest.approx(mean, abs=1e-5) for mean in means] == got["blender"]
    # Triangles need no polygons, and other integrators do not request them.
    assert got["CLASSIC"]["triangle"] is None
    assert got["PATH"] == {"flat": None, "as mesh": None, "triangle": None} and got["PATH meshes"] == 2


def test_ambient_colours_have_their_switches(case):
    got = case("ambient")
    assert got["world False"] is None and got["world True"] == pytest.approx([0.25, 0.5, 0.75])
    assert got["lamp False False"] == got["lamp False True"] == [0.0, 0.0, 0.0]
    assert got["lamp True False"] == [1.0, 1.0, 1.0] and got["lamp True True"] == pytest.approx([0.5, 0.25, 0.125])
