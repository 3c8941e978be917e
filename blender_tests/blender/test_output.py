"""Files, metadata, slots, frames, strips, composites and sets: what Blender makes of Lancer's pictures, and of Cycles'."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])
RED, GREEN, BLUE, GREY = "0.75 0.125 0.0625 1", "0.125 0.5 0.25 1", "0 0.25 1 1", "0.25 0.25 0.25 1"


@pytest.fixture
def case(which, tmp_path):
    """Return a function that returns Lancer's result of a case, which must be Cycles' own."""

    def run(where, name, *arguments):
        got = blenders.run(which, tmp_path, where, name, *arguments)
        assert got["LANCER"] == got["CYCLES"]
        return got["LANCER"]

    return run


def test_layers_and_passes_in_one_file(case):
    got = case("output_cases", "layered")
    for depth, kind in (("16", "float16"), ("32", "float32")):
        first, second = got[depth]["ViewLayer"], got[depth]["Second"]
        # The second layer lacks the red patch. Data have full floats always.
        assert first["Combined"] == [kind, [8, 16, 4], {GREEN: 16, RED: 16, GREY: 96}]
        assert second["Combined"] == [kind, [8, 16, 4], {GREEN: 16, GREY: 112}]
        assert first["Depth"] == ["float32", [8, 16, 1], {"5": 32, "1e+10": 96}]
        assert len(first) == len(second) == 4
    assert got["part"]["ViewLayer"]["Combined"] == ["float16", [6, 12, 4], {GREEN: 16, RED: 8, GREY: 48}]
    assert got["part"]["Second"]["Combined"] == ["float16", [6, 12, 4], {GREEN: 16, GREY: 56}]


def test_metadata(case):
    got = case("output_cases", "stamped")
    for kind in ("exr", "png"):
        assert got[kind]["own"] == ["Second", "ViewLayer"] and {"Camera", "Frame", "Note", "Scene"} <= set(got[kind]["others"])
    assert got["burned"]


def test_slots_keep_their_pictures(case):
    assert case("output_cases", "slots") == {"0": {RED: 16, GREY: 112}, "1": {BLUE: 16, GREY: 112}, "2": False}


def test_names_of_written_stills(case):
    assert case("output_cases", "written") == {"none": False, "files": ["./bare", "new/still_##.png"], "layer": {GREY: 128}}


def test_frames_that_are_there_and_placeholders(case):
    got = case("output_cases", "animated")
    # Sizes at the start of each frame: its own file is a placeholder, the third is the one that was there before.
    assert [sorted(files) for files in got["seen"]] == [
        ["0001", "0003"],
        ["0001", "0003", "0005"],
        ["0001", "0003", "0005", "0007"],
    ]
    assert [[name for name, full in files.items() if full] for files in got["seen"]] == [[], ["0001"], ["0001", "0005"]]
    assert (got["written"], got["kept"], got["again"]) == ([1, 5, 7], 4, [])
    assert got["frames"] == {"0001": 0, "0005": 4, "0007": 6} and got["replaced"] == 2


def test_strips_of_scenes(case):
    got = case("joined_cases", "sequenced")
    assert got["frames"] == [{GREEN: 16, BLUE: 112}] * 2 + [{RED: 16, GREY: 112}] * 2
    assert got["places"] == [None, None, 0, 1]


def test_composite_of_layers_and_scenes(case):
    got = case("joined_cases", "composed")
    # The sum of grey, grey and blue; of the red patch with its index of 3, grey and blue; of grey, grey and the green patch.
    assert got["on"] == {"0.5 0.75 1.5 1": 96, "4 3.625 4.3125 1": 16, "0.625 1 0.75 1": 16}
    assert got["off"] == {RED: 16, GREY: 112}


def test_sets_of_sets(case):
    got = case("joined_cases", "with_set")
    assert got["1"] == {RED: 16, GREEN: 16, BLUE: 16, GREY: 80} and got["top 1"] == [0.0, 0.25, 1.0, 1.0]
    # In the second frame the patch of the inner set has moved down by one pixel.
    assert got["2"] == got["1"] and got["top 2"] == [0.25, 0.25, 0.25, 1.0]


def test_thousands_of_objects_in_a_hundred_collections(case):
    # Collection n holds 2 n and 2 n + 1: hidden are 9 and all below it, excluded is 17 alone with all below it.
    def shown(collection):
        return collection == 0 or collection not in (9, 17) and shown(collection // 2)

    # The sky is 0.25, two of eight levels.
    pixels = [2.0] * (64 * 48)
    for number in range(3000):
        if shown(1 + number % 100):
            pixels[number] = number * 5 % 8 + 1.0
    for number in (0, 20, 84):
        for pixel in (number, number + 1, number + 64, number + 65):
            pixels[pixel] = 8.0
    assert case("joined_cases", "crowded") == pixels
