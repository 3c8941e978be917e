"""Passes by their names in each version of Blender, with known values."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])

# Name from Blender 5 on, name before, channels.
NAMES = [
    ("Combined", "Combined", 4),
    ("Depth", "Depth", 1),
    ("Mist", "Mist", 1),
    ("Position", "Position", 3),
    ("Normal", "Normal", 3),
    ("Vector", "Vector", 4),
    ("UV", "UV", 3),
    ("Object Index", "IndexOB", 1),
    ("Material Index", "IndexMA", 1),
    ("Diffuse Direct", "DiffDir", 3),
    ("Diffuse Indirect", "DiffInd", 3),
    ("Diffuse Color", "DiffCol", 3),
    ("Glossy Direct", "GlossDir", 3),
    ("Glossy Indirect", "GlossInd", 3),
    ("Glossy Color", "GlossCol", 3),
    ("Transmission Direct", "TransDir", 3),
    ("Transmission Indirect", "TransInd", 3),
    ("Transmission Color", "TransCol", 3),
    ("Emission", "Emit", 3),
    ("Environment", "Env", 3),
    ("Ambient Occlusion", "AO", 3),
    ("Denoising Normal", "Denoising Normal", 3),
    ("Denoising Albedo", "Denoising Albedo", 3),
    ("Denoising Depth", "Denoising Depth", 1),
]


@pytest.fixture
def case(which, tmp_path):
    return lambda name, *arguments: blenders.run(which, tmp_path, "pass_cases", name, *arguments)


def test_every_pass_is_there_and_filled(case):
    got = case("every_pass")
    wanted = {row[0] if got["version"] >= [5, 0] else row[1]: row[2] for row in NAMES}
    if got["version"] >= [5, 2]:
        wanted |= {"Denoising Specular Albedo": 3, "Denoising Roughness": 1}
    assert {name: look["channels"] for name, look in got["passes"].items()} == wanted
    # No pass is constant.
    assert [name for name, look in got["passes"].items() if not look["finite"] or look["low"] == look["high"]] == []
    assert got["indices"] == [0, 7] and got["materials"] == [0, 9]
    told = [line for line in got["messages"] if "pass" in line]
    if got["version"] >= [4, 0]:
        assert told == []
    else:
        (line,) = told
        assert line.startswith("view layer 'ViewLayer': passes for denoising are those of Cycles 4")


def test_shadow_catchers(case):
    """With the pass the floor is no part of Combined; without it, its shadows are in the alpha. Denoising moves none of it."""
    got = case("catchers")["looks"]
    assert {name: found["messages"] for name, found in got.items()} == dict.fromkeys(got, [])
    assert all(look["finite"] for found in got.values() for name, look in found.items() if name != "messages")
    for suffix in ("", " denoised"):
        shadows, apart = got["shadows" + suffix], got["pass" + suffix]
        assert "Shadow Catcher" not in shadows and apart["Shadow Catcher"]["channels"] == 3
        assert apart["Shadow Catcher"]["low"] < 0.7 < 0.95 < apart["Shadow Catcher"]["high"]
        # Pixels of the floor alone: clear without the pass's shadow, dimmed with it.
        assert apart["alpha"]["low"] == 0.0 and apart["alpha"]["high"] == shadows["alpha"]["high"] == 1.0


def test_passes_that_the_artist_makes(case):
    """An AOV with the name of another pass is none. Groups sum to Combined, up to rounding of a sum with some ten terms."""
    got = case("chosen_passes")
    wanted = {
        "Combined": 4,
        "Combined_lamps": 3,
        "Combined_rest": 3,
        "Tint": 4,
        "Number": 1,
        "Debug Sample Count": 1,
    }
    assert {name: got["passes"].get(name) for name in wanted} == wanted
    assert set(got["passes"]) - set(wanted) <= {"Render Time"} and got["messages"] == []
    assert got["difference"] < 10 * 2.0**-24 and all(mean > 0.0 for mean in got["means"])
    # The floor alone gives values, each pixel by the share of its samples that see it.
    assert got["tints"] == [[0.0, 0.0, 0.0, 0.0], [0.25, 1.5, 2.0, 1.0]] and got["numbers"] == [0.0, 0.75]
    assert got["samples"] == [1.0]
    assert got["time"] is None or got["time"] > 0.0


def test_parts_give_the_picture_again(case):
    """The light passes sum to Combined, up to rounding of a sum with seven terms."""
    assert case("every_pass")["difference"] < 2.0**-20


def test_nothing_is_rendered_that_is_not_asked_for(case):
    got = case("no_pass")
    assert got["passes"] == ["Combined"] and [line for line in got["messages"] if "pass" in line] == []


def test_a_missing_pass_is_named(case):
    told = [line for line in case("missing_passes") if "passes are not supported" in line]
    assert len(told) == 1 and "Subsurface Direct" in told[0] and "Cryptomatte" not in told[0]


def test_albedo_may_come_alone(case):
    assert case("albedo_alone") == ["Combined", "Denoising Albedo"]


def test_known_numbers(case):
    got = case("known_numbers")
    # With an orthographic camera mist uses the depth along the axis, in the centre and beside it.
    for falloff, exponent in (("QUADRATIC", 2.0), ("LINEAR", 1.0), ("INVERSE_QUADRATIC", 0.5)):
        assert got["mist"][falloff] == [pytest.approx((3.0 / 12.0) ** exponent)] * 2, falloff
    assert got["sky mist"] == 1.0
    assert got["Depth"][0] == pytest.approx([4.0]) and got["Depth"][1] == pytest.approx([1e10])
    # The centre pixel is a square of 2/3 m around the origin, which contains sample 0.
    x, y, z = got["Position"][0]
    assert abs(x) <= 1 / 3 and abs(y) <= 1 / 3 and abs(z) < 1e-6 and got["Position"][1] == [0, 0, 0]
    assert got["Normal"] == [pytest.approx([0, 0, 1]), [0, 0, 0]]
    # The file's reader sorts the third channel, A, to the front.
    w, u, v = got["UV"][0]
    # The mean over the pixel, which covers a third of the plane's side.
    assert abs(u - 0.5) < 1 / 6 and abs(v - 0.5) < 1 / 6 and w == 1.0 and got["UV"][1] == [0, 0, 0]
    # Camera space: z points into the picture.
    assert got["Denoising Normal"][0] == pytest.approx([0, 0, -1], abs=1e-6)
    assert got["Denoising Albedo"][0] == pytest.approx([0.8, 0.4, 0.2])
    # Cycles measures from the camera's clip start, 0.1.
    assert got["Denoising Depth"][0] == pytest.approx([3.9])
    assert got["open"] == [1.0, 1.0, 1.0]
    assert got["under a lid, 0.5"] == [1.0, 1.0, 1.0] and got["under a lid, 1e+06"] == [0.0, 0.0, 0.0]
    assert got["veil, 0.2"] == pytest.approx(3.0) and got["veil, 0.4"] == pytest.approx(4.0)


def test_switches_are_seen_in_the_compositor_at_once(case):
    got = case("sockets")
    error, albedo, noisy = "Lancer Error", "Denoising Albedo", "Noisy Image"
    shown = {name: set(got[name]) for name in got if name != "console"}
    assert shown == {
        "nothing": set(),
        "use_pass_error": {error},
        "use_pass_albedo": {error, albedo},
        "use_denoising": {error, albedo, noisy, "Lancer Denoised Error"},
        "integrator": {error, albedo},
        "off": set(),
    }
