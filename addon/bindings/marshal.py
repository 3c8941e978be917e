"""Conversion of the records of snapshot.py to the structs of lancer.h.

A struct holds addresses of the record's arrays, so the record must outlive the call; the library copies the arrays. It does not
copy Blocks, which must outlive the scene.
"""

import ctypes
import functools

import numpy as np

from . import abi
from .blocks import Blocks
from .shading import NodeRef

INSTANCE = np.dtype(abi.Instance)


def _address(array):
    # Faster than array.ctypes, which makes an object for each call.
    return None if array is None else array.__array_interface__["data"][0]


def _row_major(matrix):
    return (ctypes.c_double * 12)(*matrix.ravel().tolist())


def _text(text):
    """Return text as UTF-8 without null characters; lone surrogates become question marks."""
    return text.replace("\0", " ").encode("utf-8", "replace")


def _parameter(value):
    """Return the abi.Parameter of a number, three numbers or a NodeRef."""
    if isinstance(value, NodeRef):
        return abi.Parameter((), value.node)
    return abi.Parameter(tuple(value) if isinstance(value, (tuple, list)) else (value,), -1)


def _same(value):
    return value


# Conversion of a record's value to a member of each type; the caller of _struct passes members of other types.
_MEMBERS = {
    ctypes.c_char_p: _text,
    abi.Array: _address,
    abi.Parameter: _parameter,
    ctypes.c_double * 12: _row_major,
    ctypes.c_uint32: int,
    ctypes.c_uint64: int,
    ctypes.c_float: _same,
    ctypes.c_double: _same,
    **{ctypes.c_float * n: _same for n in (2, 3, 9, 12)},
    **{ctypes.c_double * n: _same for n in (4, 8)},
}


@functools.cache
def _members(kind):
    return tuple((name, _MEMBERS.get(member)) for name, member in kind._fields_ if not name.startswith("reserved"))


def _struct(kind, record, /, **given):
    """Return the record as a struct of type kind; members that are not given come from the record's field of that name."""
    return kind(**{name: given[name] if name in given else made(getattr(record, name)) for name, made in _members(kind)})


def _many(kind, structs):
    """Return a C array of structs, or None if there are none."""
    structs = list(structs)
    return (kind * len(structs))(*structs) if structs else None


def mesh(m):
    domain = abi.NormalDomain.NONE
    if m.normals is not None:
        domain = abi.NormalDomain.VERTEX if m.normals.ndim == 2 else abi.NormalDomain.CORNER
    return _struct(
        abi.Mesh,
        m,
        attributes=_many(abi.Attribute, (_struct(abi.Attribute, a, channels=a.values.shape[1]) for a in m.attributes)),
        vertex_count=len(m.positions),
        triangle_count=len(m.triangles),
        normal_domain=domain,
        attribute_count=len(m.attributes),
        key_count=0 if m.moved_positions is None else len(m.moved_positions),
    )


def instances(table):
    """Return the arguments of lancer_scene_add_instances after the scene."""
    encoded = [_text(name) + b"\0" for name in table.names]
    offsets = np.cumsum([0] + [len(name) for name in encoded]).astype(np.uint32)
    names = b"".join(encoded)
    rows = np.zeros(len(table), INSTANCE)
    rows["matrix"] = table.matrices.reshape(-1, 12)
    rows["kind"] = table.kinds
    rows["mesh"] = table.meshes
    rows["first_slot"] = table.first_slots
    rows["slot_count"] = table.slot_counts
    rows["object_index"] = table.object_indices
    for name, column in (("object_matte", table.object_mattes), ("asset_matte", table.asset_mattes)):
        rows[name] = 0 if column is None else column
    rows["light_group"] = 0 if table.light_groups is None else table.light_groups
    rows["shading"] = table.shadings
    rows["name"] = offsets[table.name_indices]
    rows["hidden_from"] = table.hidden_from
    rows["terminator"] = table.terminators
    rows["flags"] = table.flags
    if table.fast_distances is not None:
        rows["fast_distance"] = table.fast_distances
    if table.links is not None:
        for name, values in zip(("receiver_set", "blocker_set", "unlit_sets", "clear_sets"), table.links.T, strict=True):
            rows[name] = values
    # The pointer from data_as keeps the array alive; a plain address would not.
    pointer = rows.ctypes.data_as(ctypes.c_void_p)
    return len(rows), pointer, len(table.slots), _address(table.slots), names, len(names)


