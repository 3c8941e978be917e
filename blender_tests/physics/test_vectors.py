"""The pass Vector: closed forms of motion in the picture, in pixels, and pictures that keep their bits."""

import dataclasses

import numpy as np
import pytest
from tiny_scenes import (
    lambert,
    look_at,
    move,
    plane,
    quad,
    render,
    rotate_x,
    rotate_y,
    scale,
    scene,
    showroom,
    sphere,
    veiled,
    with_settings,
)

from addon.bindings.abi import CameraKind, Integrator, LobeKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Instance, InstanceVectors, Lobe, Material, Motion

GLOW = Material("glow", lobes=(), emission=(1.0, 1.0, 1.0))
VECTORS = (Pass.COMBINED, Pass.VECTOR)
# Two pixels to a unit, from above.
ABOVE = Camera(
    move(z=5), CameraKind.ORTHOGRAPHIC, width=16, height=8, window=(-4.0, 4.0, -2.0, 2.0), clip_start=0.1, clip_end=99.0
)
AHEAD = Camera(move(z=4), width=16, height=8, window=(-0.8, 0.8, -0.4, 0.4), clip_start=0.1, clip_end=99.0)
# Places are below 1e3 pixels with an error of some 1e-15 of that in double; a vector is rounded to float twice.
ERROR = {"rtol": 2.0**-23, "atol": 1e-11}


def turn(angle):
    """Return the rotation about z."""
    matrix = np.eye(4)
    c, s = np.cos(angle), np.sin(angle)
    matrix[:2, :2] = [[c, -s], [s, c]]
    return matrix


def in_frames(snapshot, **places):
    """Return the snapshot with the matrices of instances one frame before and one after: i0=(before, after)."""
    numbers = [int(name[1:]) for name in places]
    matrices = np.array([[np.asarray(matrix, float)[:3] for matrix in frames] for frames in places.values()])
    table = dataclasses.replace(snapshot.instances, vectors=InstanceVectors(numbers, matrices))
    return snapshot.replaced(instances=table)


def seen_from(camera, before, after, **windows):
    return dataclasses.replace(
        camera,
        matrix_before=before,
        matrix_after=after,
        **{"window_before": camera.window, "window_after": camera.window, **windows},
    )


def one(camera=ABOVE, thing=None, mesh=None, material=GLOW, **settings):
    """Return a shining square that fills the view, or another thing. One sample of CLASSIC is that of the pixel's centre."""
    settings = {"integrator": Integrator.CLASSIC, "passes": VECTORS, **settings}
    thing = thing or Instance(mesh=0, materials=(0,))
    return scene([thing], [material], meshes=[mesh or quad(20.0)], camera=camera, **settings)


def places(camera):
    """Return the centres of pixels in the window, and how many pixels a unit of it has, each (height, width)."""
    left, right, bottom, top = camera.window
    x = left + (right - left) * (np.arange(camera.width) + 0.5) / camera.width
    y = bottom + (top - bottom) * (np.arange(camera.height) + 0.5) / camera.height
    return (*np.meshgrid(x, y), camera.width / (right - left), camera.height / (top - bottom))


def vectors(camera, before, after):
    """Return the vectors of places (x, y) in the window one frame before and one after."""
    x, y, across, up = places(camera)
    return np.stack(
        [
            (before[0] - x) * across,
            (before[1] - y) * up,
            (x - after[0]) * across,
            (y - after[1]) * up,
        ],
        axis=-1,
    )


@pytest.mark.parametrize("integrator", Integrator)
def test_a_square_that_slides(integrator):
    snapshot = in_frames(one(integrator=integrator, samples=4), i0=(move(-1.5, 0.25), move(2.0, -1.0)))
    # Two pixels to a unit: before less now, now less after; the height is not seen.
    np.testing.assert_allclose(render(snapshot, Pass.VECTOR), np.broadcast_to([-3.0, 0.5, -4.0, 2.0], (8, 16, 4)), **ERROR)


