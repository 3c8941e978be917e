"""The pass Vector of F12: pixels from the frame before and to the frame after."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])

ZERO = [0.0] * 4


@pytest.fixture
def case(which, tmp_path):
    return lambda name, *arguments: blenders.run(which, tmp_path, "vector_cases", name, *arguments)


def test_known_motion(case):
    got = case("values")
    # Half a unit and a quarter are a pixel and half of one; places before less now, and now less after.
    for name, expected in {
        "thing": [-1.0, 0.5, -1.0, 0.5],
        "camera": [1.0, -0.5, 1.0, -0.5],
        "both": ZERO,
        "nothing": ZERO,
        "bent way": [-1.0, 0.0, -4.0, 0.0],
    }.items():
        # Blender's places have single precision, 1e-7 of 5 units.
        assert got[name] == [pytest.approx(expected, abs=2e-5)] * 2, name


def test_with_motion_blur_it_is_empty(case):
    got = case("blurred")
    assert got["both"] == [
        [ZERO, ZERO],
        ["view layer 'ViewLayer': the pass Vector is empty with motion blur, as in Cycles"],
    ]
    for name in ("scene", "layer"):
        assert got[name] == [[pytest.approx([-1.0, 0.0, -1.0, 0.0], abs=2e-5)] * 2, []], name


def test_the_frame_of_the_scene_stays(case):
    got = case("frames")
    assert got["asked"] == [[1.0, 3.0, 2.0], [2, 0.0]]
    assert got["subframe"] == [[1.25, 3.25, 2.25], [2, 0.25]]
    assert got["not asked"] == [[], [2, 0.0]]


def test_places_of_objects_meshes_and_the_camera(case):
    got = case("keys")
    # The way from the frame before to that after.
    assert got["moving"] == {"Switched off": [1.0, 0.0, 0.0], "Ball": [0.0, 1.0, 0.0], "Turns over": [0.0, 0.0, 0.0]}
    assert got["shapes"] == ["Bent"]
    assert got["camera on"] == [[-0.5, 0.0, 5.0], [0.5, 0.0, 5.0]]
    assert got["camera off"] == [[0.0] * 3] * 2
    # Nothing moves in the picture.
    assert got["blur"] == [False, True, False]
    assert [line for line in got["lines"] if "frame" in line] == [
        "mesh 'Grows': the number of its vertices changes from frame to frame, as in Cycles the pass Vector shows it as if it "
        "kept its shape"
    ]


def test_other_passes_keep_their_bits(case):
    got = case("bits")
    low, high = got["seen"]
    assert got["changed"] == [] and got["more"] == ["Vector"]
    assert all(one != other for one, other in zip(low, high, strict=True))


def test_each_view_layer_has_its_own_objects(case):
    got = case("layers")
    for name in ("alone", "animation"):
        ways = [layer[0][0] for layer in got[name]]
        assert ways == [pytest.approx(-1.0, abs=2e-5), pytest.approx(-3.0, abs=2e-5)], name
