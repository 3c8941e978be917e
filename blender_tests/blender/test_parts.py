"""A window's export reads again only what the depsgraph says has changed, and gives what an export of everything gives."""

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
    got = blenders.run(which, tmp_path, "parts_cases", "edits")
    got.pop("console")
    read = {name: tuple(result[0].values()) for name, result in got.items()}
    assert read == EXPECTED
    assert not [name for name, result in got.items() if not result[1]], "another snapshot than that of an export of everything"
    assert not [name for name, result in got.items() if not result[2]], "other messages"
