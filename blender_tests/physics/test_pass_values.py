"""Passes with known values: mist, occlusion, denoising features; and light passes that sum to Combined."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes
from tiny_scenes import lambert, move, pencil, plane, rotate_y, scale, scene, sphere

from addon.bindings.enums import CameraKind, Integrator, LobeKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Instance, Lobe, Material, Principled

# A few float roundings of numbers that are at most 1.
EXACT = 1e-6
PARTS = [Pass.EMISSION, Pass.ENVIRONMENT, *(p for p in Pass if Pass.DIFFUSE_DIRECT <= p <= Pass.TRANSMISSION_COLOR)]


def passes_of(snapshot, *wanted):
    """Return the passes of one render, each (height, width, channels) in double."""
    snapshot = tiny_scenes.with_settings(snapshot, passes=(Pass.COMBINED, *wanted))
    with Session.upload(snapshot) as session:
        assert session.render_all(None)
        return [session.read(which).astype(np.float64) for which in wanted]


def down(kind=CameraKind.ORTHOGRAPHIC, half=9.0, pixels=3, **fields):
    """Return a camera 4 above the plane z = 0, looking straight down beside the origin."""
    matrix = tiny_scenes.look_at((1, 2, 4), (1, 2, 0), (0, 1, 0))
    window = (-half, half, -half, half)
    return Camera(matrix=matrix, kind=kind, width=pixels, height=pixels, window=window, clip_start=0.5, **fields)


def mist(integrator, camera, falloff, **fields):
    settings = {"mist_start": 1.0, "mist_depth": 12.0, "mist_falloff": falloff, "samples": 1, **fields}
    return passes_of(scene([plane()], [lambert()], camera=camera, integrator=integrator, **settings), Pass.MIST)[0][..., 0]


@pytest.mark.parametrize("integrator", Integrator)
@pytest.mark.parametrize("falloff", [0.5, 1.0, 2.0])
def test_mist_of_parallel_rays_counts_along_the_axis(integrator, falloff):
    """An orthographic camera uses the depth along the axis, 4 in every pixel."""
    assert np.allclose(mist(integrator, down(), falloff), (3 / 12) ** falloff, rtol=0, atol=EXACT)


@pytest.mark.parametrize("integrator", [Integrator.CLASSIC, Integrator.NORMALS])
def test_mist_of_a_perspective_counts_the_distance(integrator):
    """A perspective camera uses the distance; one sample passes through pixel centres, at slopes -2, 0, 2 on both axes."""
    got = mist(integrator, down(CameraKind.PERSPECTIVE, 3.0), 1.0, mist_depth=20.0)
    x, y = np.meshgrid([-2, 0, 2], [-2, 0, 2])
    assert np.allclose(got, (4 * np.sqrt(1 + x**2 + y**2) - 1) / 20, rtol=0, atol=EXACT)


@pytest.mark.parametrize("integrator", [Integrator.PATH, Integrator.CLASSIC])
def test_mist_sees_through_veils(integrator):
    """A veil of opacity 0.25 at 2 below the camera, the ground at 4: 1 - (0.25 (1 - m2) + 0.75 (1 - m4))."""
    veil = plane(1, move(z=2))
    snapshot = scene(
        [plane(), veil],
        [lambert(), tiny_scenes.veiled(lambert(), 0.25)],
        camera=down(),
        integrator=integrator,
        samples=4096,
        mist_start=0.0,
        mist_depth=8.0,
        mist_falloff=1.0,
    )
    got = passes_of(snapshot, Pass.MIST)[0]
    # A path passes the veil with probability 0.75 / (0.75 + 0.25) and finds the ground's 0.5 or not: 5 standard errors of the
    # mean of 4096 samples. CLASSIC splits and has no noise.
    error = 5 * 0.5 * math.sqrt(0.25 * 0.75 / 4096) if integrator == Integrator.PATH else EXACT
    assert np.allclose(got, 0.25 * 0.25 + 0.75 * 0.5, rtol=0, atol=error)


@pytest.mark.parametrize("integrator", Integrator)
@pytest.mark.parametrize("clip", [0.1, 1.5])
def test_denoising_depth_counts_from_where_the_camera_begins_to_see(integrator, clip):
    """Cycles 5.0.1: the distance minus the start of clipping."""
    camera = dataclasses.replace(pencil((3, 0, 4)), clip_start=clip)
    depth = passes_of(scene([plane()], [lambert()], camera=camera, integrator=integrator), Pass.DENOISING_DEPTH)[0]
    assert np.allclose(depth, 5 - clip, rtol=EXACT)


@pytest.mark.parametrize("integrator", [Integrator.CLASSIC, Integrator.NORMALS])
def test_a_perspective_begins_on_a_plane(integrator):
    """Cycles 5.0.1: (4 - clip) / cos at pixel centres, at slopes -2, 0, 2 along both axes; z points forwards."""
    snapshot = scene([plane()], [lambert()], camera=down(CameraKind.PERSPECTIVE, 3.0), integrator=integrator)
    depth, normal = passes_of(snapshot, Pass.DENOISING_DEPTH, Pass.DENOISING_NORMAL)
    x, y = np.meshgrid([-2, 0, 2], [-2, 0, 2])
    assert np.allclose(depth[..., 0], (4 - 0.5) * np.sqrt(1 + x**2 + y**2), rtol=EXACT)
    assert np.allclose(normal, (0, 0, -1), rtol=0, atol=EXACT)


@pytest.mark.parametrize("integrator", Integrator)
def test_denoising_normal_of_a_panorama_is_in_its_own_frame(integrator):
    """Cycles 5.0.1: forwards is +x, left +y, up +z. Inside a ball every normal looks back along the ray, or away from it."""
    view = Camera(
        kind=CameraKind.EQUIRECTANGULAR, panorama=(-1.5, 1.5, -3.0, 3.0, 0, 0, 0, 0), width=1, height=1, clip_start=0.25
    )
    view = dataclasses.replace(view, window=(0.5 - 1e-6, 0.5 + 1e-6, 0.5 - 1e-6, 0.5 + 1e-6))
    snapshot = scene([sphere(0, scale(2.0))], [lambert()], camera=view, integrator=integrator)
    normal, depth = passes_of(snapshot, Pass.DENOISING_NORMAL, Pass.DENOISING_DEPTH)
    # The pixel is 6e-6 wide.
    assert np.allclose(normal[0, 0], (-1, 0, 0), rtol=0, atol=1e-5)
    assert np.allclose(depth, 2 - 0.25, rtol=EXACT)


@pytest.mark.parametrize("integrator", [Integrator.PATH, Integrator.CLASSIC])
def test_features_look_into_mirrors(integrator):
    """A mirror of colour 0.5 shows the wall's normal, and the wall's albedo times the mirror's colour."""
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(0.5, 0.5, 0.5)),))
    floor, wall = plane(0), plane(1, move(x=-4.0) @ rotate_y(math.pi / 2))
    camera = pencil((2, 0, 2), (0, 0, 0))
    snapshot = scene([floor, wall], [mirror, lambert((0.2, 0.4, 0.8))], camera=camera, integrator=integrator, max_bounces=4)
    albedo, normal, depth = passes_of(snapshot, Pass.ALBEDO, Pass.DENOISING_NORMAL, Pass.DENOISING_DEPTH)
    r = math.sqrt(0.5)
    assert np.allclose(albedo[0, 0], (0.1, 0.2, 0.4), rtol=EXACT)
    # The wall's normal is +x: towards the camera and down in camera space.
    assert np.allclose(normal[0, 0], (0, -r, -r), rtol=0, atol=EXACT)
    # 2 sqrt(2) to the mirror, and half of 4 sqrt(2) beyond.
    assert np.allclose(depth, 4 * math.sqrt(2.0), rtol=EXACT)


