"""Evaluation of single nodes with constant inputs."""

import numpy as np
import pytest

from addon.bindings.abi import LancerError
from addon.bindings.enums import ColorModel, MathOperation, NodeKind
from addon.bindings.nodes import evaluate
from addon.bindings.shading import NodeRef
from addon.bindings.snapshot import Node


def test_a_node_has_the_value_that_programs_compute():
    assert evaluate(Node(NodeKind.MATH, option=MathOperation.MULTIPLY_ADD, inputs=(2.0, 3.0, 0.5)))[:3] == (6.5,) * 3
    assert evaluate(Node(NodeKind.COMBINE, inputs=(0.25, 0.5, 1.0)))[:3] == (0.25, 0.5, 1.0)
    assert evaluate(Node(NodeKind.COLOR_MODEL, option=ColorModel.TO_HSV, inputs=((0.0, 1.0, 0.0),)))[1:3] == (1.0, 1.0)


def test_what_is_not_finite_is_told_as_it_is():
    assert np.isinf(evaluate(Node(NodeKind.MATH, option=MathOperation.EXPONENT, inputs=(1e4, 0.0, 0.0)))[0])


@pytest.mark.parametrize(
    "node",
    [
        Node(NodeKind.COORDINATE),
        Node(NodeKind.FRESNEL, inputs=(1.5,)),
        Node(999),
        Node(NodeKind.MATH, option=999, inputs=(0.0,) * 3),
        Node(NodeKind.CLAMP, inputs=(NodeRef(0), 0.0, 1.0)),
    ],
)
def test_what_needs_a_place_is_refused(node):
    with pytest.raises(LancerError, match="node"):
        evaluate(node)
