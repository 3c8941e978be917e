"""Small rules of Cycles that the export follows, and folded values, against Cycles of the same Blender."""

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM

# The pictures are constant: the tolerance is the rounding of a dozen products in single precision, 2^-24 each.
LIMIT = 1e-6
# Cycles shows values plus 128, with a resolution of 2^-17 = 7.6e-6, and computes numbers up to 8 in single precision, whose
# rounding of 2^-24 adds up to 5e-6 in some ten steps.
VALUE_LIMIT = 2e-5


@pytest.fixture(params=[MODULE, PROGRAM])
def case(request, tmp_path):
    def run(name, *arguments):
        got = blenders.run(request.param, tmp_path, "rule_cases", name, *arguments)
        if isinstance(got, dict):
            got.pop("console")
        return got

    return run


def differences(got, limit=LIMIT):
    """Return the entries of {name: (Cycles' colour, ours)} that differ."""
    wrong = {}
    for name, (theirs, ours) in got.items():
        if (np.abs(np.subtract(theirs, ours)) > limit * np.maximum(1.0, np.abs(theirs))).any():
            wrong[name] = (theirs, ours)
    return wrong


@pytest.mark.parametrize("name", ["animated_world", "animated_override"])
def test_animations(case, name):
    got = dict(enumerate(case(name)))
    assert not differences(got)
    # Frame n is n times as bright as the first.
    assert [got[frame][0][0] for frame in range(3)] == pytest.approx([1.0, 2.0, 3.0])


@pytest.mark.parametrize("name", ["outputs", "filters", "instanced_lamps", "axes", "mapping_types", "names"])
def test_rules(case, name):
    got = case(name)
    assert not differences(got)
    # Some scenes are lit and they differ, except for lamps that Blender 4.2 shows anyway.
    shown = {tuple(np.round(theirs, 4)) for theirs, _ in got.values()}
    assert any(max(color[:3]) > 0.1 for color in shown) and (len(shown) > 1 or name == "instanced_lamps")


@pytest.mark.parametrize("name", ["glow", "glowing_lamp"])
def test_temperatures(case, name):
    """The polynomial's error is at most 8e-4 of Blender's table, which is discontinuous between its pieces."""
    assert not differences(case(name), 8e-4)


def test_one_attribute_name_is_cycles_own(case):
    """The name means Generated coordinates; a pixel covers 0.45 m, less than 1/40, of the card's 20."""
    theirs, ours = case("names", "generated")["generated"]
    assert theirs[:2] != pytest.approx([0.25, 0.5], abs=0.025)
    assert ours == pytest.approx(theirs, abs=0.025)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize("name, least", [("mathematics", 70), ("vectors", 55), ("colours", 70), ("links", 12)])
def test_folded_values(which, name, least, tmp_path):
    """Value nodes with constant inputs."""
    got = blenders.run(which, tmp_path, "value_cases", name)
    got.pop("console")
    assert len(got) >= least
    wrong = {what: pair for what, pair in got.items() if np.abs(np.subtract(*pair)).max() > VALUE_LIMIT}
    assert not wrong