def test_features_of_classic_weigh_what_a_veil_splits():
    """A veil of opacity 0.1 counts as clear: the albedo of the ground is weighted by the transmittance, its normal is not."""
    snapshot = scene(
        [plane(), plane(1, move(z=2))],
        [lambert(0.5), tiny_scenes.veiled(lambert(0.8), 0.1)],
        camera=pencil((0, 0, 4)),
        integrator=Integrator.CLASSIC,
    )
    albedo, normal = passes_of(snapshot, Pass.ALBEDO, Pass.DENOISING_NORMAL)
    assert np.allclose(albedo[0, 0], 0.9 * 0.5, rtol=EXACT) and np.allclose(normal[0, 0], (0, 0, -1), rtol=0, atol=EXACT)


def test_classic_fills_what_the_camera_sees_itself():
    """CLASSIC fills emission, environment and colours, but not the light passes."""
    glow = Material("glow", lobes=(Lobe(color=(0.2, 0.4, 0.6)),), emission=(3.0, 2.0, 1.0))
    square = Instance(matrix=move(-0.5), materials=(0,))
    camera = Camera(
        matrix=move(z=4), kind=CameraKind.ORTHOGRAPHIC, width=2, height=1, window=(-1, 1, -0.5, 0.5), clip_start=0.0
    )
    snapshot = scene([square], [glow], meshes=[tiny_scenes.quad(1.0)], world=0.25, camera=camera, integrator=Integrator.CLASSIC)
    emission, sky, color = passes_of(snapshot, Pass.EMISSION, Pass.ENVIRONMENT, Pass.DIFFUSE_COLOR)
    assert np.allclose(emission[0], [(3, 2, 1), (0, 0, 0)], rtol=EXACT)
    assert np.allclose(sky[0], [(0, 0, 0), (0.25, 0.25, 0.25)], rtol=EXACT)
    assert np.allclose(color[0], [(0.2, 0.4, 0.6), (0, 0, 0)], rtol=EXACT)