def test_a_square_that_turns():
    found = render(in_frames(one(), i0=(turn(-0.3), turn(0.7))), Pass.VECTOR)
    x, y, *_ = places(ABOVE)

    def turned(angle):
        return np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y

    np.testing.assert_allclose(found, vectors(ABOVE, turned(-0.3), turned(0.7)), **ERROR)


def test_a_square_that_comes_near():
    """At the distance 4 the picture of a place is x / 4; at 5 and at 2 it is x / 5 and x / 2."""
    found = render(in_frames(one(AHEAD), i0=(move(z=-1), move(z=2))), Pass.VECTOR)
    x, y, *_ = places(AHEAD)
    np.testing.assert_allclose(found, vectors(AHEAD, (0.8 * x, 0.8 * y), (2.0 * x, 2.0 * y)), **ERROR)


def test_an_exact_sphere_that_grows():
    """Its middle: a pixel beside it sees a place that moves with the radius."""
    camera = dataclasses.replace(ABOVE, window=(-0.4, 0.4, -0.2, 0.2))
    found = render(in_frames(one(camera, sphere(0)), i0=(scale(0.5), scale(3.0))), Pass.VECTOR)
    x, y, *_ = places(camera)
    np.testing.assert_allclose(found, vectors(camera, (0.5 * x, 0.5 * y), (3.0 * x, 3.0 * y)), **ERROR)


def test_a_mesh_that_changes_its_shape():
    """Its vertices are stretched along x in the frame before and slide in the frame after, in an instance that also moves.

    Vertices are floats: 10 units less 2^-22 of them is at most 5e-6 pixels.
    """
    mesh = quad(20.0)
    frames = np.stack([mesh.positions * np.float32([1.25, 1, 1]), mesh.positions + np.float32([0.5, 0.25, 0])])
    mesh = dataclasses.replace(mesh, vector_positions=frames)
    x, y, *_ = places(ABOVE)
    alone, moving = ((1.25 * x, y), (x + 0.5, y + 0.25)), ((1.25 * x, y + 1.0), (x + 0.5, y - 0.75))
    found = render(one(mesh=mesh), Pass.VECTOR)
    np.testing.assert_allclose(found, vectors(ABOVE, *alone), rtol=0, atol=5e-6)
    found = render(in_frames(one(mesh=mesh), i0=(move(0, 1.0), move(0, -1.0))), Pass.VECTOR)
    np.testing.assert_allclose(found, vectors(ABOVE, *moving), rtol=0, atol=5e-6)


def test_a_camera_that_slides():
    """What the camera does, the square does the other way round; both at once stand still."""
    camera = seen_from(ABOVE, move(-1.5, 0.25, 5), move(2.0, -1.0, 5))
    found = render(one(camera), Pass.VECTOR)
    np.testing.assert_allclose(found, np.broadcast_to([3.0, -0.5, 4.0, -2.0], (8, 16, 4)), **ERROR)
    both = in_frames(one(camera), i0=(move(-1.5, 0.25), move(2.0, -1.0)))
    np.testing.assert_allclose(render(both, Pass.VECTOR), 0.0, atol=1e-11)


def panned(x, y, angle):
    """Return the places in the window of a camera that has turned to the left by an angle."""
    c, s = np.cos(angle), np.sin(angle)
    return (c * x + s) / (c - s * x), y / (c - s * x)


def test_a_camera_that_pans():
    """A place at the angle t beside the axis is seen at tan(t + angle)."""
    camera = seen_from(AHEAD, move(z=4) @ rotate_y(0.1), move(z=4) @ rotate_y(-0.2))
    found = render(one(camera), Pass.VECTOR)
    x, y, *_ = places(AHEAD)
    np.testing.assert_allclose(np.tan(np.arctan(x) + 0.1), panned(x, y, 0.1)[0], rtol=1e-12)
    np.testing.assert_allclose(found, vectors(AHEAD, panned(x, y, 0.1), panned(x, y, -0.2)), **ERROR)


