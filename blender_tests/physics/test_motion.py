"""Motion while the shutter is open: closed forms, and pictures against the mean of pictures that stand still."""

import dataclasses

import numpy as np
import pytest
from significance import LEVEL, sidak, z_test
from tiny_scenes import lambert, look_at, move, plane, quad, render, rotate_x, rotate_y, scale, scene, sphere, with_settings

from addon.bindings.abi import CameraKind, Coordinate, LightKind, LobeKind, NodeKind, Pass, PixelFilter
from addon.bindings.enums import VectorOperation
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Instance, InstanceMotion, Light, Lobe, Material, MeshData, Motion, Node, NodeRef

OPEN = np.ones(2, np.float32)
GLOW = Material("glow", lobes=(), emission=(1.0, 1.0, 1.0))
# A strip of pixels of 1/8, seen from above.
STRIP = Camera(
    move(z=5), CameraKind.ORTHOGRAPHIC, width=64, height=1, window=(-4.0, 4.0, -0.0625, 0.0625), clip_start=0.1, clip_end=10.0
)


def moving(snapshot, instance, keys, shutter=OPEN):
    """Return the snapshot with the matrices of one instance at its keys."""
    matrices = np.array([[np.asarray(key, float)[:3] for key in keys]])
    table = dataclasses.replace(
        snapshot.instances, motions=(*snapshot.instances.motions, InstanceMotion(instances=[instance], matrices=matrices))
    )
    return snapshot.replaced(instances=table, motion=Motion(shutter=shutter))


def placed(snapshot, instance, matrix):
    matrices = np.array(snapshot.instances.matrices)
    matrices[instance] = np.asarray(matrix, float)[:3]
    return snapshot.replaced(instances=dataclasses.replace(snapshot.instances, matrices=matrices))


def strip(**settings):
    """Return a shining square of side 2 in the middle of a dark strip."""
    settings = {"samples": 1024, "pixel_filter": PixelFilter.BOX, "filter_width": 1.0, **settings}
    return scene([Instance(mesh=0, materials=(0,))], [GLOW], meshes=[quad(2.0)], camera=STRIP, **settings)


def shares(covers):
    """Return for each pixel the share of place and time in which covers(x, time) holds."""
    x = (np.arange(64 * 16) + 0.5) / 128.0 - 4.0
    t = (np.arange(4096) + 0.5) / 4096.0
    return covers(x[:, None], t[None, :]).mean(axis=1).reshape(64, 16).mean(axis=1)


def expect_shares(snapshot, expected, samples=1024):
    """The mean of N samples that are 0 or 1 is within 4.5 sqrt(p (1 - p) / N) in 64 pixels, but for one run in ten thousand.

    The sums over 16 places and 4096 times are exact to 1/4096 for each edge.
    """
    found = render(snapshot)[0, :, 0]
    bound = 4.5 * np.sqrt(expected * (1.0 - expected) / samples) + 1e-3
    assert np.all(np.abs(found - expected) <= bound), np.abs(found - expected).max()


def slides(x, t):
    return np.abs(x - (4.0 * t - 2.0)) < 1.0


def test_an_edge_that_slides_covers_its_share():
    expect_shares(moving(strip(), 0, [move(-2), move(0), move(2)]), shares(slides))


def test_a_mesh_that_changes_its_shape_covers_its_share():
    snapshot = strip()
    mesh = snapshot.meshes[0]
    moved = np.stack([mesh.positions + np.float32([x, 0, 0]) for x in (-2, 0, 2)])
    snapshot = snapshot.replaced(meshes=(dataclasses.replace(mesh, moved_positions=moved),), motion=Motion(shutter=OPEN))
    expect_shares(snapshot, shares(slides))


def test_a_displaced_mesh_moves_with_its_shape_in_the_middle():
    """As in Cycles. The material adds a quarter of the vertices' places in the world, which are aside in the middle."""
    nodes = (
        Node(NodeKind.COORDINATE, option=Coordinate.POSITION),
        Node(NodeKind.VECTOR_MATH, VectorOperation.SCALE, inputs=(NodeRef(0), 0.0, 0.0, 0.25)),
    )
    stretched = dataclasses.replace(GLOW, nodes=nodes, displacement=NodeRef(1))
    snapshot = moving(strip().replaced(materials=(stretched,)), 0, [move(-1), move(1), move(3)])
    expect_shares(snapshot, shares(lambda x, t: np.abs(x - (4.0 * t - 0.75)) < 1.25))


def test_a_camera_that_slides_sees_the_same():
    keys = tuple(dataclasses.replace(STRIP, matrix=move(x, z=5)) for x in (2, 0, -2))
    expect_shares(strip().replaced(motion=Motion(shutter=OPEN, keys=keys)), shares(slides))


