"""Effects that need several rays per pixel: anti-aliasing, lenses, global illumination; and extreme parameters."""

import dataclasses
import math

import numpy as np
import ten_scenes
import tiny_scenes
from tiny_scenes import lambert, look_at, move, plane, rgb, sphere

from addon.bindings.abi import Integrator, LobeKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Camera, Instance, Light, Lobe, Material, MeshData

from . import studio
from .chapter import Figure, Picture, worst
from .studio import SINGLE, SINGLE_WHY


def _edge(pixels):
    """Returns a glowing half-plane with the slanted edge y = slope x, seen from above, and its exact share of each pixel."""
    slope, window = 0.3127, 1.0
    far = 50.0
    corners = [(-far, -slope * far, 0), (far, slope * far, 0), (far, far * 2, 0), (-far, far * 2, 0)]
    mesh = MeshData("edge", corners, [(0, 1, 2), (0, 2, 3)])
    glow = Material("glow", lobes=(), emission=(1, 1, 1))
    camera = tiny_scenes.pencil((0, 0, 3.0), width=2 * window, pixels=pixels)
    shot = tiny_scenes.scene([Instance()], [glow], meshes=[mesh], camera=camera)
    size = 2 * window / pixels
    # The share above a line: the mean over 4000 columns of the pixel, each exact.
    left = -window + size * np.arange(pixels)
    columns = left[:, None] + size * (np.arange(4000) + 0.5) / 4000
    below = left[:, None, None]
    share = np.clip((below + size - slope * columns[None]) / size, 0.0, 1.0).mean(axis=-1)
    return shot, share


def antialiasing(quick):
    pixels = 64
    shot, share = _edge(pixels)
    cut = (share > 0.0) & (share < 1.0)
    errors = {}
    for samples in (1, 4, 16, 64, 256):
        deviations = [
            studio.render(shot, samples=samples, seed=seed, integrator=Integrator.PATH)[..., 0] - share for seed in range(4)
        ]
        errors[samples] = float(np.sqrt(np.mean(np.square(deviations)[:, cut])))
    figures = [
        Figure.at_most(
            f"error of {int(cut.sum())} pixels on a straight edge, {samples} samples",
            errors[samples],
            float(np.sqrt(np.mean((share * (1 - share))[cut]) / samples)) * 1.1,
            "the error of random samples, sqrt(p (1 - p)/N), and 10 % for 4 seeds",
        )
        for samples in errors
    ]
    what = "exponent of the error's fall from 4 to 256 samples"
    slope = math.log(errors[256] / errors[4]) / math.log(64)
    figures.append(Figure.at_most(what, slope, -0.6, "random samples: -0.5; on an edge a low-discrepancy sequence: -0.75"))
    inside = np.abs(studio.render(shot, samples=16)[..., 0] - share)[~cut].max()
    figures.append(Figure.at_most("error of pixels without an edge", inside, SINGLE, SINGLE_WHY))
    ball = studio.classic(
        [sphere(), plane(1, move(z=-1.0))], [lambert((0.8, 0.3, 0.2)), lambert(0.5)], [studio.lamp((3, -4, 5), 60.0)]
    )
    ball = dataclasses.replace(ball, camera=studio.perspective((0, -6, 2), (0, 0, 0), 48, 0.3))
    return tuple(figures), tuple(
        Picture(
            f"n{samples}",
            f"{samples} sample{'s' if samples > 1 else ''} a pixel, each pixel enlarged",
            studio.render(ball, samples=samples),
        )
        for samples in (1, 4, 16)
    )


def lens(quick):
    radius, focus = 0.25, 5.0
    camera = Camera(matrix=look_at((1, -4, 2), (0, 0, 0)), width=32, height=32, lens_radius=radius, focal_distance=focus)
    rng = np.random.default_rng(4)
    u, axis = rng.random((1000, 2)), -camera.matrix[:3, 2]
    eye = camera.matrix[:3, 3]
    scatter, widest = 0.0, 0.0
    with Session.upload(tiny_scenes.scene(camera=camera)) as session:
        for raster in ((3.0, 5.0), (16.0, 16.0), (30.0, 9.0)):
            origins, directions = session.probe_camera(np.tile(raster, (len(u), 1)), u)
            forward = directions @ axis
            at_focus = origins + directions * ((focus - (origins - eye) @ axis) / forward)[:, None]
            scatter = max(scatter, float(np.linalg.norm(at_focus - at_focus.mean(axis=0), axis=1).max()))
            double = origins + directions * ((2 * focus - (origins - eye) @ axis) / forward)[:, None]
            widest = max(widest, float(np.linalg.norm(double - double.mean(axis=0), axis=1).max()))
    width, height = (160, 90) if quick else (480, 270)
    shot = studio.from_blender("showcase", width, height)
    return (
        Figure.at_most(
            "largest distance between 1000 rays of a pixel in the plane in focus", scatter, 1e-6, "single precision"
        ),
        Figure(
            "radius of the circle at twice the distance in focus",
            widest,
            0.95 * radius,
            1.001 * radius * 1.02,
            f"{radius} ± 5 %",
            "R |2f - f|/f = R; the outermost of 1000 random points, about their own middle",
        ),
    ), (Picture("showcase", "The showcase through a lens in focus", studio.render(shot, samples=16 if quick else 64)),)