def whole(snapshot):
    """Return Combined, and the sum of the light passes as in a compositor."""
    combined, *parts = passes_of(snapshot, Pass.COMBINED, *PARTS)
    part = dict(zip(PARTS, parts, strict=True))
    total = part[Pass.EMISSION] + part[Pass.ENVIRONMENT]
    for first in (Pass.DIFFUSE_DIRECT, Pass.GLOSSY_DIRECT, Pass.TRANSMISSION_DIRECT):
        total = total + part[Pass(first + 2)] * (part[first] + part[Pass(first + 1)])
    return combined[..., :3], total


# Every part is divided by its colour and multiplied again, in float, and the sum has seven terms.
SUMMED = 2.0**-20


def test_parts_give_a_panorama_again():
    """The light passes of a fisheye sum to Combined, and are 0 outside its circle."""
    view = Camera(
        matrix=tiny_scenes.look_at((1.5, -6.0, 2.5), (0, 0, 0.8)),
        kind=CameraKind.FISHEYE_EQUIDISTANT,
        panorama=(math.pi, *(0,) * 7),
        width=24,
        height=24,
        window=(0, 1, 0, 1),
    )
    combined, total = whole(dataclasses.replace(tiny_scenes.showroom(24, samples=8), camera=view))
    assert np.abs(total - combined).max() <= SUMMED * combined.max()
    assert np.all(total[0, 0] == 0.0) and combined.max() > 1.0


def pane(clear):
    """Return a small pane of smooth glass 2 above the ground, seen from above; clear: the film treats it as transparent."""
    glass = Material("glass", lobes=(Lobe(LobeKind.GLASS, color=(1, 1, 1), ior=1.5, roughness=0.0),))
    slab = Instance(kind=3, materials=(1,), matrix=move(z=2) @ scale(0.3, 0.3, 0.01))
    settings = {"film_transparent": True, "transparent_glass": clear, "glass_roughness": 0.1, "max_bounces": 6, "samples": 256}
    return glass, slab, {"camera": pencil((0.1, 0, 5), (0.1, 0, 0)), **settings}


def test_clamped_parts_give_the_picture_again():
    """Clamping applies to the pass of light seen through clear glass too."""
    glass, slab, settings = pane(True)
    glow = Material("glow", lobes=(), emission=(9, 9, 9))
    combined, total = whole(scene([plane(0), slab], [glow, glass], clamp_indirect=1.0, **settings))
    assert np.abs(total - combined).max() <= SUMMED * combined.max()
    assert combined.max() > 0.0


def test_occlusion_is_that_of_the_first_surface():
    """Ambient occlusion is that of the pane, which sees the open sky, not of the ground behind it."""
    for clear in (False, True):
        glass, slab, settings = pane(clear)
        got = passes_of(scene([plane(0), slab], [lambert(), glass], world=1.0, **settings), Pass.AMBIENT_OCCLUSION)[0]
        assert np.allclose(got, 1.0, rtol=0, atol=EXACT), clear


def plastic(**fields):
    return Material("plastic", lobes=(Lobe(LobeKind.PRINCIPLED, principled=Principled(base_color=(0.6, 0.5, 0.4), **fields)),))


# Surfaces whose next rays measure occlusion, with or without weights, or which need rays of their own.
SURFACES = {
    "lambert": lambert(),
    "black": lambert(0.0),
    "plastic": plastic(roughness=0.3),
    "half metal": plastic(roughness=0.1, metallic=0.4),
    "metal": plastic(roughness=0.4, metallic=1.0),
    "mirror": Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(1, 1, 1)),)),
}


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize("reach, want", [(0.0, 0.5), (4.0, None), (1.0, 1.0)])
def test_half_of_the_sky_is_behind_a_wall(reach, want, surface):
    """Before an infinite wall, 2 away: the wall occludes half of the projected hemisphere, or, with a reach, the segment of the
    unit disk beyond 2 / reach."""
    floor, wall = plane(0), plane(0, move(x=-2.0) @ rotate_y(math.pi / 2))
    samples = 16384
    camera = pencil((0, 0, 4))
    snapshot = scene([floor, wall], [SURFACES[surface]], world=1.0, camera=camera, occlusion_distance=reach, samples=samples)
    if want is None:
        c = 2.0 / reach
        want = 1.0 - (math.acos(c) - c * math.sqrt(1 - c * c)) / math.pi
    got = passes_of(snapshot, Pass.AMBIENT_OCCLUSION)[0]
    # Occluded rays have weights of at most 2 with mean 1: a sample's variance is at most 2 (1 - want). The limit is 5 standard
    # errors of independent samples; stratified ones are not worse.
    assert np.allclose(got, want, rtol=0, atol=5 * math.sqrt(2 * (1 - want) / samples) + EXACT)
