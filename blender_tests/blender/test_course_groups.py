"""The course's models as node groups, in the bpy module of this Python and in Debian's Blender 3.4.1."""

import math

import blenders
import numpy as np
import pytest
import reference
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])
LOBES = {
    "KD_KS": ["LAMBERT", "BECKMANN"],
    "PHONG": ["LAMBERT", "PHONG"],
    "BLINN_PHONG": ["LAMBERT", "BLINN_PHONG"],
    "MINNAERT": ["MINNAERT"],
}
MODELS = tuple(LOBES)
# Blender stores single precision: the tolerance is sixteen times its rounding of 2^-24.
STORED = 1e-6
# Errors of CLASSIC's pixels: a dozen float32 products at 6e-8, powers up to 60 of a cosine with an error of 1e-7, and a camera
# in single precision, which moves the visible point by some 1e-6 of the distance.
PIXEL = 2e-5
# With four rows over two units the centre of the second row is 1/4 below the middle; the view's slant is 0.8.
PLACE = -0.25 / 0.8


def near(value, limit=STORED):
    return pytest.approx(value, rel=limit, abs=limit)


@pytest.fixture
def case(which, tmp_path):
    return lambda name, *arguments: blenders.run(which, tmp_path, "course_group_cases", name, *arguments)


def test_constants_give_the_bits_of_the_material_s_own_settings(case):
    got = case("constants")
    for model in MODELS:
        for integrator in ("PATH", "CLASSIC"):
            found = got[f"{model} {integrator}"]
            assert found["same"], (model, integrator)
            # Only CLASSIC has ambient light.
            assert dict(found["telling"]) == {name: name != "ka" or integrator == "CLASSIC" for name, _ in found["telling"]}, (
                model,
                integrator,
            )


def unit(vector):
    return np.asarray(vector, float) / np.linalg.norm(vector)


def minnaert(color, k, *cosines):
    """Return f as in lancer.h: for k < 1 cosines are clamped to the one at which the albedo is 1."""
    least = max(color) ** (1 / (1 - k)) if k < 1 else 0.0
    q = least ** (k + 1)
    scale = 2 * math.pi * ((1 - q) / (k + 1) + q / 2)
    return color / scale * math.prod(max(cosine, least) for cosine in cosines) ** (k - 1)


def classic(model, values, stage, x):
    """Return the radiance from (x, PLACE, 0) by the course's formulas."""
    way = np.array(stage["lamp"]) - [x, PLACE, 0.0]
    lc = stage["power"] / (4 * math.pi * way @ way)
    light, view = unit(way), unit(stage["eye"])
    half = unit(light + view)
    ka, kd, ks = (np.array(values[name]) for name in ("ka", "kd", "ks"))
    ambient = ka * (stage["sky"] + lc / math.pi)
    if model == "MINNAERT":
        return ambient + minnaert(kd, values["darkness"], light[2], view[2]) * light[2] * lc
    result = kd / math.pi * light[2] * lc + ambient
    if model == "KD_KS":
        alpha, ior = values["roughness"], values["ior"]
        result = result + ks * float(reference.beckmann_bsdf(view, light, alpha, ior)) * light[2] * lc
        return result + ks * float(reference.fresnel(view[2], ior)) * stage["sky"]
    cosine = (light * [-1, -1, 1]) @ view if model == "PHONG" else half[2]
    return result + ks / math.pi * cosine ** values["shininess"] * lc


def test_a_texture_modulates_each_parameter(case):
    """Text 003, 3.4: each half of a texture gives the formula's result for its value; PATH equals the result of constants."""
    got = case("textures")
    assert len(got["pixels"]) == 16
    for key, found in got["pixels"].items():
        model, name = key.split()
        for half, x in enumerate((-0.25, 0.25)):
            values = {**got["values"], name: got["halves"][name][half]}
            assert found["CLASSIC"][half] == near(classic(model, values, got["stage"], x).tolist(), PIXEL), (key, half)
        # Equal samples in other kernels.
        assert found["PATH"] == [near(pixel, PIXEL) for pixel in found["PATH of constants"]], key
        assert found["CLASSIC"][0] != near(found["CLASSIC"][1], 1e-3), key