def instance_motion(motion):
    """Return the arguments of lancer_scene_move_instances after the scene."""
    return len(motion.instances), _address(motion.instances), motion.matrices.shape[1], _address(motion.matrices)


def instance_vectors(vectors):
    """Return the arguments of lancer_scene_set_vectors after the scene."""
    return len(vectors.instances), _address(vectors.instances), _address(vectors.matrices)


def motion(m):
    """Return the abi.Motion of a Motion; None is a scene that is shown as it stands."""
    if m is None:
        return abi.Motion()
    keys = _many(abi.Camera, (camera(key) for key in m.keys))
    return _struct(
        abi.Motion,
        m,
        shutter_count=0 if m.shutter is None else len(m.shutter),
        key_count=len(m.keys),
        keys=keys,
    )


def object_attribute(attribute):
    """Return the arguments of lancer_scene_add_object_attribute after the scene."""
    return _text(attribute.name), len(attribute.values), _address(attribute.values)


_MOST_GAPS = 2**32 - 1
_TEXELS = {
    np.dtype(np.uint8): abi.TexelKind.U8,
    np.dtype(np.uint16): abi.TexelKind.U16,
    np.dtype(np.float32): abi.TexelKind.FLOAT,
}


def image(i):
    height, width, channels = i.texels.shape
    if isinstance(i.texels, Blocks):
        given = {"texels": _address(i.texels.array), "layout": abi.Layout.BLOCKS, "gaps": min(i.texels.gaps, _MOST_GAPS)}
    else:
        given = {"texels": _address(i.texels), "layout": abi.Layout.ROWS, "gaps": 0}
    return _struct(abi.Image, i, width=width, height=height, channels=channels, kind=_TEXELS[i.texels.dtype], **given)


def node(n):
    # Inputs that the node does not have are the constant 0.
    inputs = (abi.Parameter * 5)(*map(_parameter, n.inputs + (0.0,) * (5 - len(n.inputs))))
    return _struct(abi.Node, n, inputs=inputs)


def _nodes(owner):
    return {"nodes": _many(abi.Node, map(node, owner.nodes)), "node_count": len(owner.nodes)}


def _outputs(owner):
    rows = (_struct(abi.Output, output) for output in owner.outputs)
    return {"outputs": _many(abi.Output, rows), "output_count": len(owner.outputs)}


def _lobe(lobe):
    principled = None if lobe.principled is None else ctypes.pointer(_struct(abi.Principled, lobe.principled))
    return _struct(abi.Lobe, lobe, principled=principled)


def material(m):
    return _struct(
        abi.Material,
        m,
        lobes=_many(abi.Lobe, map(_lobe, m.lobes)),
        lobe_count=len(m.lobes),
        portals=_many(abi.Portal, (_struct(abi.Portal, portal) for portal in m.portals)),
        portal_count=len(m.portals),
        **_outputs(m),
        **_nodes(m),
    )


def world(w):
    ambient = (0.0, 0.0, 0.0) if w.ambient is None else w.ambient
    return _struct(abi.World, w, ambient=ambient, use_ambient=w.ambient is not None, **_outputs(w), **_nodes(w))


def light(li):
    return _struct(abi.Light, li, **_nodes(li))


def camera(c):
    return _struct(abi.Camera, c)


def settings(s):
    return _struct(abi.Settings, s, passes=sum(1 << p for p in set(s.passes)))
