"""Light groups: the numbers of a view layer's groups, to which lamps, objects and worlds belong by name."""

from ..bindings.enums import PassKind
from ..bindings.numbered_pass import NumberedPass

# The most groups of a view layer, as the core has them.
MOST = 1024


def light_groups_of(view_layer):
    """Return (name, NumberedPass) of each group of a view layer."""
    names = [group.name for group in view_layer.lightgroups][:MOST]
    return tuple((name, NumberedPass(PassKind.LIGHT_GROUP, number)) for number, name in enumerate(names))


def group_numbers(view_layer, passes):
    """Return the number of each group by its name, 1 being the first, of those among the passes of an export."""
    return {name: source.number + 1 for name, source in light_groups_of(view_layer) if source in passes}
