"""Emission below a coat: dimmed where paths go on, and neither for light samples nor at the end of a path, as in Cycles."""

import numpy as np
import pytest
import tiny_scenes
from tiny_scenes import move, rotate_x

from addon.bindings.enums import LobeKind, Rules
from addon.bindings.snapshot import Instance, Lobe, Material, Principled

EMISSION = (2.0, 1.5, 1.0)


def lamp(coat, tint=(1.0, 1.0, 1.0)):
    """Return a black Principled material that shines below a coat."""
    principled = Principled(
        rules=Rules.BLENDER_50, base_color=(0.0, 0.0, 0.0), emission=EMISSION, coat=coat, coat_tint=tint, coat_ior=1.5
    )
    return Material("lamp", lobes=(Lobe(LobeKind.PRINCIPLED, principled=principled, ior=1.0),))


def below(material, bounces):
    """Return the light of a floor below a square lamp."""
    above = Instance(mesh=0, materials=(1,), matrix=move(z=1.0) @ rotate_x(np.pi))
    camera = tiny_scenes.pencil((0.0, -0.5, 0.4), (0.0, 0.0, 0.0), pixels=8)
    return tiny_scenes.radiance(
        tiny_scenes.scene(
            [tiny_scenes.plane(), above],
            [tiny_scenes.lambert(0.7), material],
            meshes=[tiny_scenes.quad()],
            camera=camera,
            samples=64,
            max_bounces=bounces,
        )
    )


def seen(material, bounces):
    """Return the light of the lamp itself."""
    floor = Instance(mesh=0, materials=(0,))
    scene = tiny_scenes.scene([floor], [material], meshes=[tiny_scenes.quad()], samples=16, max_bounces=bounces)
    return tiny_scenes.radiance(scene)


def test_a_camera_sees_it_dimmed():
    """A coat of index 1.5 reflects 4 % along its normal; its albedo table and its roughness add less than 1 %."""
    assert seen(lamp(1.0), 1) == pytest.approx(0.96 * np.array(EMISSION), rel=0.01)
    assert seen(lamp(0.0), 1) == pytest.approx(EMISSION, rel=1e-6)


def test_a_path_ends_with_all_of_it():
    """Light samples and rays that end at the lamp see the same light, whatever the coat: equal numbers, equal samples.

    Both sum some hundreds of products in single precision, each rounded by 6e-8.
    """
    assert below(lamp(1.0), 0) == pytest.approx(below(lamp(0.0), 0), rel=1e-5)


def test_a_path_that_goes_on_sees_it_dimmed():
    """With more bounces a part of the rays from the floor goes on from the lamp; all light samples see it whole."""
    whole, dimmed = below(lamp(0.0), 4), below(lamp(1.0), 4)
    assert (dimmed < whole * (1.0 - 1e-3)).all() and (dimmed > 0.95 * whole).all()


def test_the_tint_of_a_coat_stays():
    """Along the normal light crosses the coat once, by its thickness."""
    tint = np.array((0.9, 0.5, 0.2))
    ratio = seen(lamp(1.0, tuple(tint)), 1) / seen(lamp(1.0), 1)
    assert ratio == pytest.approx(tint, rel=1e-4)
    assert (below(lamp(1.0, tuple(tint)), 0) < below(lamp(1.0), 0) * (tint + 0.05)).all()
