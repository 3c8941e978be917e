"""What the frames of an animation have in common is read once, and every frame is the picture of its own render."""

import blenders
import pytest
from blenders import MODULE, PROGRAM


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
