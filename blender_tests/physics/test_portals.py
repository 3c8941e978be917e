"""Portals: light goes on elsewhere with the portal's weight, as if it had passed a transparent surface."""

import numpy as np
import pytest
import tiny_scenes as tiny

from addon.bindings.enums import Coordinate, LightKind, NodeKind, PathFact
from addon.bindings.snapshot import Instance, Light, Material, Node, NodeRef, Portal

WEIGHT = (0.5, 0.25, 0.125)
WHITE = (1.0, 1.0, 1.0)


def glowing(radiance, name="glow"):
    return Material(name, lobes=(), emission=radiance)


def door(*portals, lobes=(), **fields):
    total = tuple(np.sum([portal.weight for portal in portals], axis=0))
    return Material("door", lobes=lobes, transmittance=total, portals=portals, **fields)


def view(material, others=(), materials=(), lights=(), **settings):
    """Return the radiance of the place at the origin of a square of the material, seen from above."""
    instances = [Instance(mesh=0, materials=(0,)), *others]
    snapshot = tiny.scene(
        instances,
        [material, *materials],
        lights,
        [tiny.quad()],
        camera=tiny.pencil(),
        **{"samples": 64, "max_bounces": 2, **settings},
    )
    return tiny.radiance(snapshot)


def far(material, z=0.0):
    """Return a square of the material over x = 50, which faces down from above z."""
    return Instance(mesh=0, materials=(material,), matrix=tiny.move(50.0, 0.0, z + 2.0) @ tiny.rotate_x(np.pi))


def test_light_goes_on_at_the_position_in_the_direction():
    leads = Portal(weight=WEIGHT, moves=1, position=(50.0, 0.0, 0.0), direction=(0.0, 0.0, 3.0))
    assert np.allclose(view(door(leads), [far(1)], [glowing((2.0, 4.0, 8.0))]), (1.0, 1.0, 1.0), rtol=1e-6)
    # Downwards there is nothing but the sky.
    down = Portal(weight=WEIGHT, moves=1, position=(50.0, 0.0, 0.0))
    assert np.allclose(view(door(down), [far(1)], [glowing((2.0, 4.0, 8.0))], world=(1.0, 2.0, 4.0)), 0.5, rtol=1e-6)


def test_without_a_position_light_turns_where_it_is():
    up = Portal(weight=WEIGHT, direction=(0.0, 0.0, 1.0))
    lid = Instance(mesh=0, materials=(1,), matrix=tiny.move(z=3.0) @ tiny.rotate_x(np.pi))
    # The camera's rays start below the lid.
    assert np.allclose(view(door(up), [lid], [glowing((2.0, 4.0, 8.0))]), 1.0, rtol=1e-6)


def test_ways_share_the_light_by_their_weights():
    """Two portals and a transparent part: each sample takes one way, and their mean is the sum."""
    one = Portal(weight=(0.4, 0.0, 0.1), moves=1, position=(50.0, 0.0, 0.0), direction=(0.0, 0.0, 1.0))
    other = Portal(weight=(0.1, 0.3, 0.1), moves=1, position=(50.0, 0.0, 10.0), direction=(0.0, 0.0, 1.0))
    material = door(one, other).replaced(transmittance=(0.6, 0.5, 0.4))
    lights = [glowing((1.0, 2.0, 3.0)), glowing((5.0, 1.0, 0.5))]
    samples = 1 << 14
    got = view(material, [far(1), far(2, 10.0)], lights, world=(0.5, 0.5, 0.5), samples=samples)
    straight = np.array((0.1, 0.2, 0.2))
    wanted = np.array(one.weight) * (1, 2, 3) + np.array(other.weight) * (5, 1, 0.5) + straight * 0.5
    # Samples of one sequence err less than independent ones, whose error is at most 5 over the root of their number.
    assert np.allclose(got, wanted, atol=3 * 5 / samples**0.5)


