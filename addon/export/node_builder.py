"""Nodes of the core, added one by one: equal nodes are shared, constants are folded, and what changes nothing is left out.

The base of graph.NodeGraph, which reads Blender's nodes into them.
"""

import contextlib
import math

from ..bindings import snapshot
from ..bindings.enums import MOST_NODES, NODE_STEADY, MathOperation, MixMode, NodeKind, VectorOperation
from ..bindings.shading import NodeRef
from ..messages.severity import Severity
from .arithmetic import is_constant, single, triple
from .colorspace import luminance_weights
from .fold import FOLDED, fold, gives_number
from .neutral import neutral

UNKNOWN = {"mid-grey": (0.5, 0.5, 0.5), "white": (1.0, 1.0, 1.0)}
_OF_THREE = {NodeKind.MIX, NodeKind.VECTOR_MATH, NodeKind.INVERT}


class _Scope:
    """Nodes and values computed so far that the following nodes may refer to."""

    def __init__(self):
        self.numbers = {}
        self.values = {}


class NodeBuilder:
    def __init__(self, owner, messages, images, unknown):
        """unknown: a key of UNKNOWN, the colour of nodes that are not supported."""
        self.owner = owner
        self.messages = messages
        self.images = images
        self.unknown = unknown
        self.maker = ""  # the name of the user's node that is read
        self.makers = []  # of each node: its maker, the first one of a shared node
        self.is_steady = False  # whether images with mipmaps take the values of added nodes as constant over a pixel
        self._nodes = []
        self._scopes = [_Scope()]

    @property
    def nodes(self):
        return tuple(self._nodes)

    @contextlib.contextmanager
    def made_by(self, name, is_steady=False):
        """Attribute the nodes that are added meanwhile to the user's node of that name."""
        outer, self.maker, self.is_steady = (self.maker, self.is_steady), name, is_steady
        try:
            yield
        finally:
            self.maker, self.is_steady = outer

    def emit(self, kind, *inputs, option=0, flags=0, name="", image=0, image_count=0, first=0, matrix=None):
        """Add a node of the core and return its NodeRef.

        Without a node, return its value if all inputs are constant and its kind folds, or what it passes on (neutral.py).
        """
        # Spread a constant number over all three channels, as the results of nodes are.
        inputs = tuple(map(single, map(in_three, inputs) if kind in _OF_THREE else inputs))
        fields = {} if matrix is None else {"matrix": tuple(float(x) for x in matrix)}
        node = snapshot.Node(
            kind=kind, option=option, flags=flags, name=name, image=image, image_count=image_count, first=first,
            inputs=inputs, **fields,
        )  # fmt: skip
        if kind in FOLDED and not any(isinstance(value, NodeRef) for value in node.inputs):
            return self._fold(node)
        passed_on = neutral(node, self._nodes)
        if passed_on is not None:
            return passed_on
        numbers = self._scopes[-1].numbers
        # The text of inputs tells 0 and -0 apart.
        if self.is_steady:
            node = node.replaced(flags=flags | NODE_STEADY)
        key = (kind, option, node.flags, name, image, image_count, first, repr(node.inputs), node.matrix)
        if key not in numbers:
            if len(self._nodes) >= MOST_NODES:
                text = f"has more than {MOST_NODES} nodes, {self.unknown} is used for the rest"
                self.messages.add(f"{self.owner}: {text}", "feature:many nodes", severity=Severity.WRONG)
                return UNKNOWN[self.unknown]
            numbers[key] = len(self._nodes)
            self._nodes.append(node)
            self.makers.append(self.maker)
        return NodeRef(numbers[key])

    def _fold(self, node):
        value = fold(node)
        if all(map(math.isfinite, triple(value))):
            return value
        self.messages.add(f"{self.owner}: a node's result is not finite, 0 is used")
        return 0.0 if gives_number(node) else (0.0, 0.0, 0.0)

    def table(self, values):
        """Return the number of an image with the table, (n, channels) of float32, as its only row."""
        return self.grid(values[None])

    def grid(self, values):
        """Return the number of an image with these values, (rows, columns, channels) of float32."""
        return self.images.table(values)

    def height_nodes(self, build):
        """Return (first, value) of build(), whose nodes from number first on are not shared: BUMP evaluates them elsewhere."""
        first = len(self._nodes)
        self._scopes.append(_Scope())
        value = build()
        self._scopes.pop()
        return first, value

    def op(self, operation, *values, clamped=False):
        values = (*values, *(0.0,) * (3 - len(values)))
        return self.emit(NodeKind.MATH, *values, option=operation, flags=int(clamped))

    def clamped(self, value):
        """Return a number clamped to 0 to 1; constants are clamped where they are read."""
        return self.op(MathOperation.ADD, value, 0.0, clamped=True) if isinstance(value, NodeRef) else value

    def vector_op(self, operation, *values, scale=1.0):
        values = (*values, *((0.0, 0.0, 0.0),) * (3 - len(values)))
        return self.emit(NodeKind.VECTOR_MATH, *values, scale, option=operation)

    def multiply(self, a, b):
        if is_constant(a, 0.0) or is_constant(b, 0.0):
            return _like(0.0, a, b)
        if is_constant(a, 1.0) or is_constant(b, 1.0):
            return _like(b if is_constant(a, 1.0) else a, a, b)
        if isinstance(a, float) and isinstance(b, float):
            return single(a * b)
        return self.vector_op(VectorOperation.MULTIPLY, in_three(a), in_three(b))

    def add(self, a, b):
        if is_constant(a, 0.0) or is_constant(b, 0.0):
            return _like(b if is_constant(a, 0.0) else a, a, b)
        if isinstance(a, float) and isinstance(b, float):
            return single(a + b)
        return self.vector_op(VectorOperation.ADD, in_three(a), in_three(b))

    def subtract(self, a, b):
        """Of scalars."""
        if isinstance(a, float) and a == b:
            return 0.0
        return a if is_constant(b, 0.0) else self.op(MathOperation.SUBTRACT, a, b)

    def mix(self, factor, a, b):
        """Return the mix of two colours; the factor is clamped to 0 to 1."""
        if is_constant(factor, 0.0) or is_constant(factor, 1.0):
            return b if is_constant(factor, 1.0) else a
        return self.emit(NodeKind.MIX, factor, in_three(a), in_three(b), option=MixMode.MIX, flags=1)

    def component(self, value, axis):
        return self.emit(NodeKind.SEPARATE, value, option=axis)

    def combine(self, x, y, z):
        return self.emit(NodeKind.COMBINE, x, y, z)

    def grey(self, color):
        return self.emit(NodeKind.GREY, color, matrix=(*luminance_weights(), *(0.0,) * 9))


def in_three(value):
    return value if isinstance(value, NodeRef) else triple(value)


def _like(value, a, b):
    """Return value as a number if both operands are numbers, else with three channels."""
    return value if isinstance(a, float) and isinstance(b, float) else in_three(value)
