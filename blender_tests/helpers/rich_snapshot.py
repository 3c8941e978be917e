"""A snapshot with a record of every kind, and copies of it that differ in one number."""

import dataclasses

import numpy as np
from tiny_scenes import quad, showroom

from addon.bindings.enums import Domain, LobeKind, NodeKind, PassKind
from addon.bindings.snapshot import (
    Image,
    InstanceMotion,
    Lobe,
    Material,
    MeshAttribute,
    MeshData,
    Motion,
    NamedPass,
    Node,
    NodeRef,
    ObjectAttribute,
    Portal,
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
        moved_positions=np.stack([scale * np.asarray(plain.positions) for scale in (1.0, 2.0, 3.0)]),
        moved_normals=np.tile(np.float32([0, 0, 1]), (3, 4, 1)),
        vector_positions=np.stack([scale * np.asarray(plain.positions) for scale in (0.5, 1.5)]),
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
        portals=(Portal(weight=(0.125, 0.25, 0.5), moves=1, position=NodeRef(1)),),
        transmittance=(0.125, 0.25, 0.5),
        emission=NodeRef(1),
        nodes=(Node(), seen),
    )
    room = showroom(16)
    moved = np.tile(np.eye(4)[:3], (2, 3, 1, 1))
    heat = ObjectAttribute("heat", np.arange(4 * len(room.instances)).reshape(-1, 4) / 8.0)
    return dataclasses.replace(
        room,
        instances=dataclasses.replace(room.instances, attributes=(heat,), motions=(InstanceMotion([0, 1], moved),)),
        motion=Motion(np.ones(3), (room.camera,) * 3, rolling=True),
        meshes=(*room.meshes, mesh),
        images=pictures,
        materials=(*room.materials, paint),
        world=World(radiance=NodeRef(1), nodes=(Node(), dataclasses.replace(seen, kind=NodeKind.ENVIRONMENT))),
        named_passes=(NamedPass("Combined_key", "RGB", PassKind.LIGHT_GROUP),),
    )


def leaves(item, path=()):
    """Yield the path of every number, string and array in a record."""
    if dataclasses.is_dataclass(item):
        for field in dataclasses.fields(item):
            yield from leaves(getattr(item, field.name), (*path, field.name))
    elif isinstance(item, tuple):
        for number, part in enumerate(item):
            yield from leaves(part, (*path, number))
    elif item is not None:
        yield path


def changed(item, path):
    """Return a copy in which the leaf at the path differs in one number."""
    if path:
        key, rest = path[0], path[1:]
        if isinstance(item, tuple):
            return (*item[:key], changed(item[key], rest), *item[key + 1 :])
        return dataclasses.replace(item, **{key: changed(getattr(item, key), rest)})
    if isinstance(item, np.ndarray):
        copy = item.copy()
        flat = copy.reshape(-1)
        # Keep indices valid: name 7 of 8 becomes name 6.
        flat[-1] = np.nextafter(flat[-1], flat.dtype.type(np.inf)) if copy.dtype.kind == "f" else flat[-1] ^ 1
        return copy
    if isinstance(item, str):
        return item + "x"
    if isinstance(item, bool):
        return not item
    return item + 1 if isinstance(item, int) else float(np.nextafter(item, np.inf))
