"""Camera rays by the window's formula, the lens's focus, and the pixel filter's distribution."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes
from significance import LEVEL, chi_square, midpoints, uniforms
from tiny_scenes import look_at, move, rotate_x, scale

from addon.bindings.abi import CameraKind, Pass, PixelFilter
from addon.bindings.session import Session, pixel_filter, sampler
from addon.bindings.snapshot import Camera

WINDOW = (-0.3, 0.5, -0.2, 0.25)
MATRIX = look_at((3.0, -4.0, 2.0), (0.5, 0.0, 0.3))
# Rounding of doubles: lengths of a few units, some dozen operations, and the transform to the normalised scene and back.
LIMIT = 1e-13


def camera(**fields):
    return Camera(**{"matrix": MATRIX, "width": 80, "height": 45, "window": WINDOW, **fields})


def rays(library, camera, raster, lens=(0.5, 0.5)):
    """Return camera rays. A distant object makes the core's normalised frame differ from the world's."""
    snapshot = tiny_scenes.scene([tiny_scenes.sphere(0, move(30, 5, 7) @ scale(2))], [tiny_scenes.lambert()], camera=camera)
    with Session.upload(snapshot, library) as session:
        return session.probe_camera(raster, lens)


def raster_points(width=80, height=45):
    corners = np.array([(0, 0), (width, 0), (0, height), (width, height), (width / 2, height / 2)])
    return np.concatenate([corners, uniforms(50, 2, 1).astype(float) * [width, height]])


def on_window(raster):
    left, right, bottom, top = WINDOW
    return np.stack([left + (right - left) * raster[:, 0] / 80, bottom + (top - bottom) * raster[:, 1] / 45], axis=1)


def test_perspective(library):
    raster = raster_points()
    origins, directions = rays(library, camera(), raster)
    local = np.concatenate([on_window(raster), -np.ones((len(raster), 1))], axis=1)
    assert np.allclose(origins, MATRIX[:3, 3], rtol=0, atol=10 * LIMIT)
    assert np.allclose(directions, local @ MATRIX[:3, :3].T, rtol=0, atol=LIMIT)
    assert np.allclose(directions @ -MATRIX[:3, 2], 1.0, rtol=0, atol=LIMIT)


def test_orthographic(library):
    raster = raster_points()
    origins, directions = rays(library, camera(kind=CameraKind.ORTHOGRAPHIC), raster)
    local = np.concatenate([on_window(raster), np.zeros((len(raster), 1))], axis=1)
    # The origin may be any point on the ray.
    off = origins - (local @ MATRIX[:3, :3].T + MATRIX[:3, 3])
    off -= np.outer(off @ MATRIX[:3, 2], MATRIX[:3, 2])
    assert np.allclose(off, 0.0, rtol=0, atol=10 * LIMIT)
    assert np.allclose(directions, -MATRIX[:3, 2], rtol=0, atol=LIMIT)


@pytest.mark.parametrize("kind", [CameraKind.PERSPECTIVE, CameraKind.ORTHOGRAPHIC])
def test_thin_lens(library, kind):
    """Rays start uniformly on the aperture and meet where the pinhole's ray hits the focal plane."""
    radius, focus = 0.25, 5.0
    raster = raster_points()[:6]
    u = midpoints(40, 40).astype(float)
    sharp = camera(kind=kind)
    blurred = dataclasses.replace(sharp, lens_radius=radius, focal_distance=focus)
    axis = -MATRIX[:3, 2]
    for point in raster:
        o, d = rays(library, sharp, point)
        focal = (o + d * ((focus - (o - MATRIX[:3, 3]) @ axis) / (d @ axis))[:, None])[0]
        origins, directions = rays(library, blurred, np.tile(point, (len(u), 1)), u)
        t = (focus - (origins - MATRIX[:3, 3]) @ axis) / (directions @ axis)
        assert np.allclose(origins + directions * t[:, None], focal, rtol=0, atol=100 * LIMIT)
        # Origins are uniform on the disk: a quarter of them lies within half the radius.
        start = origins - directions * (((origins - MATRIX[:3, 3]) @ axis) / (directions @ axis))[:, None]
        centre = o - d * (((o - MATRIX[:3, 3]) @ axis) / (d @ axis))[:, None]
        r = np.linalg.norm(start - centre, axis=1)
        assert r.max() <= radius * (1 + 1e-6) and r.max() > 0.97 * radius
        # 1600 grid points resolve areas to about the length of the rim in cells, 2 %.
        assert abs(np.mean(r < radius / 2) - 0.25) < 0.02
        assert np.linalg.norm((start - centre).mean(axis=0)) < 0.01 * radius