def test_the_normal_s_socket_bends_both_lobes(case):
    got = case("normals")
    for model in MODELS:
        assert got[model]["kinds"] == LOBES[model]
        for lobe in got[model]["lobes"]:
            assert got[model]["node kinds"][lobe["normal"]["node"]] == "BUMP"


def test_models_are_mixed_and_nested(case):
    got = case("mixed")
    assert got["mixed"]["kinds"].count("PHONG") == 1 and got["mixed"]["messages"] == []
    phong = next(lobe for lobe, kind in zip(got["mixed"]["lobes"], got["mixed"]["kinds"], strict=True) if kind == "PHONG")
    assert phong["color"] == near([0.75, 0.5, 0.25]) and phong["weight"] == near([0.25] * 3)
    matt = [lobe for lobe, kind in zip(got["mixed"]["lobes"], got["mixed"]["kinds"], strict=True) if kind == "LAMBERT"]
    assert np.sum([lobe["color"] for lobe in matt], axis=0).tolist() == near([0.875, 0.8125, 0.78125])
    assert got["mixed"]["ambient"] == near([0.0625, 0.03125, 0.0])
    assert got["nested"]["kinds"] == LOBES["PHONG"] and got["nested"]["lobes"][0]["color"] == near([0.25, 0.5, 0.75])
    assert any(line.startswith("Phong Ks") for line in got["nested"]["panel"])


def test_groups_are_known_by_more_than_their_name(case):
    got = case("identity")
    assert got["reused"] and got["fresh"]
    changed, unknown, poor = (got[name] for name in ("changed", "of a version to come", "poor"))
    assert changed["kinds"] == poor["kinds"] == LOBES["PHONG"]
    assert [("changed" in line, "Ungroup" in line) for line in changed["messages"]] == [(True, True)]
    # An unknown model is rendered by the nodes inside.
    assert unknown["kinds"] == ["LAMBERT", "GLOSSY"] and unknown["messages"] == []
    # Removing the input also removes its link inside.
    assert [("no input 'Shininess', 50" in line, "changed" in line) for line in poor["messages"]] == [
        (False, True),
        (True, False),
    ]
    assert poor["lobes"][1]["shininess"] == 50.0


@pytest.mark.parametrize("how", ["open", "append", "link"])
def test_files_of_each_blender_keep_the_models(which, how, tmp_path):
    """Files of the same Blender, and of 3.4.1 opened in the newer one, which converts nodes."""
    for writer in {which, PROGRAM}:
        path = tmp_path / f"{writer.split()[1]}.blend"
        blenders.run(writer, tmp_path, "course_group_cases", "save", path) if not path.exists() else None
        got = blenders.run(which, tmp_path, "course_group_cases", "opened", path, how)
        for model in MODELS:
            assert (got[model]["kinds"], got[model]["messages"]) == (LOBES[model], []), (writer, model)
            assert got[model]["lobes"][0]["color"] == near([0.5, 0.25, 0.125])
        assert all(got["local"])
        assert got["groups"] == len(MODELS) * (2 if how == "link" else 1)


def test_cycles_shows_the_groups(case):
    """Cycles shows a finite, lit picture that changes with the values."""
    got = case("cycles")
    for model in MODELS:
        first, second = np.array(got[model])
        assert np.isfinite(first).all() and (first > 0.0).all() and not np.allclose(first, second, rtol=1e-3), model


def test_phongs_lobe_is_shown_as_wide_as_it_is(case):
    """The angle to the mirrored direction is twice that of the half vector: cos^n of the one is about cos^4n of the other."""
    assert case("widths") == [4.0, "MULTIPLY"]


def test_the_shader_editor_adds_models(case):
    got = case("editor")
    assert sorted(got["added"]) == sorted(2 * got["models"]) and got["trees"] == len(got["models"])
    assert got["selected"] and not got["nothing edited"]
    assert got["menu"][0] == "NODE_MT_lancer_models" and got["menu"][1:] == [
        "Diffuse and Coat",
        "Phong",
        "Blinn-Phong",
        "Minnaert",
    ]
    assert got["menu of Cycles"] == []
    assert "inside a model's group" in str(got["inside"])


def test_adding_a_model_is_one_step_to_undo(case):
    """Undo removes the node and its group, redo restores them."""
    assert case("undo") == [1, -1, 1]
