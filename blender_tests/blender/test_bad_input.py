"""Invalid scenes inside Blender give a picture or an error, with messages that name the object, and never a crash."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

# Case -> words that one message must contain (None: no message required).
PICTURES = {
    "nan_vertices": ["Cube"],
    "infinite_vertices": ["Cube"],
    "huge_vertices": None,
    "zero_area_faces": ["Cube"],
    "loose_edges": ["Wire", "faces"],
    "no_faces": ["Dust", "faces"],
    "spare_uv_layers": None,
    "singular_matrix": None,
    "no_area": ["Cube", "area"],
    "nan_matrix": ["Cube"],
    "mirrored": None,
    "negative_power": None,
    "nan_power": ["Light"],
    "infinite_power": ["Light"],
    "nan_radius": ["Light"],
    "zero_area_light": ["Light", "area"],
    "missing_slot": ["Cube", "slot 2", "empty"],
    "missing_image": ["Material", "Plane"],
    "unsupported_node": ["Fur", "Cube"],
    "wild_material": ["Wild", "Cube"],
    "empty_scene": None,
    "panoramic_camera": None,
    "no_world_no_light": None,
    "text_metaballs_and_curves": None,
}
# A list of words for each message of `unsupported_features`; there must be no other messages.
UNSUPPORTED = [
    ["object 'Cube'", "hair", "'Fluff'"],
    ["view layer", "Subsurface Direct"],
    ["view layer", "Freestyle"],
    ["object 'Cube'", "shadow caustics"],
]
DARK = {"empty_scene", "no_world_no_light"}


@pytest.mark.parametrize("name", PICTURES)
def test_pictures(name, tmp_path):
    got = blenders.run(MODULE, tmp_path, "bad_cases", name)
    assert got["error"] == "" and got["finite"]
    assert (got["mean"] == 0.0) if name in DARK else (1e-3 < abs(got["mean"]) < 1e3), got["mean"]
    if PICTURES[name]:
        assert any(all(word in line for word in PICTURES[name]) for line in got["messages"]), got["messages"]


@pytest.mark.parametrize("name", ["nan_vertices", "no_area", "nan_power", "missing_slot", "missing_image", "empty_scene"])
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
    """Python gets the message as an exception; in background mode the program may also end with exit code 1."""
    code, said, value = blenders.attempt(which, tmp_path, "bad_cases", name)
    assert code in ((0,) if which == MODULE else (0, 1)), said[-2000:]
    told = value["error"] if value else said
    assert word in told.lower(), said[-2000:]


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_unsupported_features_are_told(which, tmp_path):
    got = blenders.run(which, tmp_path, "bad_cases", "unsupported_features")
    assert got["error"] == "" and got["finite"]
    for words in UNSUPPORTED:
        assert any(all(word in line for word in words) for line in got["messages"]), (words, got["messages"])
    assert len(got["messages"]) == len(UNSUPPORTED), got["messages"]
    # Rendered passes are not reported as missing.
    rendered = ("Depth", " Z", "Mist", "Diffuse")
    assert not any(name in line for line in got["messages"] for name in rendered), got["messages"]


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_the_factory_scene_warns_of_nothing(which, tmp_path):
    got = blenders.run(which, tmp_path, "bad_cases", "factory_scene")
    assert got["error"] == "" and got["finite"] and got["mean"] > 0.0
    assert got["messages"] == [] and "Warning" not in got["console"], got["console"]
