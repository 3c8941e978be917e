"""Outputs of materials and of the world: AOVs of the surfaces that the camera sees."""

import dataclasses

import numpy as np
import pytest
from tiny_scenes import lambert, move, plane, quad, rgb, scene, veiled

from addon.bindings.abi import CameraKind, Coordinate, Integrator, LobeKind, NodeKind, Pass, PassKind
from addon.bindings.numbered_pass import NumberedPass
from addon.bindings.session import Session
from addon.bindings.snapshot import Instance, Lobe, Material, Node, NodeRef, Output, World

COLOR, VALUE = NumberedPass(PassKind.AOV_COLOR), NumberedPass(PassKind.AOV_VALUE)


def read(snapshot, *passes):
    with Session.upload(snapshot) as session:
        assert session.render_all()
        return [session.read(which)[0, 0].tolist() for which in passes]


def with_outputs(material, color, value=0.0, **fields):
    outputs = Output(value=color), Output(is_color=False, value=value)
    return dataclasses.replace(material, outputs=outputs, **fields)


def shown(*materials, **settings):
    """Return squares above each other, the first one on top, seen from above."""
    squares = [Instance(mesh=0, matrix=move(z=-n), materials=(n,)) for n in range(len(materials))]
    given = {"samples": 8, "aov_colors": 1, "aov_values": 1, **settings}
    return scene(squares, materials, meshes=[quad()], **given)


@pytest.mark.parametrize("integrator", Integrator)
def test_a_solid_surface_gives_its_values(integrator):
    surface = with_outputs(lambert(), (0.25, -3.0, 1e5), -0.5)
    assert read(shown(surface, integrator=integrator), COLOR, VALUE) == [[0.25, -3.0, 1e5, 1.0], [-0.5]]


def test_nodes_give_values_at_the_place():
    nodes = (Node(NodeKind.COORDINATE, option=Coordinate.POSITION),)
    surface = with_outputs(lambert(), NodeRef(0), NodeRef(0), nodes=nodes)
    (color, value) = read(shown(surface), COLOR, VALUE)
    # The camera looks at the origin through a pencil 1e-6 wide.
    assert color == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=1e-6) and value == pytest.approx([0.0], abs=1e-6)


def test_surfaces_add_up_to_the_first_that_is_opaque_enough():
    """As in Cycles, values have no weight: a veil below the threshold and the ground both give theirs."""
    veil, ground = with_outputs(veiled(lambert(), 0.25), (1.0, 0.0, 0.0), 2.0), with_outputs(lambert(), (0.0, 1.0, 0.0), 4.0)
    color, value = read(shown(veil, ground, samples=4096), COLOR, VALUE)
    assert color[0] == 1.0
    # Paths reach the ground with the probability of passing, at least the transmittance.
    assert (
        0.7 < color[1] <= 1.0 and color[3] == pytest.approx(1.0 + color[1]) and value == pytest.approx([2.0 + 4.0 * color[1]])
    )
    # Above the threshold, the veil ends the search.
    color, value = read(shown(veil, ground, alpha_threshold=0.2), COLOR, VALUE)
    assert color == [1.0, 0.0, 0.0, 1.0] and value == [2.0]


@pytest.mark.parametrize("even", [False, True])
@pytest.mark.parametrize("albedo", [0.0, 0.04, 0.8])
def test_ways_on_have_a_least_share_of_the_choices(even, albedo):
    """The ground's value is the share of paths that pass a veil: by weight, or at least an eighth of all weights for each way.

    A share of 16384 samples has a standard error of at most 0.004; those of one sequence err less.
    """
    veil, ground = veiled(lambert(albedo), 0.3), with_outputs(lambert(), (0.0, 0.0, 0.0), 1.0)
    ways = [0.7, 0.3 * albedo]
    if even:
        ways = [max(way, sum(ways) / 8.0) if way else 0.0 for way in ways]
    settings = {"samples": 1 << 14, "even_choices": even}
    assert read(shown(veil, ground, **settings), VALUE)[0] == pytest.approx([ways[0] / sum(ways)], abs=0.016)
    # Behind a second veil the choices are by weight.
    clear = Material("clear", lobes=(), transmittance=rgb(1.0))
    second = read(shown(clear, veil, ground, **settings), VALUE)[0]
    assert second == pytest.approx([0.7 / (0.7 + 0.3 * albedo)], abs=0.016)
    # The choices change no light: a path's is below 2, and 4096 of them have a standard error below 0.016.
    picture, plain = (
        read(shown(veil, ground, samples=1 << 12, even_choices=on, world=1.0), Pass.COMBINED)[0][:3] for on in (even, False)
    )
    assert picture == pytest.approx(plain, abs=0.07)


