"""A scene gives the same picture at any size and place.

The core normalises lengths by a power of two of the scene's extent, about its centre, so that a power of two as factor changes
no bit. Other factors and places change last bits, of lamps in single precision, of all else in double, which is some 1e-7 of a
pixel's value. A path with another hit would change a square of 64 pixels of 8 samples each by 1 / 512; the limit 1e-4 lies
between.
"""

import dataclasses

import blenders
import numpy as np
import pytest
import ten_scenes
import trimesh
from ten_scenes import PIXELS, TEN, moved, resized, resized_meshes
from tiny_scenes import lambert, look_at, move, plane, quad, rotate_x, scale, scene, sphere

from addon.bindings.enums import CameraKind, InstanceKind, LightKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Instance, Light, Material, MeshData

SIZES = (1e-6, 1e-3, 1e3, 1e6, 1e9)
POWERS = (-30, -20, 20, 30)
# A thousand and a million times the scenes' extent of some 8 units.
PLACES = ((8192.0, -4096.0, 2048.0), (2.0**23, -(2.0**22), 2.0**23))
# Passes of lengths or positions.
LENGTHS = (Pass.DEPTH, Pass.POSITION, Pass.DENOISING_DEPTH)


def passes(shot):
    with Session.upload(shot) as session:
        assert session.render_all()
        assert session.statistics().invalid_samples == 0 and not session.messages()
        return {which: session.read(which).astype(np.float64) for which in map(Pass, shot.settings.passes)}


