"""Light that a varying sky sends from behind a face, where the shading normal lets it shine: weighed as in Cycles."""

import dataclasses

import numpy as np
import pytest
import tiny_scenes

from addon.bindings.enums import Coordinate, Environment, Interpolation, NodeKind
from addon.bindings.snapshot import Image, Instance, MeshData, Node, NodeRef, World

TILT = np.radians(60.0)
ROWS = 8


def picture(radiances, samples):
    """Return the light of a square whose normals are tilted, under a sky of rows of these radiances, from below to above."""
    square = tiny_scenes.quad()
    normals = np.tile((np.sin(TILT), 0.0, np.cos(TILT)), (4, 1))
    tilted = MeshData("tilted", square.positions, square.triangles, normals=normals)
    texels = np.repeat(np.asarray(radiances, np.float32)[:, None, None], 3, axis=2)
    direction = Node(NodeKind.COORDINATE, Coordinate.GENERATED)
    sky = Node(
        NodeKind.ENVIRONMENT,
        Environment.EQUIRECTANGULAR,
        flags=int(Interpolation.CLOSEST) << 4,
        image_count=1,
        inputs=(NodeRef(0),),
    )
    scene = tiny_scenes.scene(
        [Instance(mesh=0, materials=(0,))], [tiny_scenes.lambert(1.0)], meshes=[tilted], samples=samples, max_bounces=0
    )
    world = World(NodeRef(1), nodes=(direction, sky), map_resolution=64)
    return tiny_scenes.radiance(dataclasses.replace(scene, images=(Image("sky", texels),), world=world))[0]


def expected(radiances):
    """Return the light by quadrature: all that arrives from above the face, and from below the weight of light samples."""
    z = (np.arange(4000) + 0.5) / 2000.0 - 1.0
    elevation, turn = np.arcsin(z)[:, None], (2 * np.pi * (np.arange(2000) + 0.5) / 2000)[None]
    rows = np.minimum((ROWS * (elevation / np.pi + 0.5)).astype(int), ROWS - 1)
    radiance = np.asarray(radiances)[rows]
    in_proportion = radiance / (4 * np.pi * radiance.mean())
    by_lobe = np.maximum(np.sin(TILT) * np.cos(elevation) * np.cos(turn) + np.cos(TILT) * np.sin(elevation), 0.0) / np.pi
    weight = np.where(elevation > 0.0, 1.0, in_proportion**2 / (in_proportion**2 + by_lobe**2))
    return (by_lobe * radiance * weight).mean() * 4 * np.pi


@pytest.mark.parametrize("bright", range(1, ROWS))
def test_it_is_weighed_in_proportion_to_its_radiance(bright):
    """The noise is 0.1 %, and quadrature errs less; the density of the samples errs by 0.5 to 10 %."""
    radiances = np.full(ROWS, 0.2)
    radiances[bright] = 2.0
    assert picture(radiances, 1 << 16) == pytest.approx(expected(radiances), rel=0.005)
