"""Procedural textures and curves: the core's nodes against Cycles of the same Blender, at equal points."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

# The side of each setting's square in pixels.
SIDE = 24
SHARE = 0.999  # of the points are within a thousandth of the range of Cycles' values


def _judged(which, folder, name, least, cases="procedural_cases"):
    got = blenders.run(which, folder, cases, name, SIDE)
    got.pop("console")
    assert len(got) >= least
    assert all(points == SIDE * SIDE for points, *_ in got.values())
    # Few settings may be constant; some of noise without octaves are.
    flat = [setting for setting, (_, span, *_) in got.items() if span <= 1e-3]
    assert len(flat) <= len(got) / 5, flat
    wrong = {setting: numbers for setting, numbers in got.items() if numbers[2] < SHARE}
    assert not wrong


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize(
    "name, least",
    [
        ("noise", 19), ("voronoi", 100), ("gradient", 7), ("curves", 30), ("color_models", 11),
    ],
)  # fmt: skip
def test_procedural_nodes(which, name, least, tmp_path):
    _judged(which, tmp_path, name, least)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize("name, least", [("waves", 48), ("magic", 44), ("cells", 34), ("white_noise", 8), ("spectrum", 4)])
def test_patterns(which, name, least, tmp_path):
    _judged(which, tmp_path, name, least, cases="pattern_cases")


def test_musgrave(tmp_path):
    """The node of Blender before 4.1."""
    _judged(PROGRAM, tmp_path, "musgrave", 80)


@pytest.mark.parametrize("name, least", [("gabor", 18), ("radial_tiling", 56)])
def test_newer_nodes(name, least, tmp_path):
    """The nodes that Blender 3 does not have."""
    _judged(MODULE, tmp_path, name, least, cases="pattern_cases")


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize("name, least", [("analytic", 40), ("scattering", 20), ("suns", 16)])
def test_sky(which, name, least, tmp_path):
    """The Sky Texture in all directions. Preetham's sky of a sun below the horizon is black in part."""
    _judged(which, tmp_path, name, least, cases="sky_cases")
