"""Views and animations read only changed data again, and give the snapshot of a full export."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

# Numbers of objects, meshes, shaders (materials, lamp and world) and images read after each edit. The scene has seven objects,
# six meshes, five materials, a lamp, a world and two images.
ALL = (7, 6, 7, 2)
MOVED, WALKED = (0, 0, 0, 0), (7, 0, 0, 0)
MESH, SHADER, SHADER_AND_PICTURE = (7, 1, 0, 0), (7, 0, 1, 0), (7, 0, 1, 1)
EXPECTED = {
    "first": ALL,
    # The cursor belongs to the scene, whose update does not name it.
    "nothing": MOVED,
    "moved object": MOVED,
    "moved twice": MOVED,
    "moved camera": MOVED,
    "moved lamp": WALKED,
    # A material uses the empty's coordinates.
    "moved place": SHADER,
    "edited material": SHADER,
    "edited group": SHADER,
    # Two objects share the mesh.
    "edited mesh": MESH,
    "edited world": SHADER,
    "edited lamp": SHADER,
    "animated frame": MESH,
    # Two frames, and the shape key of one object in each.
    "still frame": (14, 2, 0, 0),
    "hidden object": (6, 0, 0, 0),
    "shown object": (7, 1, 1, 1),
    "painted picture": SHADER_AND_PICTURE,
    # The export has read both images before.
    "other picture": SHADER,
    # The modifier is added to one of two objects that share a mesh.
    "modifier": (7, 2, 0, 0),
    "hidden in the view": (6, 0, 0, 0),
    "others hidden in the view": (6, 1, 1, 0),
}
# Records that are uploaded after an edit, and parts of the library's scene that its commit makes; no entry is neither. Places
# of objects are made together, with their search for faces in one plane; trees of meshes that small are part of the places.
PLACED = {"placements": 1, "plane_searches": 1}
WORK = {
    "first": ({"Image": 2, "MeshData": 6, "Material": 5, "Light": 1, "World": 1}, {"materials": 5, **PLACED}),
    "moved object": ({}, PLACED),
    "moved twice": ({}, PLACED),
    "moved lamp": ({"Light": 1}, {}),
    "moved place": ({"Material": 1}, {"materials": 1}),
    "edited material": ({"Material": 1}, {"materials": 1}),
    "edited group": ({"Material": 1}, {"materials": 1}),
    "edited mesh": ({"MeshData": 1}, PLACED),
    "edited world": ({"World": 1}, {}),
    "edited lamp": ({"Light": 1}, {}),
    "animated frame": ({"MeshData": 1}, PLACED),
    # The shape ends with the first of two frames.
    "still frame": ({"MeshData": 1}, PLACED),
    "hidden object": ({}, PLACED),
    "shown object": ({"MeshData": 1, "Material": 1}, {"materials": 1, **PLACED}),
    "other picture": ({"Material": 1}, {"materials": 1}),
    # An image that stands for the one that is not used any more.
    "modifier": ({"Image": 1, "MeshData": 1}, PLACED),
    "hidden in the view": ({}, PLACED),
    "others hidden in the view": ({"MeshData": 1, "Material": 1}, {"materials": 1, **PLACED}),
}


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_edits(which, tmp_path):
    """A window's export reads only what the depsgraph reports as changed, and only that is uploaded and made."""
    got = blenders.run(which, tmp_path, "parts_cases", "edits")
    got.pop("console")
    # Before 5.2 strokes that are not saved are not shown, as in Cycles: the image is the same.
    painted = ({"Material": 1, **({"Image": 1} if got.pop("strokes") else {})}, {"materials": 1})
    read = {name: tuple(result[0].values()) for name, result in got.items()}
    assert read == EXPECTED
    assert {name: tuple(result[4:]) for name, result in got.items() if any(result[4:])} == {**WORK, "painted picture": painted}
    assert not [name for name, result in got.items() if not result[1]], "another snapshot than that of an export of everything"
    assert not [name for name, result in got.items() if not result[2]], "other messages"


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_edits_of_properties(which, tmp_path):
    """A window's export follows the properties that Attribute nodes read."""
    got = blenders.run(which, tmp_path, "parts_cases", "property_edits")
    got.pop("console")
    assert not [name for name, result in got.items() if not result[1]], "another snapshot than that of an export of everything"
    shaders = {name: result[0]["shaders"] for name, result in got.items()}
    # The material that reads the view layer is read at each update; the world's own update changes the world, too.
    assert shaders == {"first": 3, "object": 0, "moved object": 0, "view layer": 1, "scene": 1, "world": 2}


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_edits_of_lamps(which, tmp_path):
    """A window's export follows the objects and instancers that show a lamp, and the texts that its nodes read."""
    got = blenders.run(which, tmp_path, "lamp_edit_cases", "edits")
    got.pop("console")
    assert not [name for name, result in got.items() if not result[1]], "another snapshot than that of an export of everything"
    assert not [name for name, result in got.items() if not result[2]], "other messages"


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_edits_between_pictures(which, tmp_path):
    """With Persistent Data a picture reads only what has changed since the one before, and moved objects at once."""
    got = blenders.run(which, tmp_path, "picture_edit_cases", "pictures")
    got.pop("console")
    assert not [name for name, result in got.items() if not result[1]], "another snapshot than that of an export of everything"
    assert not [name for name, result in got.items() if not result[2]], "other messages"
    moves = {name for name, result in got.items() if not any(result[0].values())}
    # Without surfaces there is no object to read.
    still = {"nothing", "output path", "no surfaces", "collection"}
    assert moves == {*still, "moved object", "stretched object", "moved camera", "moved parent", "frame", "frame again"}


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_an_animation_reads_packed_files_once(which, tmp_path):
    """The first frame reads the file with its texels; a script may pack another one before the next render."""
    assert blenders.run(which, tmp_path, "picture_edit_cases", "packed") == [[0, 0, 0, 0], [1]]


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_images_do_not_accumulate(which, tmp_path):
    """Lamps share the table of a text, and later tables take the places of those not used any more."""
    got = blenders.run(which, tmp_path, "lamp_edit_cases", "growth")
    counts, same = got
    # The place of a table is free after the export that reads the next one.
    assert counts == [1, 2, 2, 2, 2, 2] and all(same)


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize("persistent", ["no", "yes"])
def test_frames_keep_what_does_not_change(which, tmp_path, persistent):
    """Four of nine meshes change, by a shape key, two modifiers and a face's slot; one of two image files is rewritten."""
    got = blenders.run(which, tmp_path, "kept_cases", "frames", persistent)
    # A render of a single frame has no cache and no counts.
    assert got["alone"] == [[None] * 4] * 3
    # Blender reports the new material of an object as a change of its shape, which only a cache that compares sees through.
    read = 5 if persistent == "yes" else 4
    assert got["counts"] == [[9, 0, 2, 0], *[[read, 9 - read, 1, 1]] * 2]
    assert min(got["bytes"]) > 0 and min(got["changes"]) > 0.01
    assert got["differences"] == [0.0] * 3
    # Persistent Data keeps the cache for the next render, but not for another file.
    assert got["left"] == (1 if persistent == "yes" else 0) and got["after another file"] == 0


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize("persistent", ["no", "yes"])
def test_a_long_animation_takes_no_more_memory(which, tmp_path, persistent):
    """In each of 100 frames a mesh, a material and particles change.

    From frame 30 on there are as many particles. A frame's mesh is 0.6 MB; 40 meshes of a leak would be 24 MB.
    """
    got = blenders.run(which, tmp_path, "kept_cases", "long", persistent, "100")
    given = got["given"]
    assert len(given) == 100 and max(given[90:]) - max(given[40:50]) < 2**20
    assert got["differences"] == [0.0] * 3 and min(got["changes"]) > 0.01
