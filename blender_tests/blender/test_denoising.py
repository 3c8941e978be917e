"""F12 with denoising: the denoised picture replaces Combined, and Noisy Image has the bits of the rendered picture."""

import blenders
import oidn_versions
import pytest
from blenders import MODULE, PROGRAM

DECLARATION = "denoised: a guess that can remove details; its own error is told beside that of the picture before denoising"


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    folder = tmp_path_factory.mktemp("denoising")
    cases = blenders.run(MODULE, folder, "denoising_cases", "several")
    return cases.__getitem__


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


@pytest.mark.parametrize("how", ["poll", "at once"])
def test_esc_leaves_what_was_rendered(case, how):
    got = case(how)
    # Denoising is asked once and ends at its first report.
    assert len(got["said"]) == 1 and got["said"][0].startswith("Denoising ") and got["working"] == []
    assert got["raw"] and got["denoised"] == "" and not got["stamped"]
    assert [line for line in got["messages"] if "enois" in line] == []


def test_ctrl_c_ends_it(tmp_path):
    got = blenders.run(MODULE, tmp_path, "denoising_cases", "stopped", "interrupt")
    assert len(got["said"]) == 1 and got["working"] == []
    assert "interrupted" in got["error"] and got["messages"][-1] == "interrupted"


def check_told(got, words):
    told = [line for line in got["messages"] if "Open Image Denoise" in line]
    assert len(told) == 1 and words in told[0] and told[0].endswith("the picture is shown with its noise")
    assert got["combined is raw"] and got["noisy is raw"]
    assert got["statistics"]["denoised"] == "" and got["stamped"] == [False, False]


def test_a_failure_is_told(case):
    check_told(case("failing"), "out of memory")


def test_a_blender_without_the_library_is_told(tmp_path):
    """Debian builds Blender without the library."""
    got = blenders.run(PROGRAM, tmp_path, "denoising_cases", "plain")
    check_told(got, "Open Image Denoise is missing")
    assert "Open Image Denoise is missing" in got["console"]


def test_version_1_in_a_blender_of_its_time(tmp_path):
    """Version 1 as in builds of Blender 3: loaded in the process and found there."""
    path, environment = oidn_versions.older(tmp_path)
    got = blenders.run(PROGRAM, tmp_path, "denoising_cases", "plain", LD_PRELOAD=path, **environment)
    assert got["noisy is raw"] and got["finite"] and not got["combined is raw"] and got["stamped"] == [False, True]
    assert got["statistics"]["denoiser"] == "Open Image Denoise 1.4.3" and "Denoising 100%" in got["console"]


def test_the_passes_are_those_of_cycles(case):
    got = case("as_cycles")
    for ours, theirs in (got["False"], got["True"]):
        # New in Blender 5.2, and listed in the README as not supported.
        newer = {name: theirs.pop(name) for name in ("Denoising Roughness", "Denoising Specular Albedo") if name in theirs}
        assert ours == theirs and ours["Noisy Image"] == 4
        assert not newer or got["version"] >= [5, 2]


def test_the_error_of_the_denoised_picture_is_told(case):
    combined, plain = case("told")
    for got in (combined, plain):
        low, error, high = got["errors"]
        assert 0.0 < low < error < high < got["error"]
        assert got["lines"][0].startswith("denoised error ") and got["lines"][1].startswith("before denoising: error ")
        shape, least, mean, noisy = got["bars"]
        assert shape == [64, 96, 1] and 0.0 <= least and 0.0 < mean < noisy
        assert got["stamped"]
    assert combined["picture"] != plain["picture"]


def test_one_sample_is_denoised_without_an_error(case):
    got = case("once")
    assert got["denoised"] and got["error"] == float("inf") and got["bars"] == 0.0
    assert got["lines"][0].startswith("error unknown")


def test_a_target_may_be_that_of_the_denoised_picture(case):
    got = case("target")
    denoised, noisy, missed = got["denoised"], got["noisy"], got["missed"]
    assert denoised["ended_by"] == noisy["ended_by"] == "target error" and missed["ended_by"] == "samples"
    assert denoised["denoised_error_high"] <= 0.03 < denoised["error"]
    assert denoised["samples_mean"] < 0.5 * noisy["samples_mean"]
    assert missed["lines"][0].startswith("0.01 % was not reached: ")


def test_it_comes_nearer_to_the_converged_picture(case):
    got = case("nearer")
    assert got["denoised"] < got["raw"]
