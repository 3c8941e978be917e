"""Sentences about a render's accuracy: a missed target, the settings that would reach it, the view layer's name."""

import math

import pytest

from addon.bindings.snapshot import Settings
from addon.measure import render_report
from addon.measure.schedule import CANCELLED, SAMPLES, TARGET, TIME


def numbers(error, bound, ended_by=SAMPLES, samples=100, seconds=20.0, **more):
    values = {"error": error, "error_low": 0.8 * error, "error_high": 0.9 * bound, "error_cannot_exclude": 0.1 * bound}
    values |= dict.fromkeys((*render_report.BIASES, "error_missing"), 0.0)
    values |= {"ended_by": ended_by, "seconds": seconds, "denoised": ""}
    values |= {"split_lights": 1, "split_paths": 1, "target_of_denoised": True, "denoised_moved": 0.0}
    values |= {f"denoised_error{end}": math.inf for end in ("", "_low", "_high")}
    return values | {"samples": samples, "samples_most": samples, "samples_mean": float(samples)} | more


def told(values, **settings):
    return render_report.lines(values, Settings(**{"samples": 100, "target_error": 0.1, **settings}))


def test_a_target_that_was_missed_is_told_first_with_what_helps():
    # A fifth of the error requires 25 times the samples: 2500.
    first, second, *_ = told(numbers(0.25, 0.5))
    assert first == "10 % was not reached: 25 %, at most 50 %; it would take about 2500 Samples"
    assert second.startswith("error 25 %, with 95 % confidence between 20 % and 45 %")
    # The 10 s besides the samples stay 10 s.
    first, *_ = told(numbers(0.25, 0.5, TIME, 16), samples=1024, time_limit=30.0)
    assert first == "10 % was not reached: 25 %, at most 50 %; it would take a Time Limit of about 8.5 min"
    # With more time alone the limit of samples would end the render.
    first, *_ = told(numbers(0.25, 0.5, TIME, 16), samples=128, time_limit=30.0)
    assert first.endswith("it would take about 400 Samples and a Time Limit of about 8.5 min")
    # Two digits, rounded up: fewer would be too few.
    first, *_ = told(numbers(0.25, 0.333, samples=1000), samples=1000)
    assert first.endswith("about 12000 Samples")


def test_a_target_of_the_denoised_picture_needs_more():
    of_denoised = {"denoised": "a guess", "denoised_error": 0.15, "denoised_error_low": 0.1, "denoised_error_high": 0.15}
    # The noisy error does not count. Half of the error requires eight times the samples.
    first, second, third, *_ = told(numbers(0.5, 0.5, **of_denoised))
    assert first == "10 % was not reached: 15 %, at most 20 %; it would take about 800 Samples"
    assert second.startswith("denoised error 15 %, with 95 % confidence between 10 % and 15 %")
    assert third == "before denoising: error 50 %, with 95 % confidence between 40 % and 45 %"
    reached = of_denoised | {"denoised_error_high": 0.04}
    assert told(numbers(0.5, 0.5, **reached))[0].startswith("denoised error ")
    # The target may be that of the picture before denoising.
    assert told(numbers(0.5, 0.5, **reached, target_of_denoised=False))[0].startswith("10 % was not reached: 50 %")


@pytest.mark.parametrize(
    "values, settings",
    [
        (numbers(0.05, 0.09, TARGET), {}),
        # The error was read for the last time before the last samples.
        (numbers(0.05, 0.09, SAMPLES), {}),
        (numbers(0.25, 0.5, CANCELLED), {}),
        (numbers(0.25, 0.5), {"target_error": 0.0}),
    ],
)
def test_nothing_is_missed(values, settings):
    assert told(values, **settings)[0].startswith("error ")


def test_an_unknown_error_has_missed_its_target():
    first, second = told(numbers(math.inf, math.inf, samples=1), samples=1)
    assert first.startswith("10 % was not reached: the error is unknown") and second.startswith("error unknown")


@pytest.mark.parametrize(
    "lights, paths, words",
    [
        (1, 1, "100 samples in 20.0 s"),
        (1, 4, "100 samples, each of 1 light and 4 paths, in 20.0 s"),
        (2, 1, "100 samples, each of 2 lights and 1 path, in 20.0 s"),
    ],
)
def test_how_samples_split(lights, paths, words):
    assert words in told(numbers(0.05, 0.09, split_lights=lights, split_paths=paths))[0]


def test_view_layers_are_named():
    values, settings = numbers(0.25, 0.5), Settings(target_error=0.1)
    one, other = (render_report.lines(values, settings, layer) for layer in ("Front", "Back"))
    assert all(line.startswith("view layer 'Front': ") for line in one) and len(one) == len(other) == 3
    layers = {"Front": {"accuracy": one}, "Back": {"accuracy": other}}
    assert render_report.of_layers({"accuracy": other, "layers": layers}) == one + other
    assert render_report.of_layers({"accuracy": other}) == other


def test_durations():
    words = {0.0123: "0.0 s", 9.94: "9.9 s", 9.96: "10 s", 99.0: "99 s", 100.0: "1.7 min", 5400.0: "90 min", 6000.0: "1.7 h"}
    assert {value: render_report.duration(value) for value in words} == words
    assert render_report.duration(math.inf) == "unknown"
