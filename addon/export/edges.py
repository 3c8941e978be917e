"""Edge attributes at vertices: the mean of the edges at a vertex, as in the running Blender's Cycles."""

import bpy
import numpy as np

from .arrays import built_in, read
from .colorspace import srgb_to_linear

# Since 4.1 Cycles mixes values with the rules of Blender's geometry for their type; before, as plain numbers.
_MIXES_BY_TYPE = bpy.app.version >= (4, 1)
_LEAST_SINE = 0.0005  # of half the angle; Blender does not normalise the axis below it
_TURN = 2.0 * np.pi


def at_vertices(mesh, attribute, values):
    """Return the values of an edge attribute at the vertices, (vertices, channels). values: of each edge."""
    ends, count = edge_ends(mesh), len(mesh.vertices)
    mix = _MIXES.get(attribute.data_type) if _MIXES_BY_TYPE else None
    if mix is not None:
        return mix(attribute, values, ends, count)
    return _mean(values, ends, count).astype(np.float32)


def edge_ends(mesh):
    """Return the vertices of each edge, (edges, 2)."""
    data = built_in(mesh, ".edge_verts", "EDGE")
    if data is not None:
        return read(data, "value", np.int32, 2)
    return read(mesh.edges, "vertices", np.int32, 2)


def _mean(values, ends, count):
    """Return the mean at each vertex in double precision; 0 at vertices without edges, which belong to no face."""
    edges = np.maximum(np.bincount(ends.ravel(), minlength=count), 1)
    sums = [np.bincount(ends.ravel(), np.repeat(channel, 2), count) for channel in values.T.astype(float)]
    return np.stack(sums, axis=1) / edges[:, None]


def _any(attribute, values, ends, count):
    return (_mean(values, ends, count) > 0.0).astype(np.float32)


def _rounded(attribute, values, ends, count):
    """Return means rounded to integers, halves away from 0."""
    mean = _mean(values, ends, count)
    return (np.sign(mean) * np.floor(np.abs(mean) + 0.5)).astype(np.float32)


def _bytes(attribute, values, ends, count):
    """Return the mean of the stored bytes without its fraction, decoded."""
    stored = np.empty(len(attribute.data) * 4, np.float32)
    attribute.data.foreach_get("color_srgb", stored)
    # Sums of bytes are exact in double precision, and so is an integral mean.
    mean = np.floor(_mean(np.rint(255.0 * stored.reshape(-1, 4)), ends, count)) / 255.0
    return np.concatenate([srgb_to_linear(mean[:, :3]), mean[:, 3:]], axis=1).astype(np.float32)


def _rotations(attribute, values, ends, count):
    """Return the mean of rotation vectors: the axis, scaled by the angle."""
    w, axis = values[:, :1].astype(float), values[:, 1:].astype(float)
    half = np.arccos(np.clip(w, -1.0, 1.0))
    sine = np.sin(half)
    turns = _mean(2.0 * half * axis / np.where(np.abs(sine) < _LEAST_SINE, 1.0, sine), ends, count)
    angle = np.sqrt((turns**2).sum(axis=1, keepdims=True))
    axis = turns / np.where(angle > 0.0, angle, 1.0)
    half = 0.5 * np.remainder(angle, _TURN)
    return np.concatenate([np.cos(half), np.sin(half) * axis], axis=1).astype(np.float32)


_MIXES = {"BOOLEAN": _any, "INT": _rounded, "INT8": _rounded, "BYTE_COLOR": _bytes, "QUATERNION": _rotations}
