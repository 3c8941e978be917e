"""Attributes of the instances that Geometry Nodes make: those of an instance, then those of the instances that contain it."""

import bpy
import numpy as np

from .attributes import TYPES

# Before 4.5 Blender does not expose these attributes; 4.5 never frees 16 bytes of each geometry that it exposes.
HAS_INSTANCES = bpy.app.version >= (4, 5)
_UNUSED = 2**31 - 1  # in DepsgraphObjectInstance.persistent_id
# Types that Blender converts to a colour.
_TYPES = {kind: how for kind, how in TYPES.items() if kind not in ("FLOAT4", "QUATERNION")}
# Parts of a geometry, and the type of object that shows each as itself.
_PARTS = {"mesh": "MESH", "curves": "CURVES", "pointcloud": "POINTCLOUD", "volume": "VOLUME", "grease_pencil": "GREASEPENCIL"}
_NOT_STORED = "position"  # Blender adds it to the points that stand for instances


class Unreadable(Exception):
    """Blender does not expose the instances that an entry belongs to."""

    def __init__(self, text="Blender does not expose the attributes of its instances' own instances"):
        super().__init__(text)


def makes_instances(thing):
    """Whether Geometry Nodes may make instances of the object."""
    return any(modifier.type == "NODES" for modifier in thing.modifiers)


def steps(entry):
    """Return the numbers of the instances that lead to an entry, the innermost first."""
    return [number for number in entry.persistent_id if number != _UNUSED]


class _Layer:
    """The instances of one geometry, a row for each."""

    def __init__(self, geometry, points, sees_all):
        # Blender frees the points with the geometry.
        self._geometry, self._sees_all = geometry, sees_all
        self._parts = [own for part, own in _PARTS.items() if getattr(geometry, part, None) is not None]
        self._attributes = points.attributes
        self._references = geometry.instance_references()
        self._of_row = self._read(".reference_index").astype(int).ravel().tolist()
        ids = self._read("id")
        self._rows, self._repeated = {}, []
        for row, number in enumerate(range(len(self._of_row)) if ids is None else ids.astype(int).ravel().tolist()):
            if self._rows.setdefault(number, row) != row:
                self._repeated.append(row)
        self._below, self._values = {}, {}

    def row(self, number):
        """Return the row of an id. Blender gives random ids to rows that repeat one: these appear in the order of the rows."""
        if number not in self._rows:
            if not self._repeated:
                raise Unreadable
            if not self._sees_all:
                raise Unreadable("Blender does not expose which of its instances with one id shows a lamp")
            self._rows[number] = self._repeated.pop(0)
        return self._rows[number]

    def reference(self, row):
        """Return what the row places: an object, a collection, the _Layer of a geometry, or None."""
        number = self._of_row[row]
        if not 0 <= number < len(self._references):
            return None
        found = self._references[number]
        if not isinstance(found, bpy.types.GeometrySet):
            return found
        if number not in self._below:
            self._below[number] = _layer_of(found, self._sees_all)
        return self._below[number]

    def parts(self, kind):
        """Return the number of other parts of the geometry that Blender shows as instances. kind: the type of their object."""
        return sum(own != kind for own in self._parts)

    def value(self, name, row):
        """Return (x, y, z, alpha) of an attribute of a row; None if there is none that Blender converts to a colour."""
        if name not in self._values:
            self._values[name] = self._read(name)
        found = self._values[name]
        if found is None:
            return None
        values = found[row].tolist()
        if len(values) == 1:
            values *= 3
        return (*values, *(0.0, 0.0, 0.0, 1.0)[len(values) :])

    def _read(self, name):
        """Return (rows, channels), or None."""
        attribute = None if name == _NOT_STORED else self._attributes.get(name)
        if attribute is None or attribute.data_type not in _TYPES:
            return None
        field, dtype, width = _TYPES[attribute.data_type]
        values = np.empty(len(attribute.data) * width, dtype)
        attribute.data.foreach_get(field, values)
        return values.reshape(-1, width).astype(float)


def _layer_of(geometry, sees_all):
    points = geometry.instances_pointcloud()
    return None if points is None else _Layer(geometry, points, sees_all)


class InstanceLayers:
    """Finds the layers of the entries of a depsgraph. Each geometry is read once."""

    def __init__(self, depsgraph, sees_all):
        """sees_all: whether of() is called for all entries, in their order, and not for lamps alone."""
        self._depsgraph, self._sees_all = depsgraph, sees_all
        self._hidden = "hide_render" if depsgraph.mode == "RENDER" else "hide_viewport"
        self._layers = {}

    def of(self, entry):
        """Return [(_Layer, row), ...] of an instance, the innermost first; raise Unreadable if they are not found."""
        found = []
        self._follow(entry.parent, steps(entry), found)
        return found[::-1]

    def _layer(self, thing):
        key = thing.as_pointer()
        if key not in self._layers:
            self._layers[key] = _layer_of(thing.evaluated_geometry(), self._sees_all) if makes_instances(thing) else None
        return self._layers[key]

    def _follow(self, thing, numbers, found):
        """Add the layers below an object. numbers: one for each step from the entry, the innermost first."""
        layer = self._layer(thing)
        if layer is not None:
            self._descend(layer, thing.type, numbers, found)
        elif len(numbers) > 1:
            members = self._members(thing, numbers)
            if len(members) == 1:
                self._follow(members[0], numbers[:-1], found)
            elif members:
                raise Unreadable

    def _members(self, thing, numbers):
        """Return the objects one of which the outermost number refers to."""
        if thing.instance_type == "COLLECTION" and thing.instance_collection is not None:
            return thing.instance_collection.all_objects[numbers[-1] : numbers[-1] + 1]
        if thing.instance_type in ("VERTS", "FACES"):
            children = [child.evaluated_get(self._depsgraph) for child in thing.original.children]
            return [child for child in children if makes_instances(child) or child.instance_type != "NONE"]
        # An instance of particles has two numbers of its own.
        if len(numbers) > 2 and len(thing.particle_systems):
            raise Unreadable
        return []

    def _descend(self, layer, kind, numbers, found):
        """Add the layers of a geometry and of those inside it. kind: the type of the object that has the geometry."""
        while layer is not None and numbers:
            # Beside other parts, the instances have one number more: that of the part after the last.
            parts = layer.parts(kind)
            if parts:
                if numbers[-1] < parts:
                    return
                numbers = numbers[:-1]
            if not numbers:
                raise Unreadable
            row = layer.row(numbers[-1])
            numbers, kind = numbers[:-1], ""
            found.append((layer, row))
            inner = layer.reference(row)
            if isinstance(inner, bpy.types.Collection):
                # Each visible object of a collection has two numbers: its own, and that of its instances.
                if len(numbers) > 1:
                    visible = [member for member in inner.all_objects if not getattr(member, self._hidden)]
                    if numbers[-1] // 2 >= len(visible):
                        raise Unreadable
                    self._follow(visible[numbers[-1] // 2], numbers[:-1], found)
                return
            if isinstance(inner, bpy.types.Object):
                if numbers:
                    self._follow(inner, numbers, found)
                return
            layer = inner
