"""Cycles' own settings: all of them are accounted for, and one click takes them over."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

from addon.export.controls import CONTROLS
from addon.export.cycles_properties import PROPERTIES, Fate


@pytest.fixture(scope="module", params=[MODULE, PROGRAM])
def found(request, tmp_path_factory):
    return blenders.run(request.param, tmp_path_factory.mktemp("cycles"), "cycles_setting_cases", "settings")


def test_every_property_of_cycles_is_listed_and_told_where_it_says_so(found):
    got = found["told"]
    listed = {f"{kind}.{name}" for kind, names in PROPERTIES.items() for name in names}
    there = {f"{kind}.{name}" for kind, names in got["groups"].items() for name in names}
    # Types and names that the add-on has are read, or this would pass on nothing.
    assert len(there) > 100 and set(got["groups"]) <= set(PROPERTIES)
    assert there <= listed, there - listed
    told = {
        f"{kind}.{name}"
        for kind, names in PROPERTIES.items()
        for name, entry in names.items()
        if entry.fate == Fate.TOLD and tuple(got["version"]) < entry.before
    }
    assert set(got["added"]) == told & there
    silent = {name for name, lines in got["added"].items() if not lines}
    assert not silent


def test_the_list_and_the_controls_agree_on_what_is_followed():
    followed = {
        (kind, name) for kind, names in PROPERTIES.items() for name, entry in names.items() if entry.fate == Fate.FOLLOWED
    }
    assert followed == {(entry.owner, name) for entry in CONTROLS for name in entry.names if entry.owner in PROPERTIES}


def test_every_property_has_a_reason():
    assert all(entry.reason for names in PROPERTIES.values() for entry in names.values())


def test_glass_is_that_of_cycles_until_lancers_own_is_set(found):
    got = found["glass"]
    # The core's roughness is the square of the setting.
    assert got["start"] == ["CyclesRenderSettings", False, 0.01]
    assert got["Cycles'"] == ["CyclesRenderSettings", True, 0.25]
    assert got["own"] == ["LancerSceneSettings", False, 0.01]


def test_settings_are_taken_over_and_the_button_goes(found):
    got = found["take_over"]
    assert got["result"] == ["FINISHED"] and got["kept"]
    wanted = {
        "samples": 77, "target_error": 0.06, "time_limit": 9.0, "seed": 5, "use_animated_seed": True, "max_bounces": 7,
        # A limit of glossy bounces beyond the total has no effect.
        "diffuse_bounces": 2, "glossy_bounces": 1024, "transmission_bounces": 3, "filter_glossy": 0.5,
        # Lancer's own limit.
        "transparent_bounces": 1023, "clamp_indirect": 3.5, "pixel_filter": "BLACKMAN_HARRIS",
        # The Blackman-Harris window that is as wide as Cycles' Gaussian, by their standard deviations.
        "filter_width": round(2.0 * 0.25 / 0.27702, 6), "preview_samples": 33, "use_denoising": got["denoises"],
        "use_preview_denoising": False,
    }  # fmt: skip
    for name, value in wanted.items():
        # Single precision keeps seven digits.
        assert got["taken"][name] == (pytest.approx(value, rel=1e-6) if isinstance(value, float) else value), name
    # Settings that Lancer reads by itself have no copy.
    assert not got["glass"]
    assert got["left"] == got["again"] == {} and not got["poll"] and got["offered after"] == []
    button, sentence = got["offered"][0], " ".join(got["offered"][1:])
    assert button == "lancer.take_over_cycles"
    for title in ("Samples", "Target Error", "Max Bounces", "Pixel Filter", "Filter Width", "Roughness Threshold", "Seed"):
        assert title in sentence, sentence
    # Three times one over the samples.
    assert got["automatic"] == pytest.approx(3.0 / 77.0, abs=1e-6) and got["all samples"] == 0.0
    assert got["box"] == {"pixel_filter": "BOX"}


def test_taking_over_can_be_undone(found):
    assert found["undo"] == [8192, 77, 8192]


def test_without_the_cycles_addon_there_is_nothing_to_take_over(found):
    got = found["without_cycles"]
    assert not got["poll"] and got["offered"] == [] and not got["glass"]
    assert got["error"] == "scene 'Scene': the Cycles add-on is off, there are no settings to take over"
