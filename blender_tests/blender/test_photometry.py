"""The IES Texture tells of files that Cycles does not read, and of those that Lancer alone does not."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

_ENDS_EARLY = "the file ends before its last number"
# As in Cycles.
_REFUSED = {
    "no last number": _ENDS_EARLY,
    "underscore": _ENDS_EARLY,
    "another type": "this Blender does not read photometry of type 4",
}
_UNSUPPORTED = {
    **dict.fromkeys(("infinite", "no number", "large", "large factors"), "the file has numbers that are not finite"),
    "descending": "the angles of the file do not ascend",
}


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
def test_files(which, tmp_path):
    got = blenders.run(which, tmp_path, "photometry_cases", "files")
    assert "Warning" not in got["console"]
    expected = {name: [[[], []]] * 2 for name in got["files"]}
    for name, reason in _REFUSED.items():
        expected[name] = [[[f"{reason}, as in Cycles the strength is 100 everywhere"], []]] * 2
    for name, reason in _UNSUPPORTED.items():
        text = f"{reason}, which is not supported, the strength is 100 everywhere"
        expected[name] = [[[text], ["feature:photometric file"]]] * 2
    # Blender itself takes old line ends of a text as new ones, or leaves them.
    outside, _ = got["files"].pop("old line ends")
    del expected["old line ends"]
    assert outside == [["the file has no line TILT=, as in Cycles the strength is 100 everywhere"], []]
    if tuple(got["version"]) < (3, 6):
        text = "the file has nothing after its last number, as in Cycles the strength is 100 everywhere"
        expected["open end"] = [[[text], []], [[], []]]
    assert got["files"] == expected
