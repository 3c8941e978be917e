"""Zones, closures, bundles and menus: Blender resolves them, and messages name the user's nodes all the same."""

import blenders
import pytest
from blenders import MODULE


@pytest.fixture
def case(tmp_path):
    return lambda name: blenders.run(MODULE, tmp_path, "zone_cases", name)


def test_messages_name_the_nodes_of_the_user(case):
    """Without an image the colour does not depend on the iterations before."""
    got = case("names")
    said = "ode '2_Wood': has no image, magenta is used"
    assert got["messages"] == [f"material 'painted' on object 'object', n{said}"]
    assert got["panel"][-1] == f"N{said}"


def test_iterations_follow_their_driver_and_no_user_is_left(case):
    """Math adds 0.5 to the power in each iteration."""
    got = case("driven")
    assert got["emission"] == {"2": [1.0] * 3, "5": [2.5] * 3}
    assert got["users"] == got["users after"] and got["messages"] == []


def test_a_group_of_the_course_beside_a_zone_is_told(case):
    got = case("course_models")
    assert got["alone"] == {"lobes": ["LAMBERT", "PHONG"], "messages": []}
    (text,) = got["beside"]["messages"]
    assert f"the nodes inside the group '{got['group']}' are shown" in text and "PHONG" not in got["beside"]["lobes"]


def test_only_trees_with_zones_are_resolved(case):
    assert case("plain") == {"before": True, "after": False, "console": ""}


def test_random_trees_with_zones_never_fail(tmp_path):
    """Zones whose ends, items and links make no sense, too."""
    got = blenders.run(MODULE, tmp_path, "material_fuzz_cases", "fuzz", 60, True)
    assert got["kinds"] > 90 and got["lobes"] > 2 and got["nodes"] > 10
    assert got["backward"] == got["wild"] == 0
