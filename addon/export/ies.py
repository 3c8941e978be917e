"""The IES Texture: photometric files (IES LM-63) as tables of intensities, in Cycles' angles."""

import math
import re

import bpy
import numpy as np

from ..bindings.enums import Coordinate, MathOperation, NodeKind, Space
from ..messages.severity import Severity
from .coordinates import NORMALS, coordinate

# Candela to the watts of a lamp, for the luminous efficacy of D65, 177.83 lm/W.
_WATTS_PER_CANDELA = 0.0706650768394
_OF_NO_FILE = 100.0  # Cycles' strength without a file that it can read
_NEAR = 1e-4  # degrees
_TYPE_C, _TYPE_B, _TYPE_A = 1, 2, 3
_IS_STRICT = bpy.app.version < (4, 0)  # reads types B and C alone, with angles that cover whole quadrants
_PADS_WITH_ZERO = (4, 0) <= bpy.app.version < (5, 0)


def _ies_texture(graph, site, output):
    strength = graph.parameter(site, ("Strength",), 1.0)
    table = _table(graph, site)
    if table is None:
        return graph.op(MathOperation.MULTIPLY, strength, _OF_NO_FILE)
    vector = graph.linked(site, ("Vector",), None, evaluated=True)
    if vector is None:
        vector = _seen_from(graph)
    return graph.emit(NodeKind.IES, vector, strength, image=graph.grid(table[:, :, None]), image_count=1)


def _seen_from(graph):
    """Return the default direction: where the light comes from, in the lamp's own space; the normal before 4.0."""
    if bpy.app.version < (4, 0):
        return coordinate(graph, Coordinate.NORMAL)
    incoming = coordinate(graph, Coordinate.INCOMING)
    return graph.emit(NodeKind.VECTOR_TRANSFORM, incoming, option=NORMALS, flags=Space.WORLD | Space.OBJECT << 2)


def _table(graph, site):
    """Return the table of a node's file or text; None, with a message, if there is none that Cycles reads."""
    text = _text(graph, site)
    if text is None:
        return None
    try:
        return ies_table(text)
    except ValueError as error:
        graph.tell(site, f"{error}, as in Cycles the strength is {_OF_NO_FILE:g} everywhere", "", Severity.WRONG)
        return None


def _text(graph, site):
    node = site.node
    if node.mode == "INTERNAL":
        if node.ies is None:
            graph.tell(site, f"has no text, as in Cycles the strength is {_OF_NO_FILE:g} everywhere", "", Severity.WRONG)
            return None
        return node.ies.as_string()
    path = bpy.path.abspath(node.filepath, library=node.id_data.library)
    try:
        with open(path, encoding="latin-1") as file:
            return file.read()
    except OSError as error:
        text = f"cannot read '{path}': {error.strerror}, as in Cycles the strength is {_OF_NO_FILE:g} everywhere"
        graph.tell(site, text, "", Severity.WRONG)
        return None


def ies_table(text):
    """Return the table of a file's text, as lancer.h describes it for IES; ValueError if Cycles does not read it."""
    kind, v, h, intensities = _parsed(text)
    convert = {_TYPE_A: _from_type_a, _TYPE_B: _from_type_b, _TYPE_C: _from_type_c}.get(kind)
    if convert is None or (_IS_STRICT and kind == _TYPE_A):
        raise ValueError(f"type {kind} of photometry is not supported by this Blender")
    v, h, intensities = convert(v, h, intensities)
    if len(v) < 2 or len(h) < 2:
        raise ValueError("the file has fewer than two angles")
    v, h = (np.float32(angles) * (np.float32(math.pi) / np.float32(180.0)) for angles in (v, h))
    if (np.diff(v) < 0.0).any() or (np.diff(h) < 0.0).any():
        raise ValueError("the angles of the file do not ascend")
    table = np.zeros((len(h) + 3, len(v) + 3), np.float32)
    table[0, 2:-1], table[2:-1, 0] = v, h
    table[2:-1, 2:-1] = intensities
    _pad(table[1:, 1:], v, h)
    return table


def _parsed(text):
    """Return the type, the vertical and the horizontal angles in degrees, and the intensities, (horizontal, vertical)."""
    start = text.find("\nTILT=")
    if start < 0:
        raise ValueError("the file has no line TILT=")
    end = text.find("\n", start + 1)
    is_included = text.startswith("\nTILT=INCLUDE", start)
    numbers = _numbers(text[start + len("\nTILT=INCLUDE") :] if is_included else text[end:] if end >= 0 else "")
    if is_included:
        next(numbers)
        for _ in range(2 * int(next(numbers))):
            next(numbers)
    _, _, factor, v_count, h_count, kind = (next(numbers) for _ in range(6))
    _, _, _, _, ballast, photometric, _ = (next(numbers) for _ in range(7))
    factor *= ballast * photometric * _WATTS_PER_CANDELA
    v_count, h_count = int(v_count), int(h_count)
    if v_count < 1 or h_count < 1:
        raise ValueError("the file has no angles")
    v, h = ([next(numbers) for _ in range(count)] for count in (v_count, h_count))
    values = np.array([next(numbers) for _ in range(v_count * h_count)])
    if not np.isfinite(values).all() or not np.isfinite(v).all() or not np.isfinite(h).all():
        raise ValueError("the file has numbers that are not finite")
    return int(kind), np.array(v), np.array(h), factor * values.reshape(h_count, v_count)


