"""The IES Texture: photometric files (IES LM-63) as tables of intensities, in Cycles' angles."""

import functools
import math
import re

import bpy
import numpy as np

from ..bindings.enums import Coordinate, MathOperation, NodeKind, Space
from ..host.by_scene import identity
from ..messages.severity import Severity
from .coordinates import NORMALS, coordinate, spaces
from .shader_cache import file_state

# Candela to the watts of a lamp, for the luminous efficacy of D65, 177.83 lm/W.
_WATTS_PER_CANDELA = 0.0706650768394
_OF_NO_FILE = 100.0  # Cycles' strength without a file that it can read
_NEAR = 1e-4  # degrees
_TYPE_C, _TYPE_B, _TYPE_A = 1, 2, 3
_IS_STRICT = bpy.app.version < (4, 0)  # reads types B and C alone, with angles that cover whole quadrants
_TYPES = (_TYPE_C, _TYPE_B) if _IS_STRICT else (_TYPE_C, _TYPE_B, _TYPE_A)
_PADS_WITH_ZERO = (4, 0) <= bpy.app.version < (5, 0)
# Before 3.6 Cycles takes the end of a file after a number as its lack.
_READS_ON = bpy.app.version < (3, 6)
_TILT_INCLUDED = "\nTILT=INCLUDE"
_ENDS_EARLY = "the file ends before its last number"
_WHOLE = re.compile(r"[ \t\n\v\f\r]*([+-]?[0-9]+)")
_NUMBER = re.compile(
    r"[ \t\n\v\f\r]*([+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[+-]?[0-9]+)?|inf(?:inity)?|nan))", re.IGNORECASE | re.ASCII
)


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
    return graph.emit(NodeKind.VECTOR_TRANSFORM, incoming, option=NORMALS, flags=spaces(Space.WORLD, Space.OBJECT))


def _table(graph, site):
    """Return the table of a node's file or text; None, with a message, if there is none that Cycles reads."""
    text = _text(graph, site)
    if text is None:
        return None
    try:
        return ies_table(text)
    except Unsupported as error:
        _tell_strength(graph, site, f"{error}, which is not supported,", "feature:photometric file")
    except ValueError as error:
        _tell_strength(graph, site, f"{error}, as in Cycles")
    return None


def _tell_strength(graph, site, reason, key=""):
    graph.tell(site, f"{reason} the strength is {_OF_NO_FILE:g} everywhere", key, Severity.WRONG)


def _text(graph, site):
    node = site.node
    if node.mode == "INTERNAL":
        if node.ies is None:
            _tell_strength(graph, site, "has no text, as in Cycles")
            return None
        text = node.ies.as_string()
        graph.texts.add((identity(node.ies), text))
        # Cycles ends each line of a text.
        return text + "\n"
    path = bpy.path.abspath(node.filepath, library=node.id_data.library)
    graph.files.add(file_state(path))
    try:
        with open(path, encoding="latin-1", newline="") as file:
            return file.read()
    except OSError as error:
        _tell_strength(graph, site, f"cannot read '{path}': {error.strerror}, as in Cycles")
        return None


class Unsupported(ValueError):
    """A file that Cycles reads and Lancer does not."""


@functools.lru_cache(maxsize=32)
def ies_table(text):
    """Return the table of a file's text, as lancer.h describes it for IES; ValueError if Cycles does not read it."""
    kind, v, h, intensities = _parsed(text)
    convert = {_TYPE_A: _from_type_a, _TYPE_B: _from_type_b, _TYPE_C: _from_type_c}[kind]
    v, h, intensities = convert(v, h, intensities)
    if len(v) < 2 or len(h) < 2:
        raise Unsupported("the file has a single angle")
    with np.errstate(over="ignore"):
        v, h, intensities = (np.asarray(values, np.float32) for values in (v, h, intensities))
        v, h = (angles * (np.float32(math.pi) / np.float32(180.0)) for angles in (v, h))
    if (np.diff(v) < 0.0).any() or (np.diff(h) < 0.0).any():
        raise Unsupported("the angles of the file do not ascend")
    table = np.zeros((len(h) + 3, len(v) + 3), np.float32)
    table[0, 2:-1], table[2:-1, 0] = v, h
    table[2:-1, 2:-1] = intensities
    if not np.isfinite(table).all():
        raise Unsupported("the file has numbers that are not finite")
    _pad(table[1:, 1:], v, h)
    # All that read the file share the table.
    table.flags.writeable = False
    return table


