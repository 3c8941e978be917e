"""The painter of a view and the sizes of its pixels, without a window."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

from addon.viewport.sizes import PixelSizes, coarsest


class Rectangle:
    def __init__(self, width, height):
        self.width, self.height = width, height


@pytest.fixture(params=[MODULE, PROGRAM])
def case(request, tmp_path):
    return lambda name: blenders.run(request.param, tmp_path, "painter_cases", name)


def test_a_finished_picture_is_that_of_a_session(case):
    got = case("bits")
    assert got["equal"] == [True] * 3
    assert got["sizes"] == [[1, 8, 64, 96, 4], [1, 8, 64, 50, 4], [2, 8, 32, 48, 4]]
    assert got["left"] == 0 and got["failure"] == ""


def test_what_is_wanted_last_comes_first(case):
    got = case("newest")
    assert got["first"] and got["left"] == 0
    # A view that never rests still shows pictures.
    assert got["shown"] == 3


def test_failures_are_told_and_over(case):
    got = case("fails")
    assert "bad" in got["told"] and got["failure"] == "" and got["right"] and got["left"] == 0


def test_denoising(tmp_path):
    """The module has Open Image Denoise, Debian's program does not."""
    got = blenders.run(MODULE, tmp_path, "painter_cases", "denoises")
    assert (
        got["denoised"] == [False, True] and got["alpha"] and got["failure"] == "" and got["threads"] == [] and got["left"] == 0
    )
    # A coarse picture is there for a moment.
    assert got["coarse"] and not any(denoised for _, denoised in got["coarse"])
    # Noise of 10 % and more, at four samples, is nearly removed.
    assert got["roughness"][1] < 0.5 * got["roughness"][0]


def test_a_denoiser_that_fails_is_told(case):
    got = case("denoiser_fails")
    assert got["told"] == ["Open Image Denoise: out of order; the picture is shown with its noise"]
    assert (got["denoised"], got["samples"], got["failure"], got["left"]) == (False, 4, "", 0)


def test_no_picture_waits_for_the_denoiser(case):
    got = case("slow_denoiser")
    # All samples are shown while the first picture is still being denoised.
    assert got["meanwhile"] == {"denoised": False, "calls": 1, "busy": True}
    assert got["last"] == [64, True] and got["calls"] == 2 and got["left"] == 0


def test_the_first_picture_is_as_coarse_as_it_must_be():
    """At 1.2 million pixels per second 0.03 s are 36 000 pixels: 240 x 135 is the finest size of 960 x 540 below that."""
    sizes, region = PixelSizes(), Rectangle(960, 540)
    assert coarsest(region, 1, 64) == 8 and coarsest(region, 2, 64) == 8 and coarsest(Rectangle(60, 60), 1, 64) == 1
    # The shorter side decides, whichever it is.
    assert coarsest(Rectangle(4000, 540), 1, 64) == coarsest(Rectangle(540, 4000), 1, 64) == 8
    assert sizes.first(region, 1, 8) == 8
    sizes.learn(1_200_000, 1.0)
    assert sizes.first(region, 1, 8) == 4 and sizes.first(region, 1, 2) == 2 and sizes.first(region, 8, 8) == 8
    # The finest takes 0.43 s, longer than a step may take: one more size comes before it.
    assert sizes.after(4, region, 1) == 2 and sizes.after(2, region, 1) == 1
    for _ in range(20):
        sizes.learn(100_000_000, 1.0)
    assert sizes.first(region, 1, 8) == 1
