"""Motion blur: keys are read at the times of the shutter, and the scene's own frame stays."""

import blenders
import pytest
from blenders import MODULE, PROGRAM

both = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@both
def test_the_frame_of_the_scene_stays(which, tmp_path):
    got = blenders.run(which, tmp_path, "motion_cases", "frames")
    # The middle is read first: only a shutter beside the frame moves it before.
    assert got["CENTER"] == [[1.5, 2.5, 2.0], [2, 0.0]]
    assert got["START"] == [[2.5, 2.0, 3.0, 2.0], [2, 0.0]]
    assert got["END"] == [[1.5, 1.0, 2.0, 2.0], [2, 0.0]]
    assert got["failed"] == [[1.5, 2.0], [2, 0.0]] and "no more" in got["failed text"]
    assert got["cancelled"] == [[1.5, 2.0], [2, 0.0]]


@both
def test_frames_of_an_animation_share_times(which, tmp_path):
    got = blenders.run(which, tmp_path, "motion_cases", "animation")
    # The shutter of a frame opens when that of the frame before closes.
    assert got["frames"] == [0.5, 1.5, 1.0, 2.5, 2.0, 3.5, 3.0]
    assert got["same"] == [True] * 3


@both
def test_keys_of_objects_and_meshes(which, tmp_path):
    got = blenders.run(which, tmp_path, "motion_cases", "keys")
    # Two units in four frames, with the shutter open for one frame: half a unit. Two steps are five keys.
    slid = {name: [3, [0.5, 0.0, 0.0]] for name in ("Ball", "Leans", "Leans unmirrored")}
    assert got["moving"] == {"Cube": [5, [0.5, 0.0, 0.0]], **slid}
    assert list(got["shapes"].values()) == [3] and len(got["shapes"]) == 1
    assert got["camera"] == 0
    told = [line for line in got["lines"] if "vertices" in line]
    assert told == ["mesh 'Grows': the number of its vertices changes within the shutter, as in Cycles it is not blurred then"]
    lamps = [line for line in got["lines"] if line.startswith("light")]
    assert lamps == ["light 'Lantern': moves within the shutter, as in Cycles it shines from its place in the middle of it"]
    worlds = [line for line in got["lines"] if line.startswith("world")]
    assert worlds == ["world 'World': its nodes are animated, as in Cycles it shines as in the middle of the shutter"]
    flat = [line for line in got["lines"] if "scale is 0" in line]
    assert flat == ["object 'Turns over': a scale is 0 within the shutter; its motion is not blurred"]
    sheared = [line for line in got["lines"] if "sheared" in line]
    assert sheared == [
        "object 'Leans': moves while it is mirrored and sheared, Cycles shears it another way, here it keeps its shape"
    ]


@both
def test_instances_are_known_by_their_numbers(which, tmp_path):
    got = blenders.run(which, tmp_path, "motion_cases", "instances")
    assert got["count"] >= 3 and got["ways"]
    # Each goes up by 1 / 48 in half a frame, by less when it is born, or stands where another time lacks it: no particle takes
    # the place of another one.
    for way in got["ways"]:
        assert all(x == 0.0 and y == 0.0 and 0.0 <= z <= 1 / 48 + 1e-3 for x, y, z in way), way


@both
def test_shutters_of_no_time_and_of_a_million_frames(which, tmp_path):
    got = blenders.run(which, tmp_path, "motion_cases", "shutters")
    assert got["closed"] and not got["blurred"]
    # The glowing cube stands at one end of its way before its keys and at the other after them: in sight, at equal distances
    # that are at most 1.02 times that in the middle.
    assert got["finite"] and got["frame"] == [2, 0.0]
    sharp, without = got["ends"]
    assert without == 0.0 and 0.5 * sharp < got["long"] < 2.0 * sharp


def test_times_are_those_of_cycles(tmp_path):
    got = blenders.run(MODULE, tmp_path, "motion_cases", "curve")
    # Entries of 256 stand for u = (i + 1/2) / 256, of which the sums have 255 steps: times u 255 / 256.
    low, high, least = got["even"]
    assert low == pytest.approx(0.5 * 255 / 256**2, abs=1 / 2048) and high == pytest.approx(255.5 * 255 / 256**2, abs=1 / 2048)
    assert least > 0.99
    # The mean of a density 2 t is 2/3; the table moves it by up to two of its 256 steps.
    assert got["rising"] == pytest.approx(2 / 3, abs=2 / 256)
    assert got["closed"] == [1.0, 1.0]
