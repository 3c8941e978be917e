"""Wrong scenes inside Blender: always a picture or a clear refusal, always words that name the thing, never a crash."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

# case -> words that one message must hold (None: nothing has to be said)
PICTURES = {
    "nan_vertices": ["Cube"],
    "infinite_vertices": ["Cube"],
    "huge_vertices": None,
    "zero_area_faces": ["Cube"],
    "loose_edges": None,
    "no_faces": None,
    "spare_uv_layers": None,
    "singular_matrix": ["Cube"],
    "nan_matrix": ["Cube"],
    "mirrored": None,
    "negative_power": ["Light"],
    "nan_power": ["Light"],
    "infinite_power": ["Light"],
    "nan_radius": ["Light"],
    "zero_area_light": None,
    "missing_slot": None,
    "missing_image": ["Material"],
    "unsupported_node": ["Fur"],
    "wild_material": ["Wild"],
    "empty_scene": None,
    "panoramic_camera": ["Camera"],
    "no_world_no_light": None,
    "text_metaballs_and_curves": None,
}
DARK = {"empty_scene", "no_world_no_light"}


@pytest.mark.parametrize("name", PICTURES)
def test_pictures(name, tmp_path):
    got = blenders.run(MODULE, tmp_path, "bad_cases", name)
    assert got["error"] == "" and got["finite"]
    assert (got["mean"] == 0.0) if name in DARK else (1e-3 < got["mean"] < 1e3), got["mean"]
    if PICTURES[name]:
        assert any(all(word in line for word in PICTURES[name]) for line in got["messages"]), got["messages"]


@pytest.mark.parametrize(
    "name", ["nan_vertices", "singular_matrix", "nan_power", "missing_slot", "missing_image", "empty_scene"]
)
def test_pictures_in_blender_3(name, tmp_path):
    got = blenders.run(PROGRAM, tmp_path, "bad_cases", name)
    assert got["error"] == "" and got["finite"]
    if PICTURES[name]:
        assert any(all(word in line for word in PICTURES[name]) for line in got["messages"]), got["messages"]


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize(
    "name, word", {"no_camera": "camera", "camera_is_no_camera": "camera", "smallest_picture": "small"}.items()
)
def test_refusals(which, name, word, tmp_path):
    """Python gets the sentence as an exception; the program in the background may also end with exit code 1."""
    code, said, value = blenders.attempt(which, tmp_path, "bad_cases", name)
    assert code in ((0,) if which == MODULE else (0, 1)), said[-2000:]
    told = value["error"] if value else said
    assert word in told.lower(), said[-2000:]
