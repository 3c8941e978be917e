"""Cryptomatte: passes, metadata and mattes as Cycles writes them, and as Blender's own node reads them."""

import math

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])
_PIXELS, _SAMPLES = 32 * 32, 512


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    found = {}

    def of(which):
        if which not in found:
            found[which] = blenders.run(which, tmp_path_factory.mktemp("cryptomatte"), "cryptomatte_cases", "both")
        return found[which]

    return of


def test_passes_and_metadata_are_those_of_cycles(which, both):
    got = both(which)
    assert got["passes"] == got["passes of cycles"] and len(got["passes"]) == 9
    for kind in ("Object", "Material", "Asset"):
        fields = got[kind]["fields"]
        assert fields["LANCER"] == fields["CYCLES"]
        assert got[kind]["missing"] == []


@pytest.mark.parametrize("kind", ["Object", "Material", "Asset"])
def test_mattes_are_those_of_cycles(which, both, kind):
    """The mean of a matte over the picture differs by at most the noise of both.

    A pixel of the matte m has the variance m (1 - m) / samples where samples are independent, and less where they are evenly
    spread. The mean's standard error is the root of the sum over the pixels; four of them, of two pictures.
    """
    got = both(which)[kind]
    assert len(got["means"]) >= 5
    for name, (ours, theirs) in got["means"].items():
        bound = 4.0 * math.sqrt(2.0 * got["edges"][name] / _SAMPLES) / _PIXELS
        assert abs(ours - theirs) <= bound, name
        # Five standard errors of a half-covered pixel, in both.
        assert got["largest"][name] <= 5.0 * math.sqrt(2.0 * 0.25 / _SAMPLES), name
    shown = {name for name, (mean, _) in got["means"].items() if mean > 0.0}
    assert {"Object": "Inner", "Material": "default_surface", "Asset": "Top"}[kind] in shown
    assert "Hole" not in shown


def test_denoising_borders_and_layers(which, tmp_path):
    got = blenders.run(which, tmp_path, "cryptomatte_cases", "several")
    assert got["denoised"] and got["cropped"] and got["first"]
    layers = ["Other.CryptoMaterial", "Other.CryptoObject"]
    assert got["layers"] == layers + [f"ViewLayer.Crypto{kind}" for kind in ("Asset", "Material", "Object")]
    assert list(got["overridden"]) == ["Rot"]


def test_blenders_node_reads_the_mattes(which, tmp_path):
    got = blenders.run(which, tmp_path, "cryptomatte_cases", "by_the_node")
    # The node adds up to six floats of at most 1, in another order.
    assert got["difference"] <= 6 * 2.0**-24 and 0.1 < got["mean"] < 0.9
