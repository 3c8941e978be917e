"""Evaluation of single nodes by the core."""

import ctypes

from . import marshal
from .abi import check, load_library


def evaluate(node):
    """Return the four numbers of a snapshot.Node with constant inputs; raise LancerError if it depends on a shading point."""
    library = load_library()
    value = (ctypes.c_float * 4)()
    check(library.lancer_evaluate_node(ctypes.byref(marshal.node(node)), value), library)
    return tuple(value)