def test_shadow_rays_end_at_portals():
    """A floor below a portal gets no light from the lamp behind it; below a transparent surface it does."""
    lamp = Light("lamp", tiny.move(z=4.0), LightKind.POINT, emission=(10.0, 10.0, 10.0))
    roof = Instance(mesh=0, materials=(1,), matrix=tiny.move(z=2.0) @ tiny.scale(10.0))

    def lit(material):
        return view(tiny.lambert(1.0), [roof], [material], [lamp])

    clear = lit(Material(lobes=(), transmittance=WHITE))
    assert clear.min() > 0.1
    assert lit(door(Portal(weight=WHITE))).max() == 0.0
    # Cycles lets shadow rays pass portals straight beside another transparent part.
    beside = door(Portal(weight=(0.5, 0.5, 0.5), direction=(0.0, 0.0, 1.0))).replaced(transmittance=(0.75, 0.75, 0.75))
    assert np.allclose(lit(beside), 0.75 * clear, rtol=1e-6)


@pytest.mark.parametrize("strength", [1.0, 20.0])
def test_light_behind_a_portal_counts_once(strength):
    """A floor under a portal to a glowing place, which light samples may find there: the mean is that of the place alone."""
    roof = Instance(mesh=0, materials=(1,), matrix=tiny.move(z=0.5) @ tiny.scale(200.0) @ tiny.rotate_x(np.pi))
    leads = Portal(weight=WHITE, moves=1, position=(0.0, 0.0, 500.0), direction=(0.0, 0.0, 1.0))
    glow = Instance(mesh=0, materials=(2,), matrix=tiny.move(z=600.0) @ tiny.rotate_x(np.pi) @ tiny.scale(300.0))
    got = view(tiny.lambert(1.0), [roof, glow], [door(leads), glowing((strength,) * 3)], samples=256)
    # All directions but those within a quarter of a degree of the horizon meet the roof.
    assert np.allclose(got, strength, rtol=1e-3)


def test_path_counts_portals():
    """A glowing place that tells Portal Depth, Transparent Depth and Ray Depth as its colour."""
    facts = (PathFact.PORTAL_DEPTH, PathFact.TRANSPARENT_DEPTH, PathFact.DEPTH)
    nodes = [Node(NodeKind.LIGHT_PATH, option=fact) for fact in facts]
    told = Material(lobes=(), emission=NodeRef(3), nodes=(*nodes, Node(NodeKind.COMBINE, inputs=tuple(map(NodeRef, range(3))))))
    leads = Portal(weight=WHITE, moves=1, position=(50.0, 0.0, 0.0), direction=(0.0, 0.0, 1.0))
    veil = Instance(mesh=0, materials=(2,), matrix=tiny.move(50.0, 0.0, 1.0))
    assert np.allclose(view(door(leads), [far(1)], [told]), (1.0, 1.0, 0.0))
    assert np.allclose(view(door(leads), [far(1), veil], [told, Material(lobes=(), transmittance=WHITE)]), (1.0, 2.0, 0.0))


def test_rays_end_at_the_limit_of_transparent_surfaces():
    """Two portals that lead back to each other for ever."""
    here = Portal(weight=WHITE, moves=1, position=(50.0, 0.0, 2.0), direction=(0.0, 0.0, -1.0))
    back = Portal(weight=WHITE, moves=1, position=(0.0, 0.0, 2.0), direction=(0.0, 0.0, -1.0))
    there = Instance(mesh=0, materials=(1,), matrix=tiny.move(50.0))
    assert view(door(here), [there], [door(back)], world=1.0, transparent_bounces=9).max() == 0.0


def test_position_may_be_computed():
    """The place itself plus an offset, by nodes."""
    nodes = (
        Node(NodeKind.COORDINATE, option=Coordinate.POSITION),
        Node(NodeKind.VECTOR_MATH, inputs=(NodeRef(0), (50.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0)),
    )
    leads = Portal(weight=WEIGHT, moves=1, position=NodeRef(1), direction=(0.0, 0.0, 1.0))
    assert np.allclose(view(door(leads, nodes=nodes), [far(1)], [glowing((2.0, 4.0, 8.0))]), 1.0, rtol=1e-6)