def _numbers(text):
    for word in re.split(r"[\s,]+", text.strip()):
        try:
            yield float(word)
        except ValueError:
            break
    raise ValueError("the file ends before its last number")


def _is_near(a, b):
    return abs(a - b) < _NEAR


def _from_type_a(v, h, values):
    """Vertical angles from -90 to 90 begin at the nadir; horizontal ones run the other way."""
    turned, rows = 180.0 - h[::-1], values[::-1]
    if _is_near(h[0], 0.0):
        turned, rows = np.concatenate([turned, 180.0 + h[1:]]), np.concatenate([rows, values[1:]])
    return v + 90.0, turned, rows


def _from_type_b(v, h, values):
    """The polar axis lies across: exchange the angles, and mirror those that cover one half."""
    v, h, values = h, v, values.T
    if _IS_STRICT:
        return _from_strict_type_b(v, h, values)
    h, values = _from_both_sides(h, values)
    v, columns = _from_both_sides(v, values.T)
    return v, h, columns.T


def _from_both_sides(angles, rows):
    if not _is_near(angles[0], 0.0):
        return angles + 90.0, rows
    return np.concatenate([90.0 - angles[:0:-1], 90.0 + angles]), np.concatenate([rows[:0:-1], rows])


def _from_strict_type_b(v, h, values):
    for angles in (v, h):
        if angles[-1] != 90.0 or angles[0] not in (0.0, -90.0):
            raise ValueError("this Blender reads angles from 0 or -90 to 90 degrees alone")
    h, values = _from_both_sides(h, values)
    h, values = np.append(h, 360.0), np.concatenate([values, values[:1]])
    if v[0] == -90.0:
        return v + 90.0, h, values
    # The mirrored half begins one angle late in this Blender.
    mirrored = values[:, -2::-1]
    return np.concatenate([90.0 - v[:0:-1], 90.0 + v]), h, np.concatenate([mirrored, values], axis=1)


def _from_type_c(v, h, values):
    """Mirror quadrants and halves, and close the circle."""
    if _is_near(h[0], 90.0):
        h = h - 90.0
    if _IS_STRICT and h[0] != 0.0:
        raise ValueError("this Blender reads horizontal angles from 0 degrees alone")
    if len(h) == 1:
        h, values = np.array([0.0, 360.0]), np.concatenate([values, values])
    for whole in (90.0, 180.0):
        if _is_near(h[-1], whole):
            h, values = np.append(h, 2.0 * whole - h[-2::-1]), np.concatenate([values, values[-2::-1]])
    if _is_near(h[0], 0.0) and not _is_near(h[-1], 360.0):
        gap = 360.0 - h[-1]
        if _is_near(h[-1] - h[-2], gap) or _is_near(h[1] - h[0], gap):
            h, values = np.append(h, 360.0), np.concatenate([values, values[:1]])
        elif _IS_STRICT:
            raise ValueError("this Blender reads horizontal angles of the whole circle alone")
    if _IS_STRICT:
        if v[0] == 90.0 and v[-1] == 180.0:
            v = 180.0 - v
        elif v[0] != 0.0:
            raise ValueError("this Blender reads vertical angles from 0 degrees, or from 90 to 180 alone")
    return v, h, values


def _pad(grid, v, h):
    """Set the rows and columns beyond the ends, between which and the next two the cubic is fitted."""
    # In single precision the difference to a whole turn is lost: as in Cycles, angles that reach it exactly do not go around.
    tiny = np.float32(1e-7)
    wraps_v_low, wraps_v_high = v[0] < tiny, v[-1] > np.float32(math.pi) - tiny
    wraps_h = h[0] < tiny and h[-1] > np.float32(2.0 * math.pi) - tiny
    inside = grid[1:-1]
    nothing = 0.0 if _PADS_WITH_ZERO else None
    if _IS_STRICT:
        inside[:, 0], inside[:, -1] = inside[:, 2], inside[:, -2]
        wraps_h = True
    else:
        inside[:, 0] = inside[:, 2] if wraps_v_low else inside[:, 1] if nothing is None else nothing
        inside[:, -1] = inside[:, -3] if wraps_v_high else inside[:, -2] if nothing is None else nothing
    if wraps_h:
        grid[0], grid[-1] = grid[-3], grid[2]
    elif nothing is None:
        # Beyond the last angle Cycles repeats the last but one.
        grid[0], grid[-1] = grid[1], grid[-3]


READERS = {"TEX_IES": _ies_texture}
