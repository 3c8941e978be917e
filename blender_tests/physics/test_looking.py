"""Nodes that look around: the same bits however the work is divided, and none of them where nothing looks."""

import dataclasses

import pytest
import tiny_scenes as tiny
from looking import POSITION, bevel, occlusion, raycast

from addon.bindings.enums import (
    Accelerator,
    Features,
    NodeKind,
    Pass,
    VectorOperation,
)
from addon.bindings.session import Session
from addon.bindings.shading import Node, NodeRef


def _room(**settings):
    """Return a scene with all three nodes on meshes and exact surfaces, as colours and normals, behind lobes of all kinds."""
    snapshot = tiny.showroom(24, samples=4, **settings)
    nodes = (
        POSITION,
        occlusion(1.5, rays=3),
        bevel(0.2, rays=3),
        raycast((0.3, 0.2, 1.0), 4.0, position=NodeRef(0)),
        Node(NodeKind.VECTOR_MATH, VectorOperation.ADD, inputs=(NodeRef(1), NodeRef(3))),
    )

    def looking(number, material):
        color = NodeRef(4 if number else 1)
        lobes = tuple(dataclasses.replace(lobe, color=color, normal=NodeRef(2)) for lobe in material.lobes)
        return dataclasses.replace(material, nodes=nodes, lobes=lobes)

    materials = tuple(
        looking(number, material) if number in (0, 1, 5) else material for number, material in enumerate(snapshot.materials)
    )
    return dataclasses.replace(snapshot, materials=materials)


def _bits(snapshot, pieces=(4,)):
    with Session.upload(snapshot) as session:
        first = 0
        for count in pieces:
            session.render(first, count)
            while not session.wait(0.1).finished:
                pass
            first += count
        return {which.name: session.read(which).tobytes() for which in Pass}


@pytest.fixture(scope="module")
def alone():
    return _bits(_room(threads=1))


@pytest.mark.parametrize("settings", [
    {"threads": 2}, {"threads": 7, "tile_size": 5}, {"threads": 2, "tile_size": 1000}, {"features": Features.ALL},
    *({"accelerator": accelerator} for accelerator in Accelerator),
], ids=str)  # fmt: skip
def test_the_same_bits_however_the_work_is_divided(alone, settings):
    assert _bits(_room(**settings)) == alone


def test_the_same_bits_for_any_pieces(alone):
    assert _bits(_room(threads=2), (1, 3)) == alone


def test_looking_costs_nothing_where_nothing_looks(alone):
    """The rays have numbers of their own: nodes that look and change nothing leave the bits."""
    plain = tiny.showroom(24, samples=4)
    floor = dataclasses.replace(plain.materials[0], nodes=(occlusion(1.5, rays=3), bevel(0.2)))
    looking = dataclasses.replace(plain, materials=(floor, *plain.materials[1:]))
    assert _bits(looking) == _bits(plain) != alone