def test_values_that_are_no_numbers_count_as_nothing():
    broken = with_outputs(lambert(), (float("nan"), float("inf"), 1.0), float("nan"))
    color, value = read(shown(broken), COLOR, VALUE)
    assert color[0] == 0.0 and np.isfinite(color).all() and value == [0.0]


def test_passes_that_the_settings_do_not_count_are_left_out():
    material = dataclasses.replace(lambert(), outputs=(Output(number=5, value=(1.0, 1.0, 1.0)),))
    assert read(shown(material), COLOR) == [[0.0, 0.0, 0.0, 0.0]]


def test_the_world_gives_its_values():
    """As in Cycles, one that a transparent film hides gives none."""
    nodes = (Node(NodeKind.COORDINATE, option=Coordinate.POSITION), Node(NodeKind.SEPARATE, option=2, inputs=(NodeRef(0),)))
    outputs = Output(value=(0.5, 0.25, 2.0)), Output(is_color=False, value=NodeRef(1))
    # The pencil looks down.
    given = [[0.5, 0.25, 2.0, 1.0], [-1.0]]

    def seen(radiance, outputs, **settings):
        sky = World(radiance=radiance, nodes=nodes, outputs=outputs)
        # From 8 samples on, a picture is searched for pixels that show an even sky alone.
        fields = {"samples": 8, "aov_colors": 1, "aov_values": 1, **settings}
        return read(dataclasses.replace(scene([plane(0, move(z=5))], [lambert()], **fields), world=sky), COLOR, VALUE)

    for radiance in (NodeRef(0), (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)):
        assert seen(radiance, outputs) == given
        assert seen(radiance, outputs[:1]) == [given[0], [0.0]]
        assert seen(radiance, outputs, film_transparent=True) == [[0.0] * 4, [0.0]]
        assert seen(radiance, outputs, film_transparent=True, passes=(Pass.ENVIRONMENT,)) == given


def test_an_even_sky_gives_each_direction_its_value():
    """No pixel shows a surface; the sides of the picture look apart."""
    nodes = (Node(NodeKind.COORDINATE, option=Coordinate.POSITION),)
    sky = World(radiance=(0.5, 0.5, 0.5), nodes=nodes, outputs=(Output(value=NodeRef(0)),))
    behind = Instance(mesh=0, matrix=move(z=5.0), materials=(0,))
    snapshot = scene([behind], [lambert()], meshes=[quad()], samples=8, aov_colors=1)
    fields = {"kind": CameraKind.PERSPECTIVE, "width": 4, "region_width": 4, "window": (-1.0, 1.0, -0.25, 0.25)}
    camera = dataclasses.replace(snapshot.camera, **fields)
    with Session.upload(dataclasses.replace(snapshot, world=sky, camera=camera)) as session:
        assert session.render_all()
        x = session.read(COLOR)[0, :, 0]
    # The mean over a pixel lies between the directions of its sides, in front of a plane at the distance 1; above and below its
    # middle a direction is by up to 1 - 1 / sqrt(1 + 1 / 16) shorter.
    sides = np.linspace(-1.0, 1.0, 5)
    sides /= np.sqrt(1.0 + sides**2)
    assert (sides[:-1] - 0.03 <= x).all() and (x <= sides[1:] + 0.03).all()


def test_only_the_camera_sees_outputs():
    """A mirror's image of a surface gives nothing."""
    mirror = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=rgb(1.0)),))
    ceiling = Instance(mesh=0, matrix=move(z=3.0), materials=(1,))
    surface = with_outputs(lambert(), (1.0, 1.0, 1.0), 1.0)
    seen = scene([plane(0), ceiling], [mirror, surface], meshes=[quad()], samples=4, max_bounces=4, aov_colors=1, aov_values=1)
    assert read(seen, COLOR, VALUE) == [[0.0] * 4, [0.0]]
