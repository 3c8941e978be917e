"""Filter Glossy and Fast GI change the light: the change that a render tells is that of two converged renders."""

import dataclasses
import math

import numpy as np
import pytest
import tiny_scenes as tiny
from tiny_scenes import lambert, move, rgb, rotate_x, scale

from addon.bindings.enums import LobeKind, Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, Lobe, Material
from addon.measure.render_report import changed_light

MIRROR = Material("mirror", lobes=(Lobe(LobeKind.GLOSSY, color=rgb(0.9), roughness=0.15),))
FAST = {"fast_bounces": 1, "fast_distance": 0.8, "fast_factor": 0.7}
ADDED = {"ambient": 0.5, "fast_distance": 0.8}


def corner(pixels=24, samples=256, **settings):
    """A matt floor and a bright glossy wall beside it in an even sky: much light of the floor is reflected by the wall."""
    wall = move(y=0.5, z=0.5) @ rotate_x(math.pi / 2) @ scale(2.0)
    instances = [
        Instance(mesh=0, matrix=scale(10.0), materials=(0,), name="floor"),
        Instance(mesh=0, matrix=wall, materials=(1,), name="wall"),
        Instance(mesh=0, matrix=move(y=-0.8, z=1.2) @ rotate_x(2.2), materials=(2,), name="glow"),
    ]
    glow = Material("glow", lobes=(), emission=rgb(3.0))
    camera = tiny.pencil((0.0, 0.0, 0.4), (0.0, 0.1, 0.0), 0.6, pixels)
    fields = {"max_bounces": 3, "samples": samples, **settings}
    return tiny.scene(instances, [lambert(0.8), MIRROR, glow], (), [tiny.quad(1.0)], 0.5, camera, **fields)


def told(snapshot):
    """Return the mean luminance with its standard error from halves of the pixels' noise, and the error's report."""
    with Session.upload(snapshot) as session:
        assert session.render_all()
        picture = session.read(Pass.COMBINED)[..., :3].astype(np.float64) @ (0.2126, 0.7152, 0.0722)
        noise = session.read(Pass.ERROR)[..., 0].astype(np.float64)
        return picture.mean(), math.sqrt((noise**2).sum()) / picture.size, session.error()


@pytest.mark.parametrize("settings, name", [
    pytest.param({"filter_glossy": 10.0}, "filtered", id="Filter Glossy"),
    pytest.param(FAST, "guessed", id="Fast GI, replace"),
    pytest.param(ADDED, "guessed", id="Fast GI, add"),
])  # fmt: skip
def test_the_told_change_is_that_of_two_renders(settings, name):
    """The difference of the means has the error of both; told is 1.96 standard errors. 4 of all of them leave 6e-5."""
    passes = {"passes": (Pass.COMBINED, Pass.ERROR)}
    (exact, exact_error, none), (changed, changed_error, error) = (told(corner(**passes, **more)) for more in ({}, settings))
    share, half = getattr(error, name), getattr(error, f"{name}_error")
    wanted = (exact - changed) / exact
    noise = math.hypot(exact_error, changed_error) / exact
    assert abs(share - wanted) <= 4 * math.hypot(half / 1.96, noise), (share, half, wanted, noise)
    # The change is beyond its error, and its error is small.
    assert abs(share) > 1.5 * half > 0.0 and abs(wanted) > 4 * noise, (share, half, wanted, noise)
    assert getattr(none, name) == 0.0 and getattr(none, f"{name}_error") == 0.0


@pytest.mark.parametrize("settings", [{"filter_glossy": 10.0}, FAST, ADDED])
def test_the_told_error_is_that_of_the_told_change(settings):
    """Over seeds, the told change varies as its error says: the mean square of 24 is within a factor of 2, at 4 sigmas."""
    name = "filtered" if "filter_glossy" in settings else "guessed"
    errors = [told(corner(8, 64, seed=seed, passes=(Pass.COMBINED, Pass.ERROR), **settings))[2] for seed in range(24)]
    shares = np.array([getattr(error, name) for error in errors])
    halves = np.array([getattr(error, f"{name}_error") for error in errors]) / 1.96
    ratio = shares.var(ddof=1) / (halves**2).mean()
    # Samples of one sequence vary less than independent ones. A variance of 24 numbers has a relative error of 0.3.
    assert ratio < 1.0 + 4 * 0.3, (shares, halves)


def test_no_pair_changes_the_picture():
    """The picture of a filter that changes no lobe is the one without it, though its paths send pairs."""
    rough = Material("rough", lobes=(Lobe(LobeKind.GLOSSY, color=rgb(0.9), roughness=1.0),))
    plain = corner(8, 64)
    plain = dataclasses.replace(plain, materials=(plain.materials[0], rough, plain.materials[2]))
    blurred = tiny.with_settings(plain, filter_glossy=10.0)
    assert np.array_equal(tiny.render(plain), tiny.render(blurred))
    with Session.upload(blurred) as session:
        assert session.render_all() and session.error().filtered == 0.0


def test_light_that_a_setting_alone_gives_has_no_share():
    """The library tells an infinite interval where nothing is left without the setting."""
    assert "unknown" in changed_light({"error_guessed": 0.0, "error_guessed_error": math.inf}, "error_guessed")
    assert changed_light({"error_guessed": -0.5, "error_guessed_error": 0.25}, "error_guessed").endswith(
        "added about 50 % of the light, give or take 25 %"
    )
    assert changed_light({}, "error_guessed") == ""