def assert_same_squares(one, other, what):
    def squares(picture):
        return picture.reshape(PIXELS // 8, 8, PIXELS // 8, 8, -1).mean(axis=(1, 3))

    for which in set(one).difference(LENGTHS):
        message = f"{what}: {which!r}"
        np.testing.assert_allclose(squares(other[which]), squares(one[which]), rtol=1e-4, atol=0, err_msg=message)


@pytest.mark.parametrize("make", TEN, ids=lambda f: f.__name__)
def test_powers_of_two_change_no_bit(library, make):
    shot = make()
    expected = passes(shot)
    assert expected[Pass.COMBINED][..., :3].mean() > 0.02
    for power in POWERS:
        for resize in (resized, resized_meshes):
            got = passes(resize(shot, 2.0**power))
            for which, values in expected.items():
                # The depth of the background is a constant.
                factor = np.where(values < 1e10, 2.0**power, 1.0) if which in LENGTHS else 1.0
                assert np.array_equal(got[which], factor * values), (power, resize.__name__, which)


@pytest.mark.parametrize("make", TEN, ids=lambda f: f.__name__)
def test_sizes(library, make):
    shot = make()
    expected = passes(shot)
    for factor in SIZES:
        assert_same_squares(expected, passes(resized(shot, factor)), factor)


@pytest.mark.parametrize("make", TEN, ids=lambda f: f.__name__)
def test_places(library, make):
    shot = make()
    expected = passes(shot)
    for offset in PLACES:
        assert_same_squares(expected, passes(moved(shot, offset)), offset)


@pytest.mark.parametrize("far, larger", [(8192.0, 1.0), (2.0**23, 8.0)])
def test_vertices_that_are_far_away_themselves(library, far, larger):
    """A mesh with distant vertices, on a grid that is exact in float there, and an unchanged object origin."""
    rock = ten_scenes.ROCK
    corners = larger * np.array(rock.positions, float)
    offset = np.array((far, -far / 2, far))
    size = np.abs(corners).max()

    def shot(there):
        meshes = [MeshData("rock", corners + there, rock.triangles)]
        assert np.array_equal(meshes[0].positions.astype(float), corners + there)
        lamps = [Light("sun", rotate_x(0.7), LightKind.SUN, emission=(2.0,) * 3)]
        eye = np.array((0, -4 * size, 2 * size))
        camera = Camera(matrix=look_at(eye, (0, 0, 0)), width=PIXELS, height=PIXELS, clip_start=0.1, clip_end=1e3)
        camera = dataclasses.replace(camera, matrix=camera.matrix + [[0, 0, 0, x] for x in there])
        return scene([Instance()], [lambert(0.7)], lamps, meshes, 0.3, camera, samples=8, max_bounces=3)

    expected = passes(shot(np.zeros(3)))
    assert expected[Pass.COMBINED][..., :3].std() > 0.05
    assert_same_squares(expected, passes(shot(offset)), far)


# ---- no shadow acne, no leak, in any pixel ----


def everywhere(shot):
    yield "here", shot
    for factor in SIZES:
        yield factor, resized(shot, factor)
        yield f"vertices {factor}", resized_meshes(shot, factor)
    for offset in PLACES:
        yield offset, moved(shot, offset)
        # Small and far away.
        yield f"1e-3 at {offset}", moved(resized(shot, 1e-3), offset)


BALL = MeshData.from_trimesh(trimesh.creation.icosphere(3), "ball")
FROM_ABOVE = Camera(
    matrix=look_at((0, 0, 4), (0, 0, 0)),
    kind=CameraKind.ORTHOGRAPHIC,
    width=PIXELS,
    height=PIXELS,
    window=(-0.35, 0.35, -0.35, 0.35),
    clip_start=0.0,
)
LIT = {
    "plane": [plane(0)],
    "mesh": [Instance(mesh=0)],
    "sphere": [sphere(0, move(z=-1.0))],
    "ball": [Instance(mesh=1, matrix=move(z=-1.0))],
    "cylinder": [Instance(kind=InstanceKind.CYLINDER, matrix=move(z=-1.0))],
    "cone": [Instance(kind=InstanceKind.CONE, matrix=move(z=-1.0))],
}


@pytest.mark.parametrize("name", LIT)
def test_what_a_lamp_lights_has_no_dark_pixel(library, name):
    """Under a sun nearly along the view, without sky, a Lambert surface shows albedo / pi times the cosine, never less.

    The window excludes pixels with a cosine below 0.3: at 0.5 of the radius of sphere or ball the cosine to the view is 0.87,
    on the cone's side 0.45, and the sun is 0.1 rad away.
    """
    lamps = [Light("sun", rotate_x(0.1), LightKind.SUN, emission=(np.pi,) * 3)]
    shot = scene(LIT[name], [lambert(1.0)], lamps, [quad(2.0), BALL], 0.0, FROM_ABOVE, samples=16)
    for where, other in everywhere(shot):
        picture = passes(other)[Pass.COMBINED][..., :3]
        assert picture.min() > 0.3 and picture.max() < 1.0 + 1e-6, where


@pytest.mark.parametrize("name", LIT)
@pytest.mark.parametrize("lamp", ["mesh", "ball"])
def test_what_a_glowing_thing_lights_has_no_dark_pixel(library, lamp, name):
    """Shadow rays end on the emitter itself: a square, or a ball, which occludes its own far side.

    About half of 64 samples of a ball hit the near side, and fewer than 8 do in one of 1e11 pixels. On the cone's side the
    cosine is a third of the largest, and at 5 units distance the light decreases by a tenth across the window.
    """
    glow = Material("glow", lobes=(), emission=(100.0,) * 3)
    square = Instance(mesh=2, matrix=move(z=5.0) @ rotate_x(np.pi), materials=(1,))
    lamps = {"mesh": square, "ball": sphere(1, move(z=5.0) @ scale(0.125))}
    shot = scene(
        [*LIT[name], lamps[lamp]], [lambert(1.0), glow], (), [quad(2.0), BALL, quad(0.25)], 0.0, FROM_ABOVE, samples=64
    )
    for where, other in everywhere(shot):
        picture = passes(other)[Pass.COMBINED][..., :3]
        assert picture.min() > picture.max() / 16, where


@pytest.mark.parametrize("kind", ["box", "ball", "sphere", "cylinder"])
def test_a_closed_thing_stays_dark_inside(library, kind):
    """Inside a closed body, with lamps of all kinds and a sky outside and many bounces, no sample may be lit."""
    box = MeshData.from_trimesh(trimesh.creation.box((2, 2, 2)), "box")
    exact = {"sphere": InstanceKind.SPHERE, "cylinder": InstanceKind.CYLINDER}
    turn = rotate_x(0.3)
    shells = {"box": Instance(mesh=0, matrix=turn), "ball": Instance(mesh=1, matrix=turn)}
    shell = shells.get(kind) or Instance(kind=exact[kind], matrix=turn)
    lamps = [
        Light("sun", rotate_x(0.7), LightKind.SUN, emission=(50,) * 3),
        Light("point", move(0, 0, 1.5), emission=(50,) * 3, radius=0.1),
        Light("spot", move(0, -3, 0) @ rotate_x(np.pi / 2), LightKind.SPOT, emission=(50,) * 3),
        Light("area", move(0, 0, 2), LightKind.AREA, emission=(50,) * 3, size=(3, 3)),
    ]
    lens = Camera(matrix=look_at((0, 0, 0), (0.3, 1, 0.2)), width=PIXELS, height=PIXELS, window=(-2, 2, -2, 2), clip_start=0.0)
    shot = scene([shell], [lambert(0.9)], lamps, [box, BALL], 5.0, lens, samples=16, max_bounces=8)
    for where, other in everywhere(shot):
        assert passes(other)[Pass.COMBINED][..., :3].max() == 0.0, where


# ---- through Blender ----


@pytest.mark.parametrize("name", ["workshop", "terrace"])
def test_from_blender(name, tmp_path):
    """Blender stores floats: a power of two changes no digit; a factor of 1000 rounds each number by 6e-8, which moves edges by
    1e-6 of a pixel and changes few or none of the 1024 samples of a square."""
    got = blenders.run(blenders.MODULE, tmp_path, "scale_cases", name)
    assert got["mean"] > 0.05 and got["messages"] == []
    assert got["equal"] == {"2^-10": True, "2^10": True}
    assert sorted(got["squares"]) == ["0.001", "1000", "moved"] and max(got["squares"].values()) <= 1e-4, got["squares"]
