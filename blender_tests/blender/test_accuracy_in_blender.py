"""Accuracy of F12 renders: the end of a render, its reported error, and equal figures in file, statistics and pass."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

both = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name: blenders.run(which, tmp_path, "accuracy_cases", name)


def _power_of_two(number):
    return number > 0 and number & (number - 1) == 0


@both
def test_the_error_is_told(case):
    got = case("told")
    numbers, stamped = got["numbers"], got["stamped"]
    assert 0.0 < numbers["error_low"] < numbers["error"] < numbers["error_high"] < 1.0
    assert numbers["error_cannot_exclude"] > 0.0
    assert numbers["ended_by"] == "samples" and numbers["samples"] == numbers["samples_most"] == 64
    # Metadata has six digits.
    for name in ("error", "error_low", "error_high", "error_cannot_exclude"):
        assert float(stamped[name]) == pytest.approx(numbers[name], rel=1e-5)
    assert stamped["samples"] == "64" and stamped["seed"] == "0" and stamped["ended_by"] == "samples"
    assert "max_bounces 12" in stamped["settings"] and "lambert" in stamped["features"] and stamped["version"]
    assert float(stamped["seconds"]) == pytest.approx(numbers["seconds"], abs=1e-3)
    assert got["layers"] == ["ViewLayer"]
    # The pass averages the same variances over other windows: its figure is the same within 1.5 times the interval.
    assert numbers["error_low"] / 1.5 < got["by bars"] < numbers["error_high"] * 1.5
    assert got["least bar"] >= 0.0
    assert "Lancer: error " in got["console"] and "with 95 % confidence between" in got["console"]


@both
def test_one_sample_tells_no_error(case):
    got = case("one_sample")
    assert got["numbers"]["error"] == float("inf") and got["stamped"]["error"] == "inf"
    assert "error unknown" in got["console"]


@both
def test_a_target_ends_the_render(case):
    got = case("target")
    met, missed = got["renders"]
    (line,) = (line for line in got["console"].splitlines() if "Info: " in line and "was not reached" in line)
    assert "0.0001 % was not reached: " in line and line.endswith(" Samples")
    numbers = met["numbers"]
    assert numbers["ended_by"] == "target error"
    assert numbers["error_high"] + numbers["error_cannot_exclude"] <= 0.05 * 1.0001
    assert _power_of_two(numbers["samples"]) and _power_of_two(numbers["samples_most"])
    assert "target_error 0.05" in met["stamped"]["settings"]
    assert missed["numbers"]["ended_by"] == "samples"
    assert missed["numbers"]["samples"] == missed["numbers"]["samples_most"] == 100


@both
def test_each_view_layer_has_its_error(case):
    got = case("layers")
    for name in ("Front", "Back"):
        assert f"Info: Lancer: view layer '{name}': error " in got["console"], got["console"]


@both
def test_time_ends_the_render_on_powers_of_two(case):
    numbers = case("limit")["numbers"]
    assert numbers["ended_by"] == "time limit"
    assert _power_of_two(numbers["samples"]) and _power_of_two(numbers["samples_most"])
    assert numbers["samples_most"] <= 2 * numbers["samples"] or numbers["samples"] >= 64


@both
def test_biases_are_declared(case):
    got = case("biases")
    assert got["numbers"]["error_clipped"] > 0.0 and got["numbers"]["error_missing"] > 0.0
    assert "clamping has removed" in got["console"] and "light beyond 1 bounces is left out" in got["console"]


@both
def test_esc_leaves_an_account(case):
    got = case("broken_off")
    assert got["numbers"]["ended_by"] == got["stamped"]["ended_by"] == "cancelled"
    assert got["lines"][0].startswith("error ") and got["lines"][0].endswith(" s, cancelled")
