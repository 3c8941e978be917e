"""A closed room whose walls emit 1 - a and reflect a: after k bounces the radiance is 1 - a^k, for each depth."""

import numpy as np
import pytest
import tiny_scenes
from significance import mean_and_error

from addon.bindings.abi import Pass
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, Lobe, Material, MeshData

ALBEDO = 0.5
PIXELS = 32


def room(shape, roulette, bounces, samples):
    """Return a closed room seen from inside. Russian roulette depends on the largest channel: a white one ends no path."""
    import trimesh

    other = ALBEDO if roulette else 1.0
    wall = Material("wall", lobes=(Lobe(color=(ALBEDO, other, other)),), emission=(1.0 - ALBEDO,) * 3)
    ball = trimesh.creation.icosphere(subdivisions=2)
    # In a mesh light sampling selects faces too.
    meshes = [MeshData.from_trimesh(ball)] if shape == "mesh" else []
    things = [Instance(mesh=0)] if meshes else [tiny_scenes.sphere()]
    camera = tiny_scenes.pencil((0.1, 0.2, 0.0), (0.5, 0.3, -1), pixels=PIXELS)
    passes = (Pass.COMBINED, Pass.EMISSION)
    return tiny_scenes.scene(
        things, [wall], [], meshes, camera=camera, samples=samples, max_bounces=bounces, passes=passes, threads=2
    )


def judge(shape, roulette, bounces, samples, largest_error):
    with Session.upload(room(shape, roulette, bounces, samples)) as session:
        assert session.render_all()
        values, seen = (session.read(which)[..., 0].astype(float).ravel() for which in (Pass.COMBINED, Pass.EMISSION))
        assert session.statistics().invalid_samples == 0
    # The pass Emission is that of the first wall.
    assert np.allclose(seen, 1.0 - ALBEDO, rtol=1e-6)
    mean, error = mean_and_error(values)
    want = 1.0 - ALBEDO ** (bounces + 2)
    assert error <= largest_error
    # Each vertex rounds a few times.
    assert abs(mean - want) <= 4.0 * error + 1e-6, (mean, error, want)


@pytest.mark.parametrize("bounces", range(11))
def test_every_depth(library, bounces):
    """Each sample inside an exact ball is correct up to rounding."""
    judge("exact", False, bounces, 16, 1e-6)


@pytest.mark.parametrize("bounces", range(11))
def test_every_depth_within_a_mesh(library, bounces):
    judge("mesh", False, bounces, 64, 2e-4)


@pytest.mark.parametrize("bounces", range(11))
def test_every_depth_under_roulette(library, bounces):
    """Russian roulette begins at the second bounce; at the tenth a sample's deviation is 0.13."""
    judge("exact", True, bounces, 64 if bounces < 4 else 576, 2e-4)


@pytest.mark.slow
@pytest.mark.parametrize("roulette", [True, False])
@pytest.mark.parametrize("shape", ["exact", "mesh"])
def test_every_depth_to_the_last_digit(library, shape, roulette):
    for bounces in range(11):
        judge(shape, roulette, bounces, 768, 2e-4)
