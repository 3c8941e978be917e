"""Measure Speed and Accuracy in Blender: its forecasts, its effect on the file, and when it is old."""

import blenders
import pytest
from blenders import MODULE, PROGRAM


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_each_quality_has_its_seconds_and_error(which, tmp_path):
    got = blenders.run(which, tmp_path, "quality_cases", "measured")
    assert got["result"] == ["FINISHED"] and got["changed"] == []
    told = got["told"]
    assert list(told) == ["Draft", "Good", "Final", "As set"]
    for low, value, high, error_low, error, error_high in told.values():
        assert 0.0 < low <= value <= high and 0.0 < error_low <= error <= error_high
    # The expected error is below a preset's target, and each preset takes longer than the one before.
    assert [told[name][4] <= limit for name, limit in (("Draft", 0.1), ("Good", 0.03), ("Final", 0.01))] == [True] * 3
    assert told["Draft"][1] <= told["Good"][1] <= told["Final"][1]
    assert got["lines"][0].startswith("Draft: ") and got["lines"][-1].startswith("Classic, 64 samples: about ")
    assert all(f"Info: Lancer: {line}" in got["console"] for line in got["lines"])
    # The interval of the render and that of the forecast overlap.
    _, _, low, high = got["rendered"]
    assert told["As set"][3] <= high and low <= told["As set"][5]
    # Twice the samples take longer, and four times the pixels longer still.
    start = told["As set"][1]
    assert start < got["more"][1] < got["larger"][1] and got["more"][4] < told["As set"][4]
    old = got["old"]
    assert [name for name in old if old[name]] == ["other bounces", "other clamp", "moved"]
    assert got["left"] == 0


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_what_cannot_be_told_is_not_told(which, tmp_path):
    assert {
        "sure": "about 60 s",
        "wide": "about 60 s, 20 s to 5.0 min",
        "untold": "the time is unknown",
        "short": "at most 9.0 s",
    } == {name: text for name, text in blenders.run(which, tmp_path, "quality_cases", "words").items() if name != "console"}


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_a_forecast_ends_with_the_samples(which, tmp_path):
    lines = blenders.run(which, tmp_path, "quality_cases", "missed")
    (line,) = (line for line in lines if line.startswith("As set"))
    assert line.endswith("; 16 samples end it above its 0.01 %"), lines


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_a_new_scene_is_good_and_an_old_file_as_it_was(which, tmp_path):
    got = blenders.run(which, tmp_path, "quality_cases", "defaults")
    # Debian builds Blender without the denoiser.
    denoises = which == MODULE
    new = ["GOOD", pytest.approx(0.03), 8192, denoises, 12]
    assert got["new"] == got["saved"] == got["other engine"] == new
    assert got["old"] == ["CUSTOM", 0.0, 256, False, 10]
    assert got["old and changed"] == ["FINAL", pytest.approx(0.01), 65536, True, 3]
    # The default scene has no message, and ends by itself.
    assert got["messages"] == [] and got["ended_by"] == "target error"