def test_a_camera_that_zooms():
    half, twice = (tuple(factor * edge for edge in AHEAD.window) for factor in (0.5, 2.0))
    camera = seen_from(AHEAD, AHEAD.matrix, AHEAD.matrix, window_before=half, window_after=twice)
    x, y, *_ = places(AHEAD)
    np.testing.assert_allclose(
        render(one(camera), Pass.VECTOR), vectors(AHEAD, (2.0 * x, 2.0 * y), (0.5 * x, 0.5 * y)), **ERROR
    )


def test_a_region_has_the_vectors_of_the_whole():
    camera = seen_from(AHEAD, move(z=4) @ rotate_y(0.1), move(z=4) @ rotate_y(-0.2))
    part = dataclasses.replace(camera, x=5, y=2, region_width=7, region_height=4)
    whole = render(one(camera), Pass.VECTOR)
    np.testing.assert_array_equal(render(one(part), Pass.VECTOR), whole[2:6, 5:12])


WHOLE = (0.0, 1.0, 0.0, 1.0)
# Half a turn to each side, a quarter up and down.
GLOBE = (-np.pi / 2, np.pi / 2, -np.pi, np.pi, 0, 0, 0, 0)
TUBE = (-np.pi, np.pi, -1.0, 1.0, 1.0, 0, 0, 0)


@pytest.mark.parametrize("kind, numbers", [(CameraKind.EQUIRECTANGULAR, GLOBE), (CameraKind.CYLINDRICAL, TUBE)])
def test_a_panorama_that_turns(kind, numbers):
    """All places slide to the side by the same share of a full turn, but those that come from the other edge."""
    camera = Camera(np.eye(4), kind, width=16, height=8, window=WHOLE, panorama=numbers, clip_end=99.0)
    camera = seen_from(camera, rotate_y(0.3), rotate_y(-0.2))
    found = render(one(camera, sphere(0, scale(5.0))), Pass.VECTOR)
    across = 16 / (2 * np.pi)
    expected = np.broadcast_to([0.3 * across, 0.0, 0.2 * across, 0.0], found.shape)
    # The last pixel to each side is within half a pixel, 0.2, of the edge.
    np.testing.assert_allclose(found[:, 1:-1], expected[:, 1:-1], **ERROR)
    np.testing.assert_allclose(found[:, -1], expected[:, -1] - [16, 0, 0, 0], **ERROR)


FISHEYES = (
    (CameraKind.FISHEYE_EQUIDISTANT, (3.0, 0, 0, 0, 0, 0, 0, 0)),
    (CameraKind.FISHEYE_EQUISOLID, (10.5, 3.0, 36.0, 24.0, 0, 0, 0, 0)),
    (CameraKind.FISHEYE_POLYNOMIAL, (3.0, 36.0, 24.0, 0, -0.06, 0, 0, 0)),
    (CameraKind.MIRROR_BALL, (0,) * 8),
)


@pytest.mark.parametrize("kind, numbers", FISHEYES)
def test_a_round_picture_that_rolls(kind, numbers):
    """The picture turns about its centre; on a sensor of 36 by 24 a unit of the picture is as wide as that."""
    camera = Camera(np.eye(4), kind, width=12, height=12, window=WHOLE, panorama=numbers, clip_end=99.0)
    camera = seen_from(camera, turn(0.3), turn(-0.2))
    snapshot = one(camera, sphere(0, scale(5.0)))
    found, seen = render(snapshot, Pass.VECTOR), render(snapshot)[..., 0] > 0.0
    x, y, *_ = places(camera)
    wide, high = (36.0, 24.0) if kind in (CameraKind.FISHEYE_EQUISOLID, CameraKind.FISHEYE_POLYNOMIAL) else (1.0, 1.0)

    def rolled(angle):
        # The camera turns by the angle, and the picture the other way.
        c, s = np.cos(angle), np.sin(angle)
        across, up = (x - 0.5) * wide, (y - 0.5) * high
        return (c * across + s * up) / wide + 0.5, (c * up - s * across) / high + 0.5

    assert seen.sum() > 40
    # The radius of the polynomial is found by Newton's method, to some units in the last place.
    np.testing.assert_allclose(found[seen], vectors(camera, rolled(0.3), rolled(-0.2))[seen], **ERROR)
    assert (found[~seen] == 0.0).all()


