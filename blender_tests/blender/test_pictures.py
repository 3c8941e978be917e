"""Images of materials, read in a render, in the bpy module of this Python and in Debian's Blender 3.4.1."""

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])
IDENTITY = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]


@pytest.fixture
def case(which, tmp_path):
    return lambda name: blenders.run(which, tmp_path, "image_cases", name)


def ramp(channels=4):
    """Return the bytes of the images in the cases."""
    return np.arange(8 * 8 * channels).reshape(8, 8, channels) * 37 % 256


def test_bit_depth_and_alpha(case):
    got = case("depths")
    images = {picture["name"]: picture for picture in got["images"]}
    # Two materials share the first image, which is exported once.
    assert got["ranges"] == [[0, 1], [0, 1], [1, 1], [2, 1], [3, 1], [4, 1], [5, 1], [6, 1]]
    wanted = {
        "opaque": (3, "uint8", "SRGB", "STRAIGHT"),
        "seen through": (4, "uint8", "SRGB", "STRAIGHT"),
        "data": (4, "uint8", "LINEAR", "CHANNEL_PACKED"),
        "packed": (4, "uint8", "SRGB", "CHANNEL_PACKED"),
        "ignored": (3, "uint8", "SRGB", "NONE"),
        "linear": (3, "uint8", "LINEAR", "STRAIGHT"),
    }
    for name, (channels, *kinds) in wanted.items():
        picture = images[name]
        assert [picture[field] for field in ("type", "transfer", "alpha")] == kinds, name
        texels = ramp(4)[..., :3] if name == "ignored" else ramp(channels)
        assert np.array_equal(picture["texels"], texels) and picture["matrix"] == IDENTITY, name
    bright = images["bright"]
    # Newer versions of Cycles follow the image's setting, though Blender keeps colour multiplied by alpha.
    alpha = "STRAIGHT" if got["version"] >= [5, 1] else "ASSOCIATED"
    assert (bright["type"], bright["transfer"], bright["alpha"]) == ("float32", "LINEAR", alpha)
    assert np.array_equal(bright["texels"], (4.0 * ramp(3) / 255.0).astype(np.float32))
    assert got["messages"] == [] and got["unchanged"]


def test_deep_files_keep_their_values_and_get_the_curve(case):
    got = case("deep")
    images = {picture["name"]: picture for picture in got["images"]}
    by_image = got["version"] >= [5, 1]
    for kind in ("PNG", "TIFF", "OPEN_EXR"):
        stored = ramp() / 255.0
        # PNG and TIFF store straight alpha, EXR associated alpha; newer versions of Cycles follow the image's setting.
        straight = "STRAIGHT" if by_image or kind != "OPEN_EXR" else "ASSOCIATED"
        premultiplied = "ASSOCIATED" if by_image or kind == "OPEN_EXR" else "STRAIGHT"
        alphas = {"STRAIGHT": straight, "PREMUL": premultiplied, "CHANNEL_PACKED": "CHANNEL_PACKED", "NONE": "NONE"}
        for mode, alpha in alphas.items():
            picture = images[f"{kind} {mode}"]
            assert (picture["transfer"], picture["alpha"]) == ("SRGB", alpha), picture["name"]
            check_stored(picture, kind, stored[..., :3] if mode == "NONE" else stored)
        assert (images[f"{kind} data"]["transfer"], images[f"{kind} data"]["alpha"]) == ("LINEAR", "CHANNEL_PACKED")
        check_stored(images[f"{kind} data"], kind, stored)
        # Decoded before interpolation: packed images, and colour spaces that need more than the sRGB curve.
        for name in ("packed", "other"):
            picture = images[f"{kind} {name}"]
            assert picture["transfer"] == "LINEAR" and picture["type"] == "float32", picture["name"]
    # Before 5.2 Cycles shows the file of an image with unsaved strokes.
    shows_file = got["version"] < [5, 2]
    assert images["held"]["transfer"] == "SRGB" and images["painted"]["transfer"] == ("SRGB" if shows_file else "LINEAR")
    assert got["unchanged"] and len(got["messages"]) == shows_file
    assert all("'painted' has unsaved changes, its file is shown" in line for line in got["messages"])
    assert got["previewed stroke"] == 0.25


def check_stored(picture, kind, values):
    """Assert texels equal to the file's values: 16-bit integers, or floats."""
    texels = np.array(picture["texels"])
    if kind == "OPEN_EXR" and picture["type"] == "float32":
        assert np.array_equal(texels.astype(np.float32), values.astype(np.float32)), picture["name"]
    else:
        assert picture["type"] == "uint16"
        assert np.array_equal(texels, np.floor(values * 65535.0 + 0.5)), picture["name"]


