"""F12 in the bpy module of this Python and in Debian's Blender 3.4.1, through the registered engine."""

import math

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name, *arguments: blenders.run(which, tmp_path, "f12_cases", name, *arguments)


def test_the_scene_that_blender_starts_with(case):
    got = case("startup")
    assert got["size"] == [27, 48] and got["mean"][3] == pytest.approx(1.0, abs=1e-5)
    # The cube differs from the grey sky (0.05).
    assert 0.03 < got["mean"][0] < 1.0 and got["deviation"] > 0.02


def test_room(case):
    got = case("room")
    assert got["size"] == [32, 32] and got["finite"] and 0.05 < got["mean"][0] < 5.0


def test_light_power_arrives_exactly(case):
    # P/(4 pi) / d^2 = pi on an albedo-1 plane is radiance 1; 1e-4 is the contract for light units.
    assert case("point_light") == pytest.approx([1.0, 1.0, 1.0, 1.0], rel=1e-4)


def test_a_render_changes_nothing(case):
    got = case("untouched")
    assert got["before"] == got["after"] and got["after"] != got["changed"]


def test_border_crop_and_percentage(case):
    got = case("sizes")
    assert (got["plain"], got["percentage"], got["border"], got["crop"]) == ([30, 40], [15, 20], [30, 40], [12, 20])
    assert got["border same"] and got["crop same"] and got["border outside"] == 0.0


def test_aspect_fit_and_shift(case):
    """A square of 1 m, 4 m away, lens 50 on 36 mm: 1/4 * 50/36 of the fitted side."""
    got = case("shape_of_a_square")
    side = 64 * 50 / 36 / 4
    # Sums count partially covered pixels: half a pixel is ample.
    near = pytest.approx
    assert got["square"][:2] == near([side, side], abs=0.5)
    # A pixel twice as wide shows the square half as many pixels wide; the fit follows the wider side.
    assert got["wide pixels"][0] == near(got["wide pixels"][1] / 2, abs=0.5)
    assert got["portrait"][:2] == near([side, side], abs=0.5) and got["landscape"][:2] == near([side, side], abs=0.5)
    assert got["shift"][2] == near(got["square"][2] - 16, abs=0.5) and got["shift"][3] == near(got["square"][3], abs=0.5)
    assert got["scaled camera"] == near(got["square"], abs=1e-3)


@pytest.mark.parametrize("width", [1.5, 3.0])
def test_the_smooth_filter_reaches_its_width_to_each_side(case, width):
    """Pixels beside an edge have the share of the four-term Blackman-Harris window across the edge, as in Cycles."""

    def below(x):
        # Integral of the window over its left part, x in 0 ... 1.
        x = min(max(x, 0.0), 1.0)
        terms = (-0.48829, 0.14128, -0.01168)
        return 0.35875 * x + sum(a * math.sin(2 * math.pi * k * x) / (2 * math.pi * k) for k, a in enumerate(terms, 1))

    wanted = [below(0.5 - (3.5 - column) / (2 * width)) / 0.35875 for column in range(4)]
    # A sample's standard deviation is at most a half: the tolerance is 4 standard errors of 64 rows of 256 samples.
    assert case("filter_reach", width) == pytest.approx(wanted, abs=4 * 0.5 / math.sqrt(64 * 256))


def test_film_transparent(case):
    got = case("film_transparent")
    assert got["corner"] == [0, 0, 0, 0] and got["middle"][3] == pytest.approx(1.0)


def test_view_layers_and_pass_names(case):
    got = case("view_layers")
    long_names = got["version"] >= [5, 0]
    passes = {
        "Combined": "RGBA",
        "Depth": "Z",
        "Normal": "XYZ",
        "Position": "XYZ",
        "Denoising Albedo": "RGB",
        "Object Index" if long_names else "IndexOB": "X",
        "Material Index" if long_names else "IndexMA": "X",
    }
    wanted = {f"{layer}.{name}.{c}" for layer in got["layers"] for name, letters in passes.items() for c in letters}
    # Depth's channel is called V or Z by version.
    have = {name.replace("Depth.V", "Depth.Z") for name in got["channels"]}
    assert wanted <= have, wanted - have
    assert got["difference"] > 0.05


def test_statistics_for_scripts(case, which):
    got = case("engine_statistics")
    assert got["samples"] == 4 and got["rays"] > 0 and got["seconds"] > 0 and got["features"] and got["instruction_set"]


def test_progress_is_told(case, which):
    """The status line has samples, speed and remaining time; Blender 3.4 prints it to the console only."""
    got = case("progress")
    texts = got["texts"] if which == MODULE else got["console"].splitlines()
    told = [text for text in texts if "Sample" in text and "/256" in text and "rays/s" in text and "Remaining" in text]
    assert len(told) >= 2, texts[-5:]
    # The remaining time comes first, since a small window cuts off the end.
    assert all(text.index("Remaining") < text.index("Sample") for text in told)


def test_the_first_picture_comes_before_the_first_sample_is_done(case):
    """The first picture has pixels of 8 x 8, the second those of the first sample in the tiles that are done; none is blank."""
    got = case("first_picture")
    assert got["large"] and got["covered"] == [True, True] and got["shown"] >= 3
    assert 500 < got["colors"][0] <= 80 * 45 < got["colors"][1]
