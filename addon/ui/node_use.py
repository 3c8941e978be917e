"""The nodes of a material that cost time: how many of the user's are left after folding, and which take how long."""

from collections import Counter
from dataclasses import dataclass

from ..export.walk import GROUPS
from ..measure.node_costs import costs_of

# Nodes that carry values and compute none.
_WIRING = {"FRAME", "REROUTE", "GROUP_INPUT", "GROUP_OUTPUT"}
# The name of what no node of the user computes: a bump of the displacement.
_OWN = "Material"


@dataclass(frozen=True)
class NodeUse:
    """total: nodes that compute values, those inside a group as often as it is used; left: those that rays evaluate.

    costs: (name, nanoseconds of a vertex on the reference machine) of each node that is left and of shaders, the highest first.
    """

    total: int
    left: int
    costs: tuple

    @property
    def nanoseconds(self):
        return sum(cost for _, cost in self.costs)


def use_of(tree, exported):
    """Return the NodeUse of an Exported material. tree: its node tree, or None."""
    costs = Counter()
    for maker, cost in zip(exported.makers, costs_of(exported.material), strict=True):
        if cost > 0.0:
            costs[maker or _OWN] += cost
    computing, shading = _names(tree, ()) if tree is not None else (Counter(), set())
    left = sum(1 for name in costs if name != _OWN and name not in shading)
    return NodeUse(computing.total(), left, tuple(sorted(costs.items(), key=lambda item: (-item[1], item[0]))))


def _names(tree, path):
    """Return the names, as NodeGraph.title gives them, of the nodes that compute values, and those of shaders."""
    computing, shading = Counter(), set()
    for node in tree.nodes:
        title = " / ".join((*path, node.name))
        if node.type in GROUPS and node.node_tree is not None:
            inner, shaders = _names(node.node_tree, (*path, node.name))
            computing += inner
            shading |= shaders
        elif any(socket.type == "SHADER" for socket in node.outputs):
            shading.add(title)
        elif node.type not in _WIRING and len(node.outputs):
            computing[title] += 1
    return computing, shading
