"""Images that Cycles reads from its texture cache have mipmaps, others none, and levels in a file give the same picture."""

import blenders
import pytest
from blenders import MODULE, PROGRAM


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_images_with_a_file_have_mipmaps_if_the_scene_uses_the_cache(which, tmp_path):
    got = blenders.run(which, tmp_path, "texture_cache_cases", "asked")
    assert got["file"] == [[0], [1]]
    assert got["packed"] == got["memory"] == [[0], [0]]
    # The rotation, which Cycles takes as constant over a pixel.
    assert got["steady"] == [[], ["TRANSFORM"]]


def test_an_operation_whose_change_is_not_followed_is_told(tmp_path):
    without, told = blenders.run(MODULE, tmp_path, "texture_cache_cases", "unfollowed")["lines"]
    (line,) = set(told) - set(without)
    assert "Vector Math" in line and "come from Power are sharper than in Cycles" in line


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_levels_in_a_file_give_the_same_picture(which, tmp_path):
    got = blenders.run(which, tmp_path, "texture_cache_cases", "bits")
    assert got["moved"] == [True] and got["equal"] and got["differs"]


def test_files_of_the_cache_are_found_by_name_and_time(tmp_path):
    got = blenders.run(MODULE, tmp_path, "texture_cache_cases", "files")
    found = {name for name, is_found in got.items() if is_found}
    assert found == {"makes", "beside", "given"}


def test_settings_are_those_of_the_running_blender(tmp_path):
    got = blenders.run(MODULE, tmp_path, "texture_cache_cases", "settings")
    assert got["found"] == ([False, True, None] if got["has"] else [None] * 3)


def test_a_window_reads_images_again_when_the_scene_asks_for_the_cache(tmp_path):
    got = blenders.run(MODULE, tmp_path, "texture_cache_cases", "changed")
    assert got["found"] == [[0], [0], [1]]
