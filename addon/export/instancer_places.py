"""Coordinates on an instancer of the place where it shows an object, as values of the instance table."""

from ..bindings.enums import Coordinate

# Names of these values begin so; the rest is the name of the coordinate.
INSTANCER_PLACE = "place on instancer:"


def place_name(which):
    """Return the name of the value of a Coordinate, GENERATED or UV."""
    return INSTANCER_PLACE + Coordinate(which).name


def place_value(entry, name):
    """Return (x, y, z, 1) of an entry of the depsgraph; the origin if it is no instance."""
    if not entry.is_instance:
        return 0.0, 0.0, 0.0, 1.0
    if name == place_name(Coordinate.UV):
        return (*map(float, entry.uv), 0.0, 1.0)
    # Blender gives Generated coordinates of instances from -1 to 1.
    return (*(0.5 * float(x) - 0.5 for x in entry.orco), 1.0)
