"""Values of the Attribute nodes that read objects and instancers: columns of the instance table, and constants of lamps."""

import functools

import bpy
import numpy as np

from ..bindings.snapshot import ObjectAttribute
from .apart import info_of
from .instance_layers import HAS_INSTANCES, InstanceLayers, Unreadable, makes_instances, steps
from .instancer_places import INSTANCER_PLACE, place_value
from .particles import PARTICLE, particle_value
from .properties import object_value, property_value

_OF_OBJECT, _OF_INSTANCER = "object:", "instancer:"
PREFIXES = {"OBJECT": _OF_OBJECT, "INSTANCER": _OF_INSTANCER}
# Outputs of the Object Info node, which are constants of a lamp.
LAMP_FACTS = frozenset({"Location", "Color", "Alpha", "Object Index", "Random"})
_NONE = (0.0, 0.0, 0.0, 0.0)
_OF_NO_OBJECT = (0.0, 0.0, 0.0, 1.0)
LAMPS_ARE_OBJECTS = bpy.app.version >= (4, 5)
_LARGEST = float(np.finfo(np.float32).max)


def read_object_attributes(depsgraph, rows, messages, poll_every, poll):
    """Return the ObjectAttributes of a table whose rows read these names.

    rows: {number of the entry of the depsgraph: names}, the rows in their order.
    """
    reader = AttributeReader(depsgraph, sees_all=True)
    columns = {name: np.zeros((len(rows), 4), np.float32) for name in sorted(frozenset().union(*rows.values()))}
    of_entry = {entry: row for row, entry in enumerate(rows)}
    reads_instancers = any(name.startswith(_OF_INSTANCER) for name in columns)
    for number, entry in enumerate(depsgraph.object_instances):
        if number % poll_every == 0:
            poll()
        names = rows.get(number, ())
        layers = reader.layers(entry, names, messages) if reads_instancers and entry.is_instance else ()
        for name in names:
            columns[name][of_entry[number]] = reader.value(entry, name, layers, messages)
    return tuple(ObjectAttribute(name, values) for name, values in columns.items())


def _fact_of_lamp(entry, name):
    """Return an output of Object Info."""
    if name == "Location":
        return (*entry.matrix_world.translation, 1.0)
    if name == "Object Index":
        return (float(max(0, entry.object.pass_index)),) * 3 + (1.0,)
    *color, random = info_of(entry)
    return (random,) * 3 + (1.0,) if name == "Random" else tuple(color)


class AttributeReader:
    """Looks up values by the names of ObjectAttributes."""

    def __init__(self, depsgraph, sees_all):
        """sees_all: as for InstanceLayers."""
        self._depsgraph = depsgraph
        self._layers = InstanceLayers(depsgraph, sees_all) if HAS_INSTANCES else None
        self._values = {}  # (value, message)

    def layers(self, entry, names, messages):
        """Return the layers of Geometry Nodes that an instance belongs to, the innermost first."""
        if self._layers is None:
            if names and self._may_be_made(entry):
                _tell(messages, entry.parent, "this Blender does not expose attributes of Geometry Nodes' instances")
            return ()
        try:
            return self._layers.of(entry)
        except Unreadable as reason:
            if names:
                _tell(messages, entry.parent, str(reason))
            return ()

    def _may_be_made(self, entry):
        """Whether Geometry Nodes may have made an instance, or an instance inside it."""
        is_deep = len(steps(entry)) > (1 if entry.particle_system is None else 2)
        return makes_instances(entry.parent) or is_deep and self._has_makers

    @functools.cached_property
    def _has_makers(self):
        return any(makes_instances(thing) for thing in bpy.data.objects)

    def of_lamp(self, entry, name, messages):
        """Return four finite numbers: 0, 0, 0, 1 where lamps have no properties. name: also one of LAMP_FACTS."""
        if not LAMPS_ARE_OBJECTS and name != "Random":
            return _NONE if name in LAMP_FACTS else _OF_NO_OBJECT
        if name in LAMP_FACTS:
            return _fact_of_lamp(entry, name)
        return self.value(entry, name, self.layers(entry, (name,), messages) if entry.is_instance else (), messages)

    def value(self, entry, name, layers, messages):
        """Return four finite numbers; zeros if nothing has that name."""
        value, text = self._found(entry, name, layers)
        if text:
            messages.add(text)
        return value

    def _found(self, entry, name, layers):
        """Return the numbers, and a message or ""."""
        if name.startswith(INSTANCER_PLACE):
            return _finite(entry, name, place_value(entry, name))
        if name.startswith(PARTICLE):
            return _finite(entry, name, particle_value(entry, name, self._depsgraph.scene.frame_current_final))
        of_instancer = name.startswith(_OF_INSTANCER)
        path = name[len(_OF_INSTANCER if of_instancer else _OF_OBJECT) :]
        for layer, row in layers if of_instancer else ():
            value = layer.value(path, row)
            if value is not None:
                return _finite(entry, path, value)
        thing, instancer, particles = entry.object, entry.parent, entry.particle_system
        key = (
            name,
            thing.original.as_pointer(),
            thing.data.as_pointer(),
            0 if instancer is None else instancer.as_pointer(),
            0 if particles is None else particles.settings.as_pointer(),
        )
        if key not in self._values:
            value = None
            if of_instancer and entry.is_instance:
                value = None if particles is None else property_value(particles.settings, path)
                value = property_value(instancer, path) if value is None else value
            if value is None:
                value = object_value(thing, path, entry if entry.is_instance else None)
            self._values[key] = (_NONE, "") if value is None else _finite(entry, path, value)
        return self._values[key]


def _tell(messages, instancer, text):
    text = f"object '{instancer.name}': {text}, Attribute nodes read properties instead"
    messages.add(text, "feature:attributes of instances")


def _finite(entry, path, value):
    """Return the numbers made finite, and a message if that changes them."""
    finite = tuple(x if abs(x) <= _LARGEST else 0.0 for x in value)
    return finite, "" if finite == value else f"object '{entry.object.name}': attribute '{path}' is not finite, 0 is used"
