"""Rendered shading in a real window of Blender: its picture, edits, and its end."""

import json
import os
import subprocess
import time

import blenders
import oidn_versions
import pytest
import windows
from conftest import HERE

SCREEN = (960, 600)
# Expected output of the program about files, itself, a system without a list of disks, and Blender 4.3's keymap.
_KNOWN = (
    "register_class(...):",
    "could not get a list of mounted file-systems",
    "Blender ",
    "Info: ",
    "Read blend: ",
    "Read prefs: ",
    "Saved session recovery",
    "Saved: ",
)
_PATIENCE = 1500
ENDINGS = ("toggle", "undo", "mode", "engine", "load", "addon", "quad", "window", "f12")


@pytest.fixture(scope="module")
def display():
    with windows.screen(*SCREEN) as name:
        yield name


@pytest.fixture
def window(display, tmp_path):
    def run(case, *arguments, meanwhile=lambda process: None, **extra):
        """Run a case of in_blender/viewport_*.py and return its result; fail for any other output on the terminal."""
        script = os.path.join(HERE, "blender", "in_blender", "window_viewport.py")
        place = ["-p", "0", "0", *map(str, SCREEN)]
        # Line buffering: Blender has several buffers for the same pipe, which would break each other's lines.
        start = ["stdbuf", "-oL", blenders.program(), "--factory-startup", *place, "-P", script]
        process = subprocess.Popen(
            [*start, "--", str(tmp_path), case, *map(str, arguments)],
            env=blenders.environment(tmp_path, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1", **extra),
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
        )
        try:
            meanwhile(process)
            out, errors = process.communicate(timeout=_PATIENCE)
        finally:
            process.kill()
        said = [line for line in (out + errors).splitlines() if line and not line.startswith(_KNOWN)]
        assert process.returncode == 0, said[-20:]
        with open(tmp_path / "result.json", encoding="utf-8") as file:
            result = json.load(file)
        assert "error" not in result, result["error"]
        assert not said
        return result

    return run


def test_a_view_shows_points_where_blender_shows_them(window):
    got = window("places")
    # Blender projects in single precision: 2^-24 of some thousand pixels, times a dozen operations.
    assert {name: far for name, (far, *_) in got.items() if far > 1e-3} == {}
    rectangles = {name: values[1:5] for name, values in got.items()}
    width, height = got["free"][5:]
    assert rectangles["free"] == rectangles["camera"] == rectangles["shifted"] == [0, 0, width, height]
    left, right, bottom, top = (round(edge * side) for edge, side in ((0.2, width), (0.7, width), (0.3, height), (0.9, height)))
    assert rectangles["border"] == [left, bottom, right - left, top - bottom]
    x, y, w, h = rectangles["camera_border"]
    assert 0 < x < x + w < width and 0 < y < y + h < height and rectangles["camera_orthographic"] == [x, y, w, h]


def test_a_view_through_the_camera_is_what_f12_renders(window):
    """Equal samples except for the border's rounding by up to half a pixel, which moves edges in 8 x 8 blocks by 1/16.

    About a tenth of the blocks has an edge, with a contrast of at most the mean: the limit is 1/160.
    """
    got = window("alike")
    assert set(got) == {"camera", "shifted", "blurred", "panoramic", "camera_orthographic"}
    assert {name: value for name, value in got.items() if value > 1 / 160} == {}


def test_a_view_refines(window):
    got = window("refining")
    assert got["done"]
    sizes, samples = zip(*got["drawn"], strict=True)
    # First finer pixels, then more samples.
    assert list(sizes) == sorted(sizes, reverse=True) and sizes[-1] == 1
    assert list(samples) == sorted(samples) and samples[-1] == 16
    # A small scene may be built before the first redraw.
    assert set(got["waiting"]) <= {"Building the scene", ""}
    assert got["last"].startswith("Sample 16/16 | Error ")


def test_edits_show_the_last_picture_until_the_new_one_is_there(window):
    got = window("edits")
    assert all(result["done"] and result["always"] and result["ordered"] and result["change"] > 0.0 for result in got.values())
    assert [name for name, result in got.items() if not result["rebuilt"]] == ["film", "bounces", "turned"]


def test_a_drawing_waits_for_the_first_picture_of_an_edit(window):
    """After a wait in vain the next edit is drawn without one, and the edit after that with one."""
    got = window("waits")
    assert [waits for _, waits in got.values()] == [0, 1, 1, 0]
    assert got["long"][0] and not got["skipped"][0] and got["long again"][0]


def test_what_changes_no_picture_renders_nothing(window):
    assert window("selects") == {"same": True}


def test_colours_on_the_screen_are_those_of_the_display_transform(window, display, tmp_path):
    """The sRGB curve maps 0.5, 0.25 and 0.1 to 187.5, 136.96 and 88.9. Blender 4.3's own screenshot is black: use another."""
    middle, seen = tmp_path / "middle.json", []

    def shoot(process):
        while process.poll() is None and not middle.exists():
            time.sleep(0.1)
        x, y = json.loads(middle.read_text())
        shot = ["import", "-display", display, "-window", "root", "-crop", f"1x1+{x}+{y}", "-depth", "8", "rgb:-"]
        seen.extend(subprocess.run(shot, check=True, capture_output=True).stdout)
        (tmp_path / "shot").touch()

    window("screen", meanwhile=shoot)
    assert seen in ([187, 137, 89], [188, 137, 89])


def test_a_picture_is_drawn_the_right_way_up_with_its_alpha(window):
    got = window("canvas")
    assert got["low"] == [0.25, 0.0, 0.0, 1.0] and got["corner"] == [0.125, 0.125, 0.125, 0.5]
    # The largest number of half precision.
    assert got["high"] == [0.0, 65504.0, 0.0, 1.0]
    assert got["outside"] == got["left"] == [0.0] * 4


def test_a_view_renders_what_it_shows(window):
    """Four objects and a lamp; in local view only the ball."""
    got = window("filtered")
    assert got == {"all": [4, 1], "local": [1, 0], "without lamps": [4, 0], "done": True, "size": 2}


def test_a_view_tells_what_it_loses(window):
    """The view reports messages of export, library and denoising, each once, and an unusable camera."""
    got = window("tells")
    for word in ("(Attribute)", "without area", "shown with its noise"):
        assert [line for line in got["lines"] if word in line and "times)" not in line], word
    # The face without area is a hint.
    assert got["text"].endswith("2 messages in the render properties")
    assert got["blind"].startswith("Lancer: camera 'Camera': its scale is zero") and got["seeing"].startswith("Sample ")


def test_a_view_is_denoised(window, tmp_path):
    """Denoising by the library of this Python's bpy, which Debian's Blender lacks. An edit cancels it without leftovers."""
    path, places = oidn_versions.older(tmp_path)
    got = window("cleans", LD_PRELOAD=path, **places)
    assert [got[name]["denoised"] for name in ("on", "edited", "off")] == [True, True, False]
    assert all(got[name]["done"] for name in ("on", "edited", "off")) and got["edited"]["cleaning"] and not got["left"]
    assert got["on"]["text"].endswith(" | denoised") and "denoised" not in got["off"]["text"]
    assert max(got["on"]["differs"], got["edited"]["differs"]) < got["off"]["differs"]


def test_previews_show_materials_worlds_and_lamps(window):
    """Each preview has its own colour, whose channel is at least 1.5 times the others."""
    got = window("previews")
    assert got["rendered"] >= 3
    for name, channel in (("material", 0), ("world", 2), ("light", 1)):
        color = got["colors"][name]
        assert color[channel] > 1.5 * max(value for i, value in enumerate(color) if i != channel), name


def test_an_animation_plays(window):
    got = window("plays")
    assert got["frames"] > 2 and got["at"] > 2
    # Curves move an object, and nothing is read again.
    assert got["read"] == {"objects": 0, "meshes": 0, "shaders": 0, "images": 0}


def test_two_views_and_a_render_share_the_scene(window):
    """The second view adds its pictures and what Blender and Python allocate, no copy of the scene."""
    got = window("shared")
    parts, records = got["common"]
    # Five meshes, four materials that all read alike, a lamp and the world.
    assert parts > 5 and records == 5
    assert got["scene"] > 20.0 and got["second"] < 0.2 * got["scene"]


def test_changing_the_size_of_a_view_leaks_no_copy_of_the_scene(window):
    """A leak of the scene's copy at each of ten changes would be ten copies of the arrays."""
    got = window("resized")
    assert got["copy"] > 8.0 and got["growth"] < 3.0 * got["copy"]


@pytest.mark.parametrize("kind", ENDINGS)
def test_whatever_ends_a_view_leaves_nothing_behind(window, kind):
    assert window("stress", kind, 3) == {"went": 3, "views": 1, "left": []}


def test_the_program_can_be_left_while_a_view_renders(window):
    assert window("leave")["rendered"]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ENDINGS)
def test_a_hundred_endings(window, kind):
    assert window("stress", kind, 100) == {"went": 100, "views": 1, "left": []}


@pytest.mark.slow
def test_a_hundred_leavings(window):
    for _ in range(100):
        assert window("leave")["rendered"]