def _parsed(text):
    """Return the type, the vertical and the horizontal angles in degrees, and the intensities, (horizontal, vertical)."""
    numbers = _Numbers(text)
    numbers.skip_tilt()
    numbers.whole(), numbers.number()
    factor = numbers.number()
    v_count, h_count, kind = (numbers.whole() for _ in range(3))
    if kind not in _TYPES:
        raise ValueError(f"this Blender does not read photometry of type {kind}")
    numbers.whole(), numbers.several(3)
    ballast, photometric, _ = numbers.several(3)
    if v_count < 1 or h_count < 1:
        raise ValueError("the file has no angles")
    v, h = numbers.several(v_count), numbers.several(h_count)
    values = numbers.several(v_count * h_count)
    numbers.end()
    with np.errstate(over="ignore", invalid="ignore"):
        values = factor * ballast * photometric * _WATTS_PER_CANDELA * np.array(values)
    return kind, np.array(v), np.array(h), values.reshape(h_count, v_count)


class _Numbers:
    """Reads the numbers of a file one after the other; a whole number ends where its digits end, as in C."""

    def __init__(self, text):
        # Cycles takes commas as blanks, and a character of code 0 as the end.
        self._text, self._at = text.replace(",", " ").partition("\0")[0], 0

    def skip_tilt(self):
        self._at = self._text.find("\nTILT=")
        if self._at < 0:
            raise ValueError("the file has no line TILT=")
        if self._text.startswith(_TILT_INCLUDED, self._at):
            self._at += len(_TILT_INCLUDED)
            self.number()
            self.several(2 * self.whole())
        else:
            self._at = self._text.find("\n", self._at + 1)
        if not 0 <= self._at < len(self._text):
            raise ValueError(_ENDS_EARLY)
        self._at += 1

    def number(self):
        value = float(self._next(_NUMBER))
        if not math.isfinite(value):
            raise Unsupported("the file has numbers that are not finite")
        return value

    def whole(self):
        return int(self._next(_WHOLE))

    def several(self, count):
        return [self.number() for _ in range(count)]

    def end(self):
        if _READS_ON and self._at == len(self._text):
            raise ValueError("the file has nothing after its last number")

    def _next(self, pattern):
        found = pattern.match(self._text, self._at)
        if found is None:
            raise ValueError(_ENDS_EARLY)
        self._at = found.end()
        return found[1]


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
    # In single precision 1e-7 less than pi is pi: as in Cycles, angles that end exactly there do not go around.
    tiny = np.float32(1e-7)
    wraps_v_low, wraps_v_high = v[0] < tiny, v[-1] > np.float32(math.pi) - tiny
    wraps_h = h[0] < tiny and h[-1] > np.float32(2.0 * math.pi) - tiny
    inside = grid[1:-1]
    if _IS_STRICT:
        inside[:, 0], inside[:, -1] = inside[:, 2], inside[:, -2]
        wraps_h = True
    else:
        inside[:, 0] = inside[:, 2] if wraps_v_low else _beyond(inside[:, 1])
        inside[:, -1] = inside[:, -3] if wraps_v_high else _beyond(inside[:, -2])
    if wraps_h:
        grid[0], grid[-1] = grid[-3], grid[2]
    else:
        # Beyond the last angle Cycles repeats the last but one.
        grid[0], grid[-1] = _beyond(grid[1]), _beyond(grid[-3])


def _beyond(values):
    """Return the values beyond an end, at which values are repeated."""
    return np.zeros_like(values) if _PADS_WITH_ZERO else values


READERS = {"TEX_IES": _ies_texture}