def equirectangular(x, y, p):
    latitude, longitude = p[0] + (p[1] - p[0]) * y, p[2] + (p[3] - p[2]) * x
    return np.cos(latitude) * np.sin(longitude), np.sin(latitude), -np.cos(latitude) * np.cos(longitude)


def tilted(theta, x, y):
    """Return the direction at angle theta from the axis -z, towards (x, y)."""
    r = np.hypot(x, y)
    return x / r * np.sin(theta), y / r * np.sin(theta), -np.cos(theta)


def equidistant(x, y, p):
    return tilted(np.hypot(2 * x - 1, 2 * y - 1) * p[0] / 2, x - 0.5, y - 0.5)


def equisolid(x, y, p):
    x, y = (x - 0.5) * p[2], (y - 0.5) * p[3]
    return tilted(2 * np.arcsin(np.hypot(x, y) / (2 * p[0])), x, y)


def polynomial(x, y, p):
    x, y = (x - 0.5) * p[1], (y - 0.5) * p[2]
    return tilted(-np.polynomial.polynomial.polyval(np.hypot(x, y), p[3:]), x, y)


def mirror_ball(x, y, _p):
    """Reflect a ray along -z at a ball and mirror the result along the axis, so that the ball's centre looks forward."""
    nx, ny = 2 * x - 1, 2 * y - 1
    n = np.stack([nx, ny, np.sqrt(1 - nx**2 - ny**2)], axis=1)
    mirrored = np.array([0.0, 0.0, -1.0]) + 2 * n[:, 2:] * n
    return mirrored[:, 0], mirrored[:, 1], -mirrored[:, 2]


def cylindrical(x, y, p):
    longitude, height = p[0] + (p[1] - p[0]) * x, (p[2] + (p[3] - p[2]) * y) / p[4]
    r = np.sqrt(1 + height**2)
    return np.sin(longitude) / r, height / r, -np.cos(longitude) / r


K = (-1.17e-05, -0.02, -3.35e-06, 3.1e-06, -2.6e-08)
PANORAMAS = {
    "equirectangular": (CameraKind.EQUIRECTANGULAR, equirectangular, (-1.2, 1.4, -3.0, 2.0)),
    "equidistant": (CameraKind.FISHEYE_EQUIDISTANT, equidistant, (3.5,)),
    "equisolid": (CameraKind.FISHEYE_EQUISOLID, equisolid, (10.5, 3.0, 36.0, 24.0)),
    "polynomial": (CameraKind.FISHEYE_POLYNOMIAL, polynomial, (3.1, 36.0, 24.0, *K)),
    "mirror ball": (CameraKind.MIRROR_BALL, mirror_ball, ()),
    "cylindrical": (CameraKind.CYLINDRICAL, cylindrical, (-2.0, 2.5, -1.0, 3.0, 1.5)),
}


@pytest.mark.parametrize("name", PANORAMAS)
def test_panorama(library, name):
    """Directions follow the projection's formula with the window's shift; no rays outside a circular picture."""
    kind, formula, numbers = PANORAMAS[name]
    numbers += (0.0,) * (8 - len(numbers))
    raster = raster_points()
    view = camera(kind=kind, panorama=numbers, window=(0.1, 1.1, -0.05, 0.95))
    _, directions = rays(library, view, raster)
    x, y = 0.1 + raster[:, 0] / 80, -0.05 + raster[:, 1] / 45
    with np.errstate(invalid="ignore"):
        local = np.stack(formula(x, y, numbers), axis=1)
    shown = np.any(directions != 0.0, axis=1)
    r = np.hypot(2 * x - 1, 2 * y - 1)
    sensor = np.hypot((x - 0.5) * 36, (y - 0.5) * 24)
    beyond = {
        "equidistant": r > 1,
        "equisolid": sensor > 21 * math.sin(3.0 / 4),
        "polynomial": np.abs(np.polynomial.polynomial.polyval(sensor, K)) > 3.1 / 2,
        "mirror ball": r > 1,
    }.get(name, np.zeros(len(x), bool))
    assert np.array_equal(shown, ~beyond) and shown.any()
    assert np.allclose(directions[shown], (local @ MATRIX[:3, :3].T)[shown], rtol=0, atol=10 * LIMIT)