def _furnace(albedo, bounces, samples):
    """Returns the mean of 32 x 32 pixels inside a ball of emission 1, and its standard error."""
    shot = tiny_scenes.furnace(albedo, 1.0, samples=samples, max_bounces=bounces)
    camera = dataclasses.replace(shot.camera, width=32, height=32, region_width=32, region_height=32)
    values = studio.render(dataclasses.replace(shot, camera=camera))[..., 0]
    return float(values.mean()), float(values.std() / math.sqrt(values.size))


def global_illumination(quick):
    figures = []
    samples = 16 if quick else 64
    for albedo in (0.2, 0.8):
        mean, error = _furnace(albedo, 1000, samples)
        what = f"inside a ball of albedo {albedo} that glows by 1"
        figures.append(Figure.near(what, mean, 1 / (1 - albedo), 4 * error + 1e-5, "e/(1 - a); four standard errors"))
    for bounces in (0, 1, 2, 4):
        mean, error = _furnace(0.5, bounces, samples)
        what = f"the same of albedo 0.5 with {bounces} bounces after the first"
        want = 2.0 - 0.5 ** (bounces + 1)
        figures.append(Figure.near(what, mean, want, 4 * error + 1e-5, "1 + a + a² + ... + a^(bounces + 1)"))
    camera = studio.parallel(width=1e-6, pixels=4)
    direct = studio.classic([plane()], [lambert(0.6)], [studio.lamp()], max_bounces=0, camera=camera)
    difference = worst(studio.render(direct, integrator=Integrator.PATH), studio.render(direct))
    what = "Path Tracing without bounces and Classic, a point of a matt plane under a lamp: largest relative difference"
    figures.append(Figure.at_most(what, difference, SINGLE, "the same formula for the same light"))
    size = 128 if quick else 256
    shot = studio.from_blender("cornell", size, size)
    classic = studio.render(shot, integrator=Integrator.CLASSIC, samples=16)
    path = studio.render(shot, integrator=Integrator.PATH, samples=4 * samples)
    share = classic[..., :3].mean() / path[..., :3].mean()
    what = "closed box: share of Path Tracing's light that Classic has"
    why = "the lamp shines at the ceiling: nearly all other light is reflected by the ceiling"
    figures.append(Figure(what, float(share), 0.0, 0.9, "below 0.9", why))
    return tuple(figures), (
        Picture("classic", "Classic: direct light of the lamp", classic),
        Picture("path", "Path Tracing: the same room", path),
    )


def stability(quick):
    figures = []
    shot = ten_scenes.everything()
    base = studio.render(shot, which=Pass.COMBINED)

    def squares(picture):
        return picture[..., :3].reshape(3, 8, 3, 8, 3).mean(axis=(1, 3))

    for size in (2.0**-30, 2.0**30):
        other = studio.render(ten_scenes.resized(shot, size))
        what = f"{size:.1e} times the size: pixels that differ by a bit"
        figures.append(
            Figure.near(what, int(np.sum(np.any(other != base, axis=-1))), 0, 0, "the scene is brought to unit size")
        )
    for size in (1e-6, 1e6, 1e9):
        error = worst(squares(studio.render(ten_scenes.resized(shot, size))), squares(base))
        what = f"{size:g} times the size: largest relative difference of 9 squares"
        figures.append(Figure.at_most(what, error, 1e-4, "last bits; a path that met another thing would be 1/512"))
    for offset in ((8192.0, -4096.0, 2048.0), (2.0**23, -(2.0**22), 2.0**23)):
        error = worst(squares(studio.render(ten_scenes.moved(shot, offset))), squares(base))
        what = f"{offset[0]:g} units away: the same"
        figures.append(Figure.at_most(what, error, 1e-4, "placements in double precision, about the scene's own middle"))
    figures += _lobes_at_the_ends()
    return tuple(figures), (
        Picture("one", "A scene of everything, 24 pixels wide", base),
        Picture("far", "A billion times as large", studio.render(ten_scenes.resized(shot, 1e9))),
    )


def _lobes_at_the_ends():
    """Surfaces without absorption under a white sky: all light must come back, for any parameters."""
    mirror = Material("rough", lobes=(Lobe(LobeKind.GLOSSY, color=(1, 1, 1), roughness=math.sqrt(0.001)),))
    void = Material("void", lobes=(Lobe(LobeKind.GLASS, color=(1, 1, 1), ior=1.0000001, roughness=0.0),))
    for name, material, why in (
        ("α = 0.001", mirror, "a mirror with a spread of a tenth of a degree"),
        ("glass of IOR 1.0000001", void, "no refraction and no loss"),
    ):
        camera = studio.parallel((0.0, 0.0, 4.0), width=1.2, pixels=16)
        shot = tiny_scenes.scene([sphere()], [material], world=1.0, camera=camera, samples=64, max_bounces=16)
        values = studio.render(shot)[..., 0]
        yield Figure.near(f"a ball with {name} under a white sky, mean", float(values.mean()), 1.0, 2e-3, why)
    huge = studio.classic([plane()], [lambert()], [Light("lamp", move(z=1e6), emission=rgb(1e12))], max_bounces=0)
    value = studio.render(dataclasses.replace(huge, camera=tiny_scenes.pencil((3, 0, 4))))[0, 0, 0]
    yield Figure.near("a lamp of 1e12 a million units away", float(value), 1 / math.pi, 1e-6, "I/d² = 1")


CHAPTERS = (antialiasing, lens, global_illumination, stability)
