"""Light groups: the light of some lamps, emitters and the sky by itself."""

import dataclasses

import numpy as np
import pytest
from tiny_scenes import lambert, move, plane, quad, rotate_x, scene, showroom

from addon.bindings.abi import Integrator, Pass, PassKind
from addon.bindings.numbered_pass import NumberedPass
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, Light, Material

GROUPS = 4


def groups_of(snapshot, groups=GROUPS):
    """Return Combined without alpha and the pass of each group, in double."""
    with Session.upload(snapshot) as session:
        assert session.render_all()
        found = [session.read(NumberedPass(PassKind.LIGHT_GROUP, number)) for number in range(groups)]
        return session.read()[..., :3].astype(np.float64), [one.astype(np.float64) for one in found]


@pytest.mark.parametrize("clamp", [0.0, 0.05])
@pytest.mark.parametrize("paths", [1, 4])
def test_groups_sum_to_the_picture(clamp, paths):
    """Each contribution goes to the sample and to one group.

    Sums of a sample have at most some hundred terms in float, in another order for each group: the relative difference stays
    below 100 half units in the last place of positive terms.
    """
    picture, groups = groups_of(
        showroom(24, samples=8, passes=(Pass.COMBINED,), clamp_indirect=clamp, split_paths=paths, split_lights=2)
    )
    assert all(group.max() > 0.0 for group in groups)
    assert np.abs(sum(groups) - picture).max() <= 100 * 2.0**-24 * picture.max()


def test_one_group_of_all_light_is_the_picture():
    shown = showroom(24, samples=8, passes=(Pass.COMBINED,), light_groups=1)
    table = dataclasses.replace(shown.instances, light_groups=np.ones(len(shown.instances), np.uint32))
    lights = tuple(dataclasses.replace(light, light_group=1) for light in shown.lights)
    world = dataclasses.replace(shown.world, light_group=1)
    picture, (group,) = groups_of(dataclasses.replace(shown, instances=table, lights=lights, world=world), 1)
    assert np.abs(group - picture).max() <= 100 * 2.0**-24 * picture.max()


def test_a_group_is_the_picture_of_its_lights_alone():
    """Two lamps light a floor; without bounces a pixel is the sum of their light. A group has exactly that of its lamp.

    Lamps are points, so a light sample has no noise; which of the two is chosen has.
    """

    def shown(*lamps, samples=4096):
        lights = [Light("lamp", move(x, 0, 1), emission=(power,) * 3, light_group=group) for x, power, group in lamps]
        return scene([plane(0)], [lambert(0.5)], lights, samples=samples, light_groups=2)

    both = (0.3, 2.0, 1), (-0.4, 5.0, 2)
    _, (first, second) = groups_of(shown(*both), 2)
    for got, lamp in ((first, both[0]), (second, both[1])):
        alone, _ = groups_of(shown(lamp, samples=4), 2)
        # Each sample has the lamp's light over its probability p, or none: relative variance (1 - p) / p below 9 for p above a
        # tenth; five standard errors of independent samples, and stratified ones have less.
        assert got.mean() == pytest.approx(alone.mean(), rel=5.0 * 3.0 / 64.0)


def test_lights_without_a_group_are_in_none():
    lights = [Light("in", move(0, 0, 1), light_group=1), Light("out", move(1, 0, 1))]
    picture, (group,) = groups_of(scene([plane(0)], [lambert(0.5)], lights, samples=64, light_groups=1), 1)
    assert 0.0 < group.mean() < 0.9 * picture.mean()


def test_emitters_belong_by_their_object():
    """A glowing ceiling in a group, seen by scattered rays and by light samples."""
    ceiling = Instance(mesh=0, matrix=move(z=2.0) @ rotate_x(np.pi), materials=(1,), light_group=1)
    glow = Material("glow", lobes=(), emission=(3.0, 2.0, 1.0))
    picture, (group,) = groups_of(
        scene([plane(0), ceiling], [lambert(0.5), glow], meshes=[quad(3.0)], samples=64, light_groups=1), 1
    )
    assert picture.max() > 0.0 and np.abs(group - picture).max() <= 2.0**-20 * picture.max()


def test_classic_leaves_groups_empty():
    _, groups = groups_of(showroom(12, samples=2, integrator=Integrator.CLASSIC, max_bounces=3))
    assert not any(group.any() for group in groups)


def test_many_groups():
    """A thousand groups of a lamp each; the most that settings take is 1024."""
    lights = [Light(f"lamp {n}", move(n / 500.0 - 1.0, 0, 1), light_group=n + 1) for n in range(1000)]
    picture, groups = groups_of(scene([plane(0)], [lambert(0.5)], lights, samples=256, light_groups=1000), 1000)
    assert np.abs(sum(groups) - picture).max() <= 2.0**-20 * picture.max()
    with pytest.raises(Exception, match="light_groups 2000"):
        Session.upload(scene([plane(0)], [lambert()], light_groups=2000))