def test_a_fisheye_leaves_its_corners_empty(library):
    """Corners of a fisheye have no rays and are opaque black, as in Cycles; inside the circle the world is visible."""
    view = Camera(kind=CameraKind.FISHEYE_EQUIDISTANT, panorama=(math.pi, *(0,) * 7), width=16, height=16, window=(0, 1, 0, 1))
    snapshot = tiny_scenes.scene(world=(0.5, 0.5, 0.5), camera=view)
    picture = tiny_scenes.render(snapshot)
    assert picture[0, 0].tolist() == [0, 0, 0, 1] and picture[8, 8].tolist() == [0.5, 0.5, 0.5, 1]


def test_blades(library):
    """Origins on a lens of three blades, rotated by a quarter turn, fill the triangle, narrowed by the ratio."""
    view = camera(kind=CameraKind.ORTHOGRAPHIC, matrix=np.eye(4), lens_radius=0.5, focal_distance=3.0)
    view = dataclasses.replace(view, aperture_blades=3, aperture_rotation=math.pi / 2, aperture_ratio=2.0)
    u = midpoints(60, 60).astype(float)
    origins, _ = rays(library, view, np.tile((40.0, 22.5), (len(u), 1)), u)
    centre, _ = rays(library, dataclasses.replace(view, lens_radius=0.0), (40.0, 22.5))
    p = (origins - centre)[:, :2] / 0.5 * [2.0, 1.0]
    # The sides' distance is half the radius; the sides' centres are at angles rotation + k turn / 3.
    normals = math.pi / 2 + 2 * math.pi / 3 * np.arange(3)
    across = p @ np.stack([np.cos(normals), np.sin(normals)])
    assert np.all(across <= 0.5 + 1e-6)
    # Uniformly: each third of the triangle has a third of the 3600 grid points, and their mean is the centre.
    assert np.allclose(np.bincount(across.argmax(axis=1), minlength=3) / len(u), 1 / 3, atol=0.01)
    assert np.linalg.norm(p.mean(axis=0)) < 0.01 and np.linalg.norm(p, axis=1).max() > 0.95


def test_depth_is_along_the_axis_and_clipped(library):
    """A plane across the view at depth 4 has depth 4 in every pixel; clipped planes are invisible."""
    wall = tiny_scenes.plane(0, move(z=-4.0))
    for start, end, want in ((0.1, 100.0, 4.0), (0.1, 3.9, 1e10), (4.1, 100.0, 1e10)):
        view = Camera(width=8, height=6, window=(-1, 1, -0.75, 0.75), clip_start=start, clip_end=end)
        snapshot = tiny_scenes.scene([wall], [tiny_scenes.lambert()], camera=view, passes=(Pass.COMBINED, Pass.DEPTH))
        depth = tiny_scenes.render(snapshot, Pass.DEPTH)
        assert depth.shape == (6, 8, 1)
        # One rounding to float32.
        assert np.allclose(depth, want, rtol=1e-7), (start, end)


def test_picture_is_the_right_way_up(library):
    """Row 0 is the bottom row: an emitting ball at the upper right lights the last rows' last columns."""
    glow = tiny_scenes.Material("glow", lobes=(), emission=(1, 1, 1))
    snapshot = tiny_scenes.scene(
        [tiny_scenes.sphere(0, move(2, 2, -5))], [glow], camera=Camera(width=9, height=9, window=(-1, 1, -1, 1))
    )
    picture = tiny_scenes.render(snapshot)[..., 0]
    rows, columns = np.nonzero(picture > 0.5)
    assert len(rows) and rows.min() > 4 and columns.min() > 4


def test_a_region_is_cut_from_the_whole(library):
    """The pixels of a border equal those of the whole picture, bit for bit; the error is that of the border's pixels."""
    whole = tiny_scenes.showroom(24, samples=2)
    part = dataclasses.replace(whole, camera=dataclasses.replace(whole.camera, x=5, y=7, region_width=11, region_height=9))
    for which in set(Pass) - {Pass.ERROR}:
        expected = tiny_scenes.render(whole, which)[7:16, 5:16]
        assert np.array_equal(tiny_scenes.render(part, which), expected), which.name