def test_a_camera_that_zooms():
    """The window grows linearly from half to three halves of its width."""
    keys = tuple(dataclasses.replace(STRIP, window=(-4.0 * k, 4.0 * k, -0.0625, 0.0625)) for k in (0.5, 1.0, 1.5))
    expected = shares(lambda x, t: np.abs(x * (0.5 + t)) < 1.0)
    expect_shares(strip().replaced(motion=Motion(shutter=OPEN, keys=keys)), expected)


def test_keys_are_met_one_after_the_other():
    """Five keys, with other speeds between them."""
    places = np.array([-2.0, -1.0, 2.0, 2.0, 0.0])
    expected = shares(lambda x, t: np.abs(x - np.interp(t, np.linspace(0, 1, 5), places)) < 1.0)
    expect_shares(moving(strip(), 0, [move(x) for x in places]), expected)


def test_the_shutter_weighs_times():
    """It opens slowly and closes at once: the density of times is 2 t."""
    u = (np.arange(4096) + 0.5) / 4096.0
    expected = shares(lambda x, t: np.abs(x - (4.0 * np.sqrt(u)[None, :] - 2.0)) < 1.0)
    expect_shares(moving(strip(), 0, [move(-2), move(0), move(2)], np.float32([0, 1])), expected)


def test_a_disk_that_turns():
    """Half a disk, turned by 2.4 about its centre: a place is covered while the edge passes it, at constant speed."""
    fan = np.linspace(0.0, np.pi, 65)
    points = np.concatenate([[[0, 0, 0]], np.stack([3.9 * np.cos(fan), 3.9 * np.sin(fan), 0 * fan], axis=1)])
    mesh = MeshData("half", points, [(0, k, k + 1) for k in range(1, 65)])
    turns = 2.4
    snapshot = strip().replaced(meshes=(mesh,))

    def turned(angle):
        matrix = np.eye(4)
        matrix[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        return matrix

    keys = [turned(turns * (k - 0.5)) for k in (0.0, 0.5, 1.0)]
    snapshot = moving(snapshot, 0, keys).replaced(camera=dataclasses.replace(STRIP, matrix=move(0, 0.5, 5)))

    def covers(x, t):
        angle = np.arctan2(0.5, x) - turns * (t - 0.5)
        return (np.mod(angle, 2.0 * np.pi) < np.pi) & (np.hypot(x, 0.5) < 3.9 * np.cos(np.pi / 128))

    # The rim of the fan lies between its corners and its edges: leave out the two pixels there, and the strip's height.
    expected = shares(covers)
    found = render(snapshot)[0, :, 0]
    inside = np.abs(np.arange(64) - 31.5) < 29
    bound = 4.5 * np.sqrt(expected * (1.0 - expected) / 1024) + 5e-3
    assert np.all((np.abs(found - expected) <= bound)[inside])


def room(**settings):
    """Return a glossy ball, a matt block and a floor under a lamp and a sky, with a shining square."""
    materials = [
        lambert(0.6),
        Material("rough", lobes=(Lobe(LobeKind.BECKMANN, color=(0.9, 0.9, 0.9), roughness=0.3, ior=4.0),)),
        Material("glow", lobes=(), emission=(6.0, 5.0, 4.0)),
    ]
    instances = [
        plane(0),
        sphere(1, move(-0.8, 0, 0.7) @ scale(0.6)),
        Instance(mesh=0, matrix=move(0.9, 0, 0.7) @ rotate_x(1.2), materials=(0,)),
        Instance(mesh=0, matrix=move(0, 0.6, 2.2) @ rotate_x(2.6) @ scale(0.6), materials=(2,)),
    ]
    lamps = [Light("lamp", move(1.5, -2, 3), LightKind.POINT, emission=(9, 9, 9), radius=0.2)]
    camera = Camera(look_at((0.5, -4, 2), (0, 0, 0.6)), width=24, height=16, window=(-0.45, 0.45, -0.3, 0.3))
    return scene(instances, materials, lamps, [quad(1.2)], 0.2, camera, **{"samples": 512, "max_bounces": 3, **settings})


def turn(x=0.0, y=0.0):
    return rotate_x(x) @ rotate_y(y)


MOVES = {
    "ball": (1, lambda t: move(-1.4 + 1.6 * t, 0, 0.7) @ scale(0.6)),
    "block": (2, lambda t: move(0.9, 0, 0.7) @ turn(1.2, 2.0 * (t - 0.5))),
    "light": (3, lambda t: move(-1.0 + 2.0 * t, 0.6, 2.2) @ turn(2.6, 1.5 * (t - 0.5)) @ scale(0.6)),
}


@pytest.mark.parametrize("name", MOVES)
def test_a_moving_picture_is_the_mean_of_still_ones(name):
    """Stills at 48 times, each of other random numbers, against one picture with motion: a z-test of 4 x 4 pixels' means.

    The stills' own spread over the times is no error of their mean, which the midpoint rule makes smaller than 1/48^2.
    """
    number, path = MOVES[name]
    times = (np.arange(48) + 0.5) / 48
    stills = [
        render(with_settings(placed(room(), number, path(t)), seed=100 + k, samples=64))[..., 1] for k, t in enumerate(times)
    ]
    again = [
        render(with_settings(placed(room(), number, path(t)), seed=300 + k, samples=64))[..., 1] for k, t in enumerate(times)
    ]

    def blocks(picture):
        return picture.reshape(4, 4, 6, 4).mean(axis=(1, 3))

    expected = blocks(np.mean([stills, again], axis=(0, 1)))
    # Two pictures of one time differ by noise alone.
    noise2 = np.mean([(blocks(a) - blocks(b)) ** 2 for a, b in zip(stills, again, strict=True)], axis=0) / (4 * len(times))
    keys = [path(t) for t in np.linspace(0, 1, 9)]
    moved = [blocks(render(with_settings(moving(room(), number, keys), seed=s))[..., 1]) for s in range(6)]
    error2 = np.var(moved, axis=0, ddof=1) / len(moved)
    # Six pictures estimate their error with five degrees of freedom: at least the mean relative error of all blocks counts.
    level = np.mean(moved, axis=0)
    error2 = np.maximum(error2, level**2 * np.mean(error2 / level**2))
    p = z_test(level, np.sqrt(error2 + noise2), expected)
    assert p.min() > sidak(LEVEL, p.size), p.min()


def test_a_shutter_over_a_still_scene_changes_no_bit():
    plain = room(samples=8)
    assert np.array_equal(render(plain), render(plain.replaced(motion=Motion(shutter=OPEN))))
    # And keys without a shutter show the middle.
    number, path = MOVES["ball"]
    keys = moving(plain, number, [path(t) for t in (0.0, 0.5, 1.0)]).replaced(motion=Motion())
    still = placed(plain, number, path(0.5))
    assert np.abs(render(keys) - render(still)).mean() < 1e-3 * render(still).mean()


def test_threads_and_tiles_change_no_bit():
    number, path = MOVES["light"]
    snapshot = moving(room(samples=16), number, [path(t) for t in np.linspace(0, 1, 5)])
    first = render(with_settings(snapshot, threads=1))
    assert np.array_equal(first, render(with_settings(snapshot, threads=2, tile_size=8)))
    with Session.upload(with_settings(snapshot, accelerator=1)) as session:
        assert session.render_all()
        assert np.array_equal(first, session.read(Pass.COMBINED))


def test_a_rolling_shutter_exposes_rows_from_the_top():
    """Without a duration each row has one time: the square's edge stands sharp at another place in each row."""
    camera = dataclasses.replace(STRIP, height=64, region_height=64, window=(-4.0, 4.0, -4.0, 4.0))
    tall = MeshData("tall", [(-1, -9, 0), (1, -9, 0), (1, 9, 0), (-1, 9, 0)], [(0, 1, 2), (0, 2, 3)])
    snapshot = moving(strip(samples=64).replaced(meshes=(tall,), camera=camera), 0, [move(-2), move(0), move(2)])
    snapshot = snapshot.replaced(motion=Motion(shutter=OPEN, rolling=True, rolling_duration=0.0))
    picture = render(snapshot)[..., 0]
    times = 1.0 - np.arange(64) / 64
    x = (np.arange(64) + 0.5) / 8 - 4.0
    centers = (picture * x).sum(axis=1) / picture.sum(axis=1)
    # The square covers 16 pixels, of which only the two at its edges have noise of at most 1/16 of a pixel.
    assert np.abs(centers - (4.0 * times - 2.0)).max() < 0.01


@pytest.mark.parametrize("factor", [1e-6, 1e9])
def test_motion_at_any_size(factor):
    grown = np.diag([factor, factor, factor, 1.0])
    path = [move(-2), move(0), move(2)]
    camera = dataclasses.replace(
        STRIP, matrix=move(z=5 * factor), window=tuple(factor * w for w in STRIP.window), clip_start=0.1 * factor,
        clip_end=10 * factor,
    )  # fmt: skip
    snapshot = moving(strip(samples=64), 0, [grown @ m for m in path]).replaced(camera=camera)
    plain = moving(strip(samples=64), 0, path)
    assert np.abs(render(snapshot) - render(plain)).max() <= 1.0 / 64


def test_a_singular_key_stands_still_with_a_message():
    snapshot = moving(strip(samples=4), 0, [move(-2), scale(1, 1, 0), move(2)])
    with Session.upload(snapshot) as session:
        assert any("stands still" in line for line in session.messages())
        assert session.render_all()
        assert np.array_equal(session.read(Pass.COMBINED), render(strip(samples=4)))
