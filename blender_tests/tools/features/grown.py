"""A material that has grown to 60 nodes, most of which change nothing."""

from addon.bindings.enums import Coordinate, MathOperation, MixMode, NodeKind, VectorOperation
from addon.bindings.shading import Node, NodeRef

_UV = Node(NodeKind.COORDINATE, option=Coordinate.UV)


def sixty(folded=False):
    """Return 60 nodes, the last of which is the result; folded: the 7 that the export leaves of them.

    One half repeats the other and is mixed in by 0, and 46 multiply by 1.
    """
    nodes = [_UV]
    for half in range(1 if folded else 2):
        first = 1 + 6 * half
        nodes += [
            Node(NodeKind.NOISE, inputs=(NodeRef(0), (0.0, 5.0, 0.0), (4.0, 0.5, 2.0), (0.0, 1.0, 0.0)), flags=2 | 16),
            Node(NodeKind.VORONOI, inputs=(NodeRef(0), (0.0, 9.0, 1.0), (0.0, 0.5, 2.0), (1.0, 0.5, 0.0)), flags=1),
            Node(NodeKind.MATH, inputs=(NodeRef(first), 1.8, -0.4), option=MathOperation.MULTIPLY_ADD, flags=1),
            Node(NodeKind.MATH, inputs=(NodeRef(first + 1), 0.5, 0.0), option=MathOperation.MINIMUM),
            Node(NodeKind.MATH, inputs=(1.0, NodeRef(first + 3), 0.0), option=MathOperation.SUBTRACT),
            Node(NodeKind.VECTOR_MATH, inputs=(NodeRef(first + 2), NodeRef(first + 4)), option=VectorOperation.MULTIPLY),
        ]
    if not folded:
        nodes.append(Node(NodeKind.MIX, inputs=(0.0, NodeRef(6), NodeRef(12)), option=MixMode.MIX))
        for _ in range(46):
            last = NodeRef(len(nodes) - 1)
            nodes.append(Node(NodeKind.VECTOR_MATH, inputs=(last, (1.0, 1.0, 1.0)), option=VectorOperation.MULTIPLY))
    return tuple(nodes)