def test_mirrored_camera(library):
    """A camera matrix of determinant -1 sees the mirrored picture."""
    mirrored = MATRIX @ np.diag([-1.0, 1, 1, 1])
    raster = raster_points()
    _, directions = rays(library, camera(matrix=mirrored), raster)
    local = np.concatenate([on_window(raster), -np.ones((len(raster), 1))], axis=1) * [-1, 1, 1]
    assert np.allclose(directions, local @ MATRIX[:3, :3].T, rtol=0, atol=LIMIT)


def blackman_harris(x):
    """The window over x in [0, 1]."""
    return sum(a * math.cos(2 * math.pi * k * x) for k, a in enumerate((0.35875, -0.48829, 0.14128, -0.01168)))


@pytest.mark.parametrize("width", [1.0, 1.5, 3.0])
@pytest.mark.parametrize("kind", PixelFilter)
def test_filter(library, kind, width):
    count, cells = 200_000, 40
    offset = pixel_filter(kind, width, uniforms(count, 1, 6)[:, 0], library=library).astype(float)
    assert np.abs(offset).max() <= width / 2
    edges = np.linspace(-width / 2, width / 2, cells + 1)
    if kind == PixelFilter.BOX:
        share = np.full(cells, 1 / cells)
    else:
        fine = (np.arange(cells * 50) + 0.5) / (cells * 50)
        share = np.array([blackman_harris(x) for x in fine]).reshape(cells, 50).sum(axis=1)
        share /= share.sum()
    assert chi_square(np.histogram(offset, edges)[0], share * count) > LEVEL
    # Stratified numbers stay stratified: the offset grows with u.
    ordered = pixel_filter(kind, width, (np.arange(10000, dtype=np.float32) + 0.5) / 10000, library=library)
    assert np.all(np.diff(ordered) >= 0) and abs(ordered.mean()) < 1e-4 * width


def test_filter_reaches_the_pixel_it_should(library):
    """A filter of width 3 spreads light by one pixel, a filter of width 1 does not."""
    glow = tiny_scenes.Material("glow", lobes=(), emission=(1, 1, 1))
    # A wall x > 0 in an orthographic view of 8 pixels: its edge is between pixels 3 and 4.
    wall = tiny_scenes.Instance(mesh=0, matrix=move(5, 0, -2))
    view = Camera(kind=CameraKind.ORTHOGRAPHIC, width=8, height=1, window=(-4, 4, -0.5, 0.5))
    for width, reached in ((1.0, [0, 0, 0, 0]), (3.0, [0, 0, 0, 1])):
        snapshot = tiny_scenes.scene(
            [wall],
            [glow],
            meshes=[tiny_scenes.quad(10.0)],
            camera=view,
            samples=512,
            pixel_filter=PixelFilter.BLACKMAN_HARRIS,
            filter_width=width,
        )
        row = tiny_scenes.render(snapshot)[0, :4, 0]
        assert (row > 0).astype(int).tolist() == reached, row


def test_sampler(library):
    """Numbers are in [0, 1), equal for equal addresses, different for others, and stratified in pairs over 2^8 samples."""
    first = np.array([sampler(3, 5, 7, s, 32, library=library) for s in range(256)])
    assert first.min() >= 0.0 and first.max() < 1.0
    assert np.array_equal(first[17], sampler(3, 5, 7, 17, 32, library=library))
    for other in ((4, 5, 7), (3, 6, 7), (3, 5, 8)):
        assert not np.any(np.array([sampler(*other, s, 32, library=library) for s in range(4)]) == first[:4])
    for d in range(32):
        assert len(np.unique(np.floor(first[:, d] * 256))) == 256, f"dimension {d} is not stratified"
    for d in range(0, 32, 2):
        for a in range(9) if d == 4 or d >= 20 else ():
            b = 8 - a
            cell = np.floor(first[:, d] * 2**a) * 2**b + np.floor(first[:, d + 1] * 2**b)
            assert len(np.unique(cell)) == 256, f"dimensions {d}, {d + 1} are no (0, 2)-net"


def test_rotated_camera_sees_the_rotated_world(library):
    """The camera's matrix rotates the rays."""
    raster = raster_points()
    _, straight = rays(library, camera(matrix=np.eye(4)), raster)
    _, turned = rays(library, camera(matrix=rotate_x(1.0)), raster)
    assert np.allclose(turned, straight @ rotate_x(1.0)[:3, :3].T, rtol=0, atol=LIMIT)
