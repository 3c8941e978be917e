"""AOV Output nodes: the values of a material or of a world that go into the passes of a view layer."""

from typing import NamedTuple

import bpy

from ..bindings.enums import PassKind
from ..bindings.numbered_pass import NumberedPass
from ..bindings.shading import Output
from .walk import sites

_KINDS = {"COLOR": PassKind.AOV_COLOR, "VALUE": PassKind.AOV_VALUE}


class Aov(NamedTuple):
    """A pass of a view layer."""

    name: str
    source: NumberedPass

    @property
    def is_color(self):
        return self.source.kind == PassKind.AOV_COLOR


def aovs_of(view_layer):
    """Return the Aovs of a view layer, without those whose name another pass has."""
    found, counts = [], dict.fromkeys(_KINDS.values(), 0)
    for aov in view_layer.aovs:
        if aov.is_valid:
            kind = _KINDS[aov.type]
            found.append(Aov(aov.name, NumberedPass(kind, counts[kind])))
            counts[kind] += 1
    return tuple(found)


def rendered_aovs(view_layer, passes):
    """Return the Aovs of a view layer that are among the passes of an export."""
    return tuple(aov for aov in aovs_of(view_layer) if aov.source in passes)


def read_lone_outputs(graph, tree, aovs):
    """Return the Outputs of a tree that shows nothing; Cycles 3 has none of them."""
    return read_outputs(graph, tree, aovs) if tree is not None and bpy.app.version >= (4, 0) else ()


def read_outputs(graph, tree, aovs):
    """Return the Outputs of a node tree, also inside its groups, for these Aovs."""
    found = []
    for site in sites(tree, "OUTPUT_AOV") if aovs else ():
        if site.node.mute:
            continue
        # The layer decides which of them are rendered.
        graph.reads_layer = True
        # Before 4.2 the name of the AOV takes the place of the node's own name.
        name = getattr(site.node, "aov_name", site.node.name)
        for aov in aovs:
            if aov.name == name:
                value = graph.parameter(site, ("Color",), kind="vector") if aov.is_color else graph.parameter(site, ("Value",))
                found.append(Output(number=aov.source.number, is_color=aov.is_color, value=value))
    return tuple(found)
