"""Images beyond the limit of memory are read from a file, and the picture keeps its bits."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

BLOCK = 64 * 64
# 1030 x 517 texels.
BLOCKS = 17 * 9


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_the_picture_keeps_its_bits(which, tmp_path):
    got = blenders.run(which, tmp_path, "scratch_cases", "bits")
    # The colour of straight alpha is multiplied in the file. Small images and the sky stay in memory.
    wanted = {
        "straight": [True, "ASSOCIATED"],
        "opaque": [True, "STRAIGHT"],
        "packed": [True, "CHANNEL_PACKED"],
        "bright": [True, "ASSOCIATED"],
        "small": [False, "STRAIGHT"],
        "sky": [False, "STRAIGHT"],
    }
    assert got["images"] == wanted and all(got["rows"])
    assert got["equal"] and got["loaded"] and got["varied"] > 0.01
    texels = 1030 * 517
    assert got["before"] == [texels * (4 + 3 + 4 + 16 + 3) + 8 * 8 * 3, 0]
    assert got["after"] == [texels * 3 + 8 * 8 * 3, BLOCKS * BLOCK * (4 + 3 + 4 + 16)]
    assert got["messages"][0] == got["messages"][1]
    assert (got["open"], got["left"]) == (1, 0)


def test_no_file_is_left(tmp_path):
    got = blenders.run(MODULE, tmp_path, "scratch_cases", "ends")
    assert (got["left"], got["failed"]) == ([0, 0, 0], True)
    assert got["mapped"] == BLOCKS * BLOCK * (4 + 3 + 4 + 16)


def test_a_full_disk_leaves_images_in_memory(tmp_path):
    got = blenders.run(MODULE, tmp_path, "scratch_cases", "full")
    assert got["moved"] == 0
    (line,) = [line for line in got["messages"] if "stay in memory" in line]
    assert "No space left on device" in line


def test_a_full_disk_is_told_where_layers_need_it(tmp_path):
    got = blenders.run(MODULE, tmp_path, "scratch_cases", "full_for_layers")
    (line,) = got["messages"]
    assert "needs a temporary file: No space left on device" in line and got["sizes"] == [[1, 1, 3]]


def test_the_limit_follows_the_preferences(tmp_path):
    before, after = blenders.run(MODULE, tmp_path, "scratch_cases", "changed_limit")
    assert before == 0 and after > 0
