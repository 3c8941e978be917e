"""Switches that become one number or flag of the snapshot; Blender stores single precision."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    def run(name):
        got = blenders.run(which, tmp_path, "switch_cases", name)
        got.pop("console")
        return got

    return run


def near(value):
    return pytest.approx(value, rel=1e-6, abs=1e-6)


def test_shadow_terminator(case):
    assert case("terminators") == {"as it comes": near(0.1), "none": 0.0, "wide": 0.75}


def test_flags_of_materials(case):
    got = case("flags")
    # Before Blender 4 bumps are always corrected.
    assert got == {
        "has correction": got["has correction"],
        "plain": [],
        "bare": ["NO_BUMP_CORRECTION"] if got["has correction"] else [],
        "dull": ["NOT_A_LIGHT"],
        "solid": ["OPAQUE_SHADOWS"],
    }


def test_weak_emission_is_no_light(case):
    got = case("weak_lights")
    dim = not got.pop("decides")
    assert got == {"dim": dim, "bright": True, "textured": dim, "strong texture": True, "asked for": True}


def test_overrides_of_the_view_layer(case):
    got = case("overrides")
    assert got["materials"] == ["clay"] * len(got["materials"]) and got["materials"] and got["samples"] == 9
    assert got["without"] == [["default_surface", "own"], 4]
    if got["has world"]:
        # The mist stays that of the scene's world, as in Cycles.
        assert got["radiance"] == near([0.0, 0.5, 0.0]) and got["mist"] == 5.0
    else:
        assert got["radiance"] == near([1.0, 0.0, 0.0])


def test_normal_maps_take_the_unit_normal(case):
    """From Blender 5.2 on."""
    got = case("normal_maps")
    assert got["flags"] == [int(got["version"] >= [5, 2])]


def test_panoramas(case):
    got = case("cameras")
    version = got.pop("version")
    # The image of 2 x 1 covers the sensor's width, and half of that in height.
    expected = {
        "EQUIRECTANGULAR": ("EQUIRECTANGULAR", [-0.5, 0.25, -2.0, 1.5]),
        "FISHEYE_EQUIDISTANT": ("FISHEYE_EQUIDISTANT", [2.5]),
        "FISHEYE_EQUISOLID": ("FISHEYE_EQUISOLID", [8.0, 2.0, 32.0, 16.0]),
        "FISHEYE_LENS_POLYNOMIAL": ("FISHEYE_POLYNOMIAL", [1.5, 32.0, 16.0, 0.25, 0.5, 0.75, 1.0, 1.25]),
        "MIRRORBALL": ("MIRROR_BALL", []),
        "CENTRAL_CYLINDRICAL": ("CYLINDRICAL", [-1.0, 2.0, -0.5, 0.75, 1.25]),
    }
    # The newest projection is missing in old versions.
    if "CENTRAL_CYLINDRICAL" not in got:
        assert version < [4, 4]
        expected.pop("CENTRAL_CYLINDRICAL")
    assert set(got) == set(expected)
    for name, (kind, numbers) in expected.items():
        assert got[name]["kind"] == kind
        assert got[name]["panorama"] == near(numbers + [0.0] * (8 - len(numbers))), name
        assert got[name]["window"] == near([0.125, 1.125, -0.25, 0.75]), name
        assert got[name]["aperture"] == near([5, 0.5, 2.0]), name
        # Half of 50 mm over f/0.5.
        assert got[name]["lens"] == near([0.05, 2.0]), name
