"""F12 with denoising: the guess takes the place of Combined, and what was rendered stays, bit for bit, as Noisy Image."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

DECLARATION = "denoised: the error given is that of the picture before denoising"


@pytest.fixture
def case(tmp_path):
    return lambda name, *arguments, which=MODULE: blenders.run(which, tmp_path, "denoising_cases", name, *arguments)


def check_denoised(got):
    assert got["noisy is raw"] and got["alpha is raw"] and got["others are raw"] and got["finite"]
    assert not got["combined is raw"]
    assert got["passes"] == sorted([*got["passes without"], "Noisy Image"])
    assert got["stamped"] == [False, True]
    assert [line for line in got["messages"] if "enois" in line] == []
    statistics = got["statistics"]
    assert statistics["denoised"] == DECLARATION and statistics["denoiser"].startswith("Open Image Denoise 2.")
    assert statistics["denoising_seconds"] > 0.0 and statistics["denoising_bytes"] > 0


@pytest.mark.parametrize("integrator", ["plain", "classic"])
def test_what_was_rendered_stays(case, integrator):
    got = case(integrator)
    check_denoised(got)
    assert got["passes without"] == ["Combined"]


def test_other_passes_are_what_they_were(case):
    got = case("passes")
    check_denoised(got)
    assert {"Denoising Albedo", "Denoising Normal", "Denoising Depth", "Normal"} < set(got["passes"])


def test_border(case):
    got = case("border")
    check_denoised(got)
    assert got["size"] == [36, 32, 4]


def test_transparent_film(case):
    got = case("transparent")
    check_denoised(got)
    assert got["alphas"] == [0.0, 1.0]


def test_each_view_layer_has_a_switch(case):
    first, second = case("view_layers")
    assert first["noisy is raw"] and not first["combined is raw"] and "Noisy Image" in first["passes"]
    assert second["combined is raw"] and second["passes"] == ["Combined"]


def test_normals_have_no_noise(case):
    got = case("normals")
    assert got["combined is raw"] and got["passes"] == ["Combined"] and got["statistics"]["denoised"] == ""


def test_esc_leaves_what_was_rendered(case):
    got = case("stopped", "poll")
    assert got["told"] == 1 and got["working"] == []
    assert got["raw"] and got["denoised"] == "" and not got["stamped"]
    assert [line for line in got["messages"] if "enois" in line] == []


def test_ctrl_c_ends_it(case):
    got = case("stopped", "interrupt")
    assert got["told"] == 1 and got["working"] == []
    assert "interrupted" in got["error"] and got["messages"][-1] == "interrupted"


@pytest.mark.parametrize("name, which", [("failing", MODULE), ("plain", PROGRAM)])
def test_where_it_cannot_be_done_it_is_told(case, name, which):
    """Debian builds Blender without the library."""
    got = case(name, which=which)
    told = [line for line in got["messages"] if "Open Image Denoise" in line]
    assert len(told) == 1 and told[0].endswith("the picture is shown with its noise")
    assert ("is missing" in told[0]) == (which == PROGRAM) and told[0] in got["console"]
    assert got["combined is raw"] and got["noisy is raw"]
    assert got["statistics"]["denoised"] == "" and got["stamped"] == [False, False]


def test_the_passes_are_those_of_cycles(case):
    got = case("as_cycles")
    for ours, theirs in (got["False"], got["True"]):
        assert ours == theirs and ours["Noisy Image"] == 4


def test_it_comes_nearer_to_the_converged_picture(case):
    got = case("nearer")
    assert got["denoised"] < got["raw"]
