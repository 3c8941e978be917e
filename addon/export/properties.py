"""Properties of Blender's data by name, as the Attribute node of Cycles finds them for objects, instancers and view layers."""

import re

# The end of a path to one number of an array, which Cycles does not follow.
_INDEX, _COMPONENT = re.compile(r"\[-?\d+\]$"), re.compile(r"\.[a-z]$")
_MISSING = object()


def object_value(thing, name, entry=None):
    """Return (x, y, z, alpha) of a property of an evaluated object or else of its data; None without one that is a number.

    entry: that of the depsgraph, if the object is shown by an instance.
    """
    value = property_value(thing, name, entry)
    return property_value(thing.data, name) if value is None and thing.data is not None else value


def view_layer_value(depsgraph, name):
    """Return (x, y, z, alpha) of a property of the view layer, else of the scene, else of its world; zeros without one."""
    scene = depsgraph.scene_eval
    for owner in (depsgraph.view_layer_eval, scene, scene.world):
        value = None if owner is None else property_value(owner, name)
        if value is not None:
            return value
    return 0.0, 0.0, 0.0, 0.0


def property_value(block, name, entry=None):
    """Return (x, y, z, alpha) of a property of data; None without one of one to four numbers. entry: as for object_value."""
    # A custom property hides a built-in one of its name, even if it is no number.
    value = block.get(name, _MISSING)
    return _numbers(_at_path(block, name, entry) if value is _MISSING else value)


def _at_path(block, path, entry):
    """Return the property at a path, or None."""
    if not path or _INDEX.search(path):
        return None
    if entry is not None:
        first = re.match(r"\w*", path)[0]
        if path == "color":
            # An instance has the colour of its instancer.
            block = entry.parent
        elif first != "data" and _is_group(block, first):
            # A group of settings that is read from a temporary instance is memory that Blender never frees.
            block = entry.instance_object
    try:
        value = block.path_resolve(path)
        return None if _COMPONENT.search(path) and not _has_properties(block.path_resolve(path[:-2])) else value
    except (ValueError, TypeError, AttributeError):
        return None


def _has_properties(value):
    return hasattr(value, "bl_rna")


def _is_group(block, name):
    found = block.bl_rna.properties.get(name)
    return found is not None and found.type in ("POINTER", "COLLECTION")


def _numbers(value):
    if isinstance(value, (bool, int, float)):
        return (float(value),) * 3 + (1.0,)
    if value is None or isinstance(value, (str, bytes)) or not hasattr(value, "__len__") or not 1 <= len(value) <= 4:
        return None
    values = list(value) if not hasattr(value, "keys") else [None]
    if any(isinstance(x, bool) or not isinstance(x, (int, float)) for x in values):
        return None
    return (*map(float, values), *(0.0, 0.0, 0.0, 1.0)[len(values) :])
