"""Object > Bake: texels equal those of Cycles, and reach every target."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

both = pytest.mark.parametrize("which", [MODULE, PROGRAM])


# Means of blocks of 64 texels at 256 samples: the noise of both engines is below a hundredth, that of indirect light alone
# below two hundredths. The bounds are three times that.
_NOISE, _INDIRECT_NOISE = 0.03, 0.06
# Types without light have no noise but that of places within a texel, of which single precision and the mean are left.
_EXACT = {"POSITION", "NORMAL", "ROUGHNESS", "ENVIRONMENT"}
_DARK = {"EMIT", "TRANSMISSION"}


@both
def test_texels_are_those_of_cycles(which, tmp_path):
    for kind, (apart, other_alpha, level) in blenders.run(which, tmp_path, "bake_cases", "alike")["types"].items():
        assert apart < (2e-3 if kind in _EXACT else _NOISE), kind
        assert other_alpha == 0, kind
        assert (level > 1e-6) == (kind not in _DARK), kind


@both
def test_parts_of_the_light_are_those_of_cycles(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_cases", "filtered")["parts"]
    indirect = got.pop("indirect")
    # Cycles 3 leaves all lamps out of indirect light alone.
    assert indirect < _INDIRECT_NOISE or which == PROGRAM
    assert {name: apart for name, apart in got.items() if not apart < _NOISE} == {}


@both
def test_every_target_is_reached(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_cases", "targets")
    assert got["bare"] == got["with"] > 0.0
    assert got["emission"] == 0.0
    red, green, blue = got["green"]
    assert green > 0.9 and max(red, blue) < 0.05
    assert got["attribute"] == pytest.approx([0.0, 1.0, 0.0], abs=0.05)


@both
def test_what_cannot_be_baked_is_told(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_cases", "refused")
    assert "object 'Block' is shown as an exact shape: set its Shape to Mesh" in got["exact"]
    assert "scene 'Scene': only the integrator Path bakes" in got["classic"]


@both
def test_meshes_are_those_of_blender(which, tmp_path):
    """As in Cycles, adaptive subdivision is of pictures: the triangles that Blender names are those of its own mesh."""
    got = blenders.run(which, tmp_path, "bake_cases", "divided")
    assert got["apart"] < 1e-5 < got["level"]


@both
def test_a_bake_is_of_the_frame(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_cases", "beside_the_frame")
    assert got["CENTER"] == []
    assert got["START"] == ["scene 'Scene': a bake shows the frame 1, that of Cycles the middle of the shutter, 1.25"]


@both
def test_renders_need_no_handlers(which, tmp_path):
    """They tell bakes and renders apart."""
    got = blenders.run(which, tmp_path, "bake_cases", "unannounced")
    assert got["level"] > 0.05


@both
def test_threads_and_targets(which, tmp_path):
    got = blenders.run(which, tmp_path, "bake_cases", "same")
    assert got["same"]
    # Two renders at fixed samples are followed by one that its target ends.
    told = [line for line in got["console"].splitlines() if "bake of 'Block': error" in line]
    assert len(told) == 3 and told[2].endswith("ended by target error")
