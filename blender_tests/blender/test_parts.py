"""Views and animations read again only what has changed, and give what an export of everything gives."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

# What is read after each edit: objects, meshes, shaders (materials and world), pictures. Seven objects show six meshes, five
# materials and a world two pictures.
ALL = (7, 6, 6, 2)
MOVED, WALKED = (0, 0, 0, 0), (7, 0, 0, 0)
MESH, SHADER, SHADER_AND_PICTURE = (7, 1, 0, 0), (7, 0, 1, 0), (7, 0, 1, 1)
EXPECTED = {
    "first": ALL,
    "nothing": WALKED,
    "moved object": MOVED,
    "moved twice": MOVED,
    "moved camera": MOVED,
    "moved lamp": WALKED,
    # Its place is a material's coordinates.
    "moved place": SHADER,
    "edited material": SHADER,
    "edited group": SHADER,
    # Two objects show it.
    "edited mesh": MESH,
    "edited world": SHADER,
    "edited lamp": WALKED,
    "animated frame": MESH,
    # Two frames, and the shape key of one object in each.
    "still frame": (14, 2, 0, 0),
    "hidden object": (6, 0, 0, 0),
    "shown object": (7, 1, 1, 1),
    "painted picture": SHADER_AND_PICTURE,
    # Both are there already.
    "other picture": SHADER,
    # Of two objects that have shared a mesh.
    "modifier": (7, 2, 0, 0),
}


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_edits(which, tmp_path):
    """Of a window, by what the depsgraph says has changed."""
    got = blenders.run(which, tmp_path, "parts_cases", "edits")
    got.pop("console")
    read = {name: tuple(result[0].values()) for name, result in got.items()}
    assert read == EXPECTED
    assert not [name for name, result in got.items() if not result[1]], "another snapshot than that of an export of everything"
    assert not [name for name, result in got.items() if not result[2]], "other messages"


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize("persistent", ["no", "yes"])
def test_frames_keep_what_does_not_change(which, tmp_path, persistent):
    """Of nine meshes a shape key, two modifiers and a face's slot change one each; of two pictures one file is written anew."""
    got = blenders.run(which, tmp_path, "kept_cases", "frames", persistent)
    # A render of one frame keeps nothing, and tells nothing of it.
    assert got["alone"] == [[None] * 4] * 3
    assert got["counts"] == [[9, 0, 2, 0], [4, 5, 1, 1], [4, 5, 1, 1]]
    assert min(got["bytes"]) > 0 and min(got["changes"]) > 0.01
    assert got["differences"] == [0.0] * 3
    # Persistent Data is for the next render, too, but not for another file.
    assert got["left"] == (1 if persistent == "yes" else 0) and got["after another file"] == 0