def test_edges_have_the_mean_of_what_is_seen():
    """Half of a pixel shows the square and half of it nothing: its vector is the square's."""
    snapshot = in_frames(one(mesh=quad(3.25), integrator=Integrator.PATH, samples=64), i0=(move(-1), move(1)))
    found, shares = render(snapshot, Pass.VECTOR), render(snapshot)[..., 0]
    assert ((shares > 0.05) & (shares < 0.95)).any()
    np.testing.assert_allclose(found[shares > 0], np.broadcast_to([-2, 0, -2, 0], found[shares > 0].shape), **ERROR)
    assert (found[shares == 0] == 0.0).all() and (shares == 0).any()


def sky_vectors(camera, angles):
    """Return the vectors of directions as Blender 5.2 has them: places times the depth of the unit direction."""
    x, y, *_ = places(camera)
    left, right, bottom, top = camera.window
    unit = np.stack([x, y, -np.ones_like(x)], axis=-1)
    unit /= np.linalg.norm(unit, axis=-1, keepdims=True)

    def place(angle):
        local = unit @ rotate_y(angle)[:3, :3]
        depth = -local[..., 2]
        return np.stack(
            [
                (local[..., 0] - left * depth) / (right - left) * camera.width,
                (local[..., 1] - bottom * depth) / (top - bottom) * camera.height,
            ],
            axis=-1,
        )

    now = place(0.0)
    return np.concatenate([place(angles[0]) - now, now - place(angles[1])], axis=-1)


@pytest.mark.parametrize("integrator", Integrator)
def test_the_sky_of_blender_5_2(integrator):
    """Only where it is asked for, and of a camera that turns; the square before it has its own vectors."""
    camera = seen_from(AHEAD, move(z=4) @ rotate_y(0.1), move(z=4) @ rotate_y(-0.2))
    empty = dataclasses.replace(AHEAD, matrix=AHEAD.matrix)
    settings = {"integrator": integrator, "samples": 16, "filter_width": 1e-6, "pixel_filter": 0}
    snapshot = one(camera, mesh=quad(1.8), **settings)
    plain, with_sky = render(snapshot, Pass.VECTOR), render(with_settings(snapshot, sky_vectors=True), Pass.VECTOR)
    seen = render(snapshot)[..., 0] > 0.0
    x, y, *_ = places(AHEAD)
    of_square = vectors(AHEAD, panned(x, y, 0.1), panned(x, y, -0.2))
    # Samples are within a millionth of a pixel of its centre, where vectors change by less than themselves from pixel to pixel.
    near = {"rtol": 1e-6, "atol": 1e-6}
    for found, around in ((plain, 0.0 * of_square), (with_sky, sky_vectors(AHEAD, (0.1, -0.2)))):
        np.testing.assert_allclose(found[seen], of_square[seen], **near)
        np.testing.assert_allclose(found[~seen], around[~seen], **near)
    still = with_settings(one(empty, mesh=quad(1.8), **settings), sky_vectors=True)
    assert (render(still, Pass.VECTOR) == 0.0).all()


