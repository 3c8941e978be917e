"""Unsupported features give a message and a plain stand-in, never black and never without a message."""

import blenders
import pytest
from blenders import MODULE, PROGRAM


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_a_value_stands_in_by_its_constant_and_a_colour_by_grey(which, tmp_path):
    got = blenders.run(which, tmp_path, "stand_in_cases", "unknown_sources")
    (lobe,) = got["lobes"]
    assert lobe["roughness"] == pytest.approx(0.37)
    assert lobe["color"] == [0.5, 0.5, 0.5]
    assert len(got["messages"]) == 2
    assert any("input 'Roughness'" in text and "the constant 0.37 is used" in text for text in got["messages"])
    assert any("input 'Color'" in text and "mid-grey is used" in text for text in got["messages"])


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_attributes_that_cycles_computes_are_told(which, tmp_path):
    """Cycles before 4.5 has a name for the normals of faces."""
    got = blenders.run(which, tmp_path, "stand_in_cases", "computed_attributes")
    got.pop("console")
    told = {name for name, messages in got.items() if any("(Attribute), which is not supported" in text for text in messages)}
    assert told == {"N", "Map.tangent"} | ({"Ng"} if which == PROGRAM else set())
    assert all(not messages for name, messages in got.items() if name not in told)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_attributes_of_instances_that_blender_hides_are_told(which, tmp_path):
    """Before 4.5 Blender exposes none; later the instancer must be known."""
    got = blenders.run(which, tmp_path, "stand_in_cases", "attributes_of_instances")
    got.pop("console")
    hidden = {"two below vertices"} | ({"nodes", "group"} if which == PROGRAM else set())
    said = "this Blender does not expose" if which == PROGRAM else "Blender does not expose the attributes of its instances'"
    for name, messages in got.items():
        assert len(messages) == (name in hidden) and all(said in text for text in messages), (name, messages)


def test_a_lamp_among_instances_of_one_id_is_told(tmp_path):
    """Blender gives instances that repeat an id random ones, which tell them apart only where all are seen."""
    emissions, messages = blenders.run(MODULE, tmp_path, "stand_in_cases", "lamps_of_equal_ids")
    plain, placed = emissions
    assert len(messages) == 1 and "does not expose which of its instances with one id shows a lamp" in messages[0]
    assert plain == 0.0 and placed > 0.0


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_light_between_facets_is_told_where_it_is_computed_differently(which, tmp_path):
    got = blenders.run(which, tmp_path, "stand_in_cases", "facets")
    got.pop("console")
    assert got.pop("BsdfRefraction") == []
    for kind, messages in got.items():
        if which == MODULE:
            assert messages == []
        else:
            (text,) = messages
            assert text.startswith(f"material '{kind}'") and "Multiscatter GGX is computed as in Blender 4" in text


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_where_samplers_of_cycles_weigh_a_sky_otherwise(which, tmp_path):
    got = blenders.run(which, tmp_path, "stand_in_cases", "samplers")
    got.pop("console")
    lacquer = "Ashikhmin-Shirley follows its model, under a sky a rough surface is darker at grazing angles than in Cycles"
    brushed = "anisotropic Beckmann follows its model, under a sky the surface is darker or brighter than in Cycles 3"
    coated = "Clearcoat leaves the base its light, which is brighter under a sky than in Cycles 3"
    said = {"rough lacquer": lacquer, "varying lacquer": lacquer}
    if which == PROGRAM:
        said |= {"brushed": brushed, "varying brushed": brushed, "coated": coated, "varying coat": coated}
    for name, messages in got.items():
        assert len(messages) == (name in said) and all(text.endswith(said[name]) for text in messages), (name, messages)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_what_stands_beside_transparent(which, tmp_path):
    got = blenders.run(which, tmp_path, "stand_in_cases", "clear_beside")
    got.pop("console")
    for name, material in got.items():
        told = ["which Cycles 3 mixes with theirs" in text for text in material["messages"]]
        assert told == ([True] if which == PROGRAM and name in ("leaf", "frosted") else []), name
    # The weight stays separate: rough diffuse is not linear in its colour.
    (clay,) = got["clay"]["lobes"]
    assert clay["color"] == pytest.approx([0.5, 0.25, 0.125]) and clay["weight"] == pytest.approx([0.5] * 3)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_scripts_have_no_effect_where_cycles_runs_none(which, tmp_path):
    got = blenders.run(which, tmp_path, "stand_in_cases", "scripts")
    (ignored, (hint,)), (unknown, (message,)) = got["False"], got["True"]
    assert ignored == pytest.approx([0.9, 0.3, 0.1]) and unknown == [0.5] * 3
    assert hint.endswith("node 'Script': Script has no effect without Open Shading Language, as in Cycles")
    assert "is linked to 'Script' (Script), which is not supported, mid-grey is used" in message
