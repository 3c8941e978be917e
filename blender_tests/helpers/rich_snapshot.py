"""A snapshot with a record of every kind."""

import dataclasses

import numpy as np
from tiny_scenes import quad, showroom

from addon.bindings.enums import Domain, LobeKind, NodeKind
from addon.bindings.snapshot import (
    Image,
    Lobe,
    Material,
    MeshAttribute,
    MeshData,
    Node,
    NodeRef,
    ObjectAttribute,
    Principled,
    World,
)


def rich():
    """Return the showroom with a record of every kind, and a mesh with all possible arrays."""
    plain = quad(1.0, "rich")
    corner = np.arange(6, dtype=np.float32).reshape(2, 3, 1)
    mesh = MeshData(
        "rich",
        plain.positions,
        plain.triangles,
        normals=np.tile(np.float32([0, 0, 1]), (4, 1)),
        uvs=corner * np.float32([0.1, 0.2]),
        colors=corner * np.float32([0.1, 0.2, 0.3]),
        material_slots=[0, 1],
        attributes=(
            MeshAttribute("second map", np.arange(12).reshape(6, 2) / 8.0),
            MeshAttribute("weight", np.arange(4).reshape(4, 1) / 8.0, Domain.VERTEX),
        ),
    )
    pictures = (
        Image("bytes", np.arange(24).reshape(2, 3, 4).astype(np.uint8)),
        Image("shorts", np.arange(6).reshape(2, 3, 1).astype(np.uint16), tile=1001),
        Image("floats", np.arange(6).reshape(1, 2, 3).astype(np.float32) / 8.0),
    )
    seen = Node(NodeKind.IMAGE, inputs=(NodeRef(0),), image=2, image_count=1)
    paint = Material(
        "paint",
        lobes=(Lobe(LobeKind.PRINCIPLED, principled=Principled(base_color=NodeRef(1))),),
        emission=NodeRef(1),
        nodes=(Node(), seen),
    )
    room = showroom(16)
    heat = ObjectAttribute("heat", np.arange(4 * len(room.instances)).reshape(-1, 4) / 8.0)
    return dataclasses.replace(
        room,
        instances=dataclasses.replace(room.instances, attributes=(heat,)),
        meshes=(*room.meshes, mesh),
        images=pictures,
        materials=(*room.materials, paint),
        world=World(radiance=NodeRef(1), nodes=(Node(), dataclasses.replace(seen, kind=NodeKind.ENVIRONMENT))),
    )