def test_the_sky_of_an_orthographic_camera():
    """A direction of the user's unit, whatever the size of the scene: one that turns by an angle moves by its sine."""
    camera = seen_from(ABOVE, move(z=5) @ rotate_y(0.1), move(z=5) @ rotate_y(-0.2))
    for size in (0.01, 2.0):
        snapshot = one(camera, mesh=quad(size), sky_vectors=True)
        found = render(snapshot, Pass.VECTOR)[0, 0]
        np.testing.assert_allclose(found, [2.0 * np.sin(0.1), 0.0, 2.0 * np.sin(0.2), 0.0], **ERROR)


def test_what_shows_through_a_veil():
    """A surface of less opacity than the threshold is passed, and one behind it gives the vector; a mirror shows its own."""
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(0.9, 0.9, 0.9)),))
    for front, expected in (
        (veiled(lambert(0.5), 0.4), [4, 0, 4, 0]),
        (veiled(lambert(0.5), 0.6), [2, 0, 2, 0]),
        (mirror, [2, 0, 2, 0]),
    ):
        for integrator in (Integrator.PATH, Integrator.CLASSIC):
            instances = [Instance(mesh=0, materials=(0,), matrix=move(z=1)), Instance(mesh=0, materials=(1,))]
            settings = {"integrator": integrator, "passes": VECTORS, "samples": 16, "max_bounces": 2}
            snapshot = scene(instances, [front, GLOW], meshes=[quad(20.0)], camera=ABOVE, **settings)
            snapshot = in_frames(snapshot, i0=(move(1, 0, 1), move(-1, 0, 1)), i1=(move(2), move(-2)))
            found = render(snapshot, Pass.VECTOR)
            np.testing.assert_allclose(found, np.broadcast_to(np.float64(expected), found.shape), **ERROR)


def test_a_picture_with_motion_blur_has_none():
    snapshot = one(samples=16, integrator=Integrator.PATH).replaced(motion=Motion(shutter=np.ones(2, np.float32)))
    assert (render(snapshot, Pass.VECTOR) == 0.0).all()


def pictures(snapshot):
    """Return (all passes but Vector, what the renderer has traced and built)."""
    with Session.upload(snapshot) as session:
        assert session.render_all()
        statistics = session.statistics()
        passes = {which: session.read(which) for which in snapshot.settings.passes if which != Pass.VECTOR}
        return passes, (statistics.rays, statistics.vertices, statistics.features, statistics.accelerator_bytes)


@pytest.mark.parametrize("integrator", Integrator)
@pytest.mark.parametrize("sky", [False, True])
def test_other_passes_keep_their_bits(integrator, sky):
    """Rays trace the scene as it stands, in a tree without motion."""
    snapshot = showroom(integrator=integrator, sky_vectors=sky, split_lights=2, split_paths=2)
    assert snapshot.instances.vectors is not None and snapshot.camera.matrix_before.any()
    assert any(mesh.vector_positions is not None for mesh in snapshot.meshes)
    without = tuple(which for which in snapshot.settings.passes if which != Pass.VECTOR)
    table = dataclasses.replace(snapshot.instances, vectors=None)
    meshes = tuple(dataclasses.replace(mesh, vector_positions=None) for mesh in snapshot.meshes)
    zeros = np.zeros((3, 4))
    camera = dataclasses.replace(snapshot.camera, matrix_before=zeros, matrix_after=zeros)
    plain = with_settings(snapshot.replaced(instances=table, meshes=meshes, camera=camera), passes=without)
    (mine, work), (others, plain_work) = pictures(snapshot), pictures(plain)
    assert work == plain_work and "motion" not in work[2]
    for which, picture in others.items():
        np.testing.assert_array_equal(mine[which], picture, Pass(which).name)
    assert np.unique(render(snapshot, Pass.VECTOR)).size > 100


