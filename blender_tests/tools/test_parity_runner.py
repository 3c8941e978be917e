"""The runner of `make parity` with fake engines: its verdicts on their pictures, its page, and the files it reads."""

import struct

import blenders
import exr
import numpy as np
import pytest
from blenders import MODULE

from scenes.parity import figures


@pytest.fixture(scope="module")
def judged(tmp_path_factory):
    return blenders.run(MODULE, tmp_path_factory.mktemp("runner"), "parity_cases", "runner")


def test_a_message_is_asked_for_and_excuses_nothing(judged):
    assert judged["announced, equal"] == ["pass", ""]
    assert judged["announced, different"][0] == "fail"
    assert judged["not announced, equal"] == ["fail", "no message says 'Pixel Jitter'"]


def test_a_pass_that_is_not_written_is_an_error(judged):
    assert judged["ours is missing"] == ["error", "ValueError: Lancer wrote no pass Mist"]
    assert judged["theirs is missing"] == ["error", "ValueError: Cycles wrote no pass Mist"]


def test_a_picture_of_nothing_is_an_error(judged):
    assert judged["shows nothing"] == ["error", "ValueError: Cycles shows nothing in Combined"]
    assert judged["shows nothing and must"][0] == "pass"


def test_data_that_change_with_the_seed_are_refused(judged):
    """Noise of 2e-5 in a pixel is within the limit, but more than a third of it in one of a hundred pixels."""
    assert judged["data"][0] == "pass"
    assert judged["noisy data"][0] == "noise"
    assert judged["noisy data, few samples"][0] == "noise"


def test_noise_excuses_only_so_much(judged):
    """Noise of 1.2 % in a block adds less than three limits, noise of 12 % more."""
    assert judged["some noise"][0] == "noise"
    assert judged["some noise, few samples"][0] == "pass"
    assert judged["much noise, few samples"][0] == "noise"


def test_a_scene_that_raises_is_an_error(judged):
    assert judged["raises"] == ["error", "RuntimeError: no such mesh"]


def test_an_old_blender_is_no_failure(judged):
    assert judged["too new"] == ["absent", "needs Blender 99.0"]
    assert judged["gone"] == ["absent", "gone since Blender 3.0"]


def test_passes_are_put_together(judged):
    """2 + 3 + (5 + 7) 0.5 + (11 + 13) 0.25 + (17 + 19) 0.125"""
    assert judged["sum"] == 2 + 3 + 6 + 6 + 4.5


def test_distances_are_from_the_camera(judged):
    """The camera is at (1, 2, 3); one pixel shows the point (1, 2, 8), one shows (4, 6, 3), one is empty."""
    assert np.allclose(judged["distances"], [5.0, 5.0, 5.0])


@pytest.mark.parametrize("verdict, code", [("pass", 0), ("absent", 0), ("noise", 1), ("fail", 1), ("error", 1)])
def test_exit_code(judged, verdict, code):
    assert judged["exit codes"][verdict] == code


def test_page_and_record(judged):
    """The page has every scene with its verdict and its remarks, the record every scene with its figures."""
    page, record = judged["page"], judged["record"]
    for scene in record["scenes"]:
        assert f"<b>{scene['name']}</b>" in page and f'class="{scene["verdict"]}">{scene["verdict"]}<' in page
    by_name = {scene["name"]: scene for scene in record["scenes"]}
    assert "needs Blender 99.0" in page and "2 scenes: 1 fail, 1 absent" in page and "no message says" in page
    combined = by_name["shown"]["passes"]["Combined"]
    assert combined["mean"] == pytest.approx(0.5) and combined["dim"]["mean"] == pytest.approx(0.5)
    assert by_name["shown"]["limit"] == figures.KINDS["EXACT"].limit._asdict()
    assert judged["pictures"] == ["shown-cycles.png", "shown-difference.png", "shown-lancer.png"]


def _exr(layers):
    """Return the bytes of an OpenEXR file of one uncompressed part; layers: {channel: array (height, width)}."""
    height, width = next(iter(layers.values())).shape
    text = lambda name: name.encode() + b"\0"  # noqa: E731
    kinds = {np.dtype("<f4"): 2, np.dtype("<f2"): 1, np.dtype("<u4"): 0}
    channels = b"".join(text(n) + struct.pack("<iB3xii", kinds[layers[n].dtype], 0, 1, 1) for n in sorted(layers)) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    fields = (("channels", "chlist", channels), ("compression", "compression", b"\0"), ("dataWindow", "box2i", window))
    header = b"".join(text(n) + text(kind) + struct.pack("<i", len(data)) + data for n, kind, data in fields) + b"\0"
    begin = struct.pack("<ii", 20000630, 2) + header
    rows = [b"".join(layers[n][y].tobytes() for n in sorted(layers)) for y in range(height)]
    starts = np.cumsum([0] + [8 + len(row) for row in rows[:-1]]) + len(begin) + 8 * height
    chunks = b"".join(struct.pack("<ii", y, len(row)) + row for y, row in enumerate(rows))
    return begin + starts.astype("<u8").tobytes() + chunks


def test_stored_passes_are_read_as_they_are(tmp_path):
    source = np.random.default_rng(3)
    planes = {
        "ViewLayer.Combined.R": source.random((3, 5)).astype("<f4"),
        "ViewLayer.Combined.A": source.random((3, 5)).astype("<f2"),
        "ViewLayer.Combined.G": source.random((3, 5)).astype("<f4"),
        "ViewLayer.Combined.B": source.random((3, 5)).astype("<f4"),
        "ViewLayer.Index.X": source.integers(0, 9, (3, 5)).astype("<u4"),
    }
    path = tmp_path / "picture.exr"
    path.write_bytes(_exr(planes))
    got = exr.read(path)
    assert set(got) == {"Combined", "Index"}
    for index, channel in enumerate("RGBA"):
        assert np.array_equal(got["Combined"][..., index], planes[f"ViewLayer.Combined.{channel}"])
    assert np.array_equal(got["Index"][..., 0], planes["ViewLayer.Index.X"])


def test_other_files_are_refused(tmp_path):
    path = tmp_path / "picture.exr"
    path.write_bytes(b"\x89PNG" + bytes(100))
    with pytest.raises(ValueError, match="not an OpenEXR file"):
        exr.read(path)