def test_colour_spaces_as_blender_converts_them(case):
    got = case("spaces")
    kinds = {}
    for picture in got["images"]:
        values = np.array(picture["texels"], float)
        assert picture["transfer"] == "LINEAR"
        if picture["type"] == "uint8":
            values = values / 255.0
        values = values @ np.array(picture["matrix"]).reshape(3, 3).T
        wanted = np.array(got["wanted"][picture["name"]])
        # Single precision through a file and curves with slopes up to 2^4: 2^-24 times 2^4 times the value, and some steps.
        assert np.abs(values - wanted).max() < 4e-6 * np.abs(wanted).max(), picture["name"]
        kinds[picture["name"]] = picture["type"]
    # Colour spaces that are a matrix keep bytes.
    assert sorted(kinds.values()) == ["float32", "uint8"] and kinds["Filmic sRGB"] == "float32"
    assert got["unchanged"]


def test_tiles_sequences_and_what_is_missing(case):
    got = case("files")
    tiles = [picture for picture in got["images"] if picture["name"] == "tiles"]
    has_texel = got["version"] < [5, 2]
    assert [tile["tile"] for tile in tiles] == [1001, 1002, 1011]
    for tile, shift in zip(tiles, (0, 50, 100), strict=True):
        assert np.array_equal(tile["texels"], (ramp(3) + shift) % 256)
    images = {picture["name"]: picture for picture in got["images"]}
    # Frame 11 of a sequence that starts at 10 is its second image.
    assert np.array_equal(images["sequence"]["texels"], (ramp(3) + 20) % 256)
    assert np.array_equal(images["in the file"]["texels"], (ramp(3) + 30) % 256)
    assert images["deep"]["type"] == "uint16" and np.array_equal(images["deep"]["texels"], ramp(3) * 257)
    grid = [picture for picture in got["images"] if picture["name"] == "grid"]
    assert [tile["tile"] for tile in grid] == [1001, 1002, 1011]
    for tile, shift in zip(grid, (60, 70, 80), strict=True):
        assert np.array_equal(tile["texels"], (ramp(3) + shift) % 256)
    # Before 5.2 a texel stands for the tile without a file.
    numbers = [[0, 3], [3, 1], [4, 1], [5, 1], [6, 3]]
    assert got["ranges"] == ([[0, 4], *([first + 1, count] for first, count in numbers[1:])] if has_texel else numbers)
    assert "lost" not in images and ("missing" in images) == has_texel
    told = got["messages"]
    assert len(told) == 3 and "tile 1012 of image 'tiles'" in told[0]
    assert "material 'Lost'" in told[1] and "image 'lost'" in told[1] and "has no image" in told[2]
    assert got["unchanged"]


def test_files_of_bytes_have_the_bytes_that_blender_decodes(which, tmp_path):
    got = blenders.run(which, tmp_path, "byte_cases", "kinds")
    assert got["messages"] == [] and len(got["wanted"]) == 33
    assert got["got"] == got["wanted"]
    # The other files are read as images of Blender, as all are in older versions.
    has_bytes = {name for name in got["wanted"] if not name.startswith("TARGA")}
    assert set(got["decoded"]) == (has_bytes if got["version"] >= [5, 2] else set())


def test_movies_show_the_frame_of_each_node(case):
    got = case("movie")
    # Frame n of the movie has the value 0.1 n; the second node starts two frames earlier.
    frames = [[51, 102], [51, 102], [77, 128]]
    assert got["exports"] == got["viewed"] == frames
    # Two frames are read, kept, and replaced by two others.
    assert got["counts"] == [[2, 0], [0, 2], [2, 0]]
    assert got["unchanged"]


def test_files_of_layers_show_their_first_channels(case):
    got = case("layered")
    for codec, picture in zip(got["codecs"], got["images"], strict=True):
        # Blender writes the pass Combined first; PXR24 keeps 15 bits after the point of a float.
        assert np.allclose(picture["texels"], got["wanted"], rtol=2.0**-15), codec
    assert got["messages"] == []


def test_files_of_layers_that_cannot_be_read_are_told(case):
    got = case("damaged_layers")
    assert [np.array(picture["texels"]).tolist() for picture in got["images"]] == [[[[0.5, 0.5, 0.5]]]]
    assert len(got["messages"]) == 1 and "'layers' is a multilayer EXR that cannot be read (" in got["messages"][0]


def test_frames_are_numbered_by_latin_digits(case):
    # Blender finds digits by C's isdigit, which knows 0 to 9.
    assert case("numbered") == ["frame007.png", "frame\u06637.png", "frame07\u0663.png"]