def test_the_background_alone_keeps_its_bits():
    """Where an even background is not traced without vectors, it is with those of the sky."""
    camera = seen_from(AHEAD, move(z=4) @ rotate_y(0.1), move(z=4) @ rotate_y(-0.2))
    snapshot = one(dataclasses.replace(camera, width=64, height=32, region_width=64, region_height=32), mesh=quad(1.0),
                   integrator=Integrator.PATH, samples=16, sky_vectors=True)  # fmt: skip
    snapshot = snapshot.replaced(world=dataclasses.replace(snapshot.world, radiance=(0.2, 0.3, 0.4)))
    found, plain = pictures(snapshot), pictures(with_settings(snapshot, passes=(Pass.COMBINED,)))
    np.testing.assert_array_equal(found[0][Pass.COMBINED], plain[0][Pass.COMBINED])
    assert plain[1][0] < found[1][0]
    vectors_of_sky = render(snapshot, Pass.VECTOR)
    assert (vectors_of_sky[..., 0] != 0.0).all()


def test_scale_changes_no_bit():
    """Scenes are normalised by a power of two."""
    large = 2.0**20
    mesh, big = quad(3.0), quad(3.0 * large)
    near = in_frames(one(AHEAD, mesh=mesh), i0=(move(-0.3, 0.1) @ turn(0.2), move(0.5, z=0.3)))
    camera = dataclasses.replace(AHEAD, matrix=move(z=4 * large), clip_end=99 * large, clip_start=0.1 * large)
    far = in_frames(one(camera, mesh=big), i0=(move(-0.3 * large, 0.1 * large) @ turn(0.2), move(0.5 * large, z=0.3 * large)))
    np.testing.assert_array_equal(render(near, Pass.VECTOR), render(far, Pass.VECTOR))


def test_places_that_no_picture_has():
    """A place beside or behind the camera, or not finite: the vector is finite, and the picture loses no sample."""
    nan = np.full((4, 4), np.nan)
    mesh = quad(20.0)
    frames = np.stack([mesh.positions, mesh.positions])
    frames[0, 1] = np.nan, 0, 0
    broken = dataclasses.replace(mesh, vector_positions=frames)
    cases = {
        "beside": in_frames(one(AHEAD), i0=(move(z=4), move(z=3))),
        "behind": in_frames(one(AHEAD), i0=(move(z=9), move(z=1e30))),
        "huge": in_frames(one(AHEAD), i0=(scale(1e300), scale(1e-300))),
        "not finite": in_frames(one(AHEAD), i0=(nan, move(1))),
        "broken": one(AHEAD, mesh=broken),
    }
    told = {}
    for name, snapshot in cases.items():
        with Session.upload(snapshot) as session:
            assert session.render_all()
            assert session.statistics().invalid_samples == 0, name
            assert np.isfinite(session.read(Pass.VECTOR)).all(), name
            assert (session.read(Pass.COMBINED)[..., :3] == 1.0).all(), name
            told[name] = session.messages()
    assert (render(cases["beside"], Pass.VECTOR)[..., :2] == 0.0).all()
    assert (render(cases["not finite"], Pass.VECTOR) == 0.0).all()
    assert [line for line in told["not finite"] if "in the pass Vector it stands still" in line]
    assert [line for line in told["broken"] if "1 vertices" in line and "Vector" in line]
    assert not told["beside"] and not told["behind"] and not told["huge"]


def test_a_floor_turns_with_its_camera():
    """A scene that turns as a whole with its camera stands still in the picture."""
    together = rotate_x(0.4) @ turn(1.0)
    eye = look_at((1.5, -6.0, 2.5), (0, 0, 0.8))
    camera = seen_from(dataclasses.replace(AHEAD, matrix=eye), together @ eye, np.linalg.inv(together) @ eye)
    snapshot = one(camera, plane(0))
    snapshot = in_frames(snapshot, i0=(together, np.linalg.inv(together)))
    # Places are below 1e3 units, and a picture of a far floor has places of 1e3 pixels at most: some 1e-13 of these.
    np.testing.assert_allclose(render(snapshot, Pass.VECTOR), 0.0, atol=1e-9)
