"""Nodes by themselves, as the core computes them."""

import ctypes

from . import marshal
from .abi import check, load_library


def evaluate(node):
    """The four numbers of a snapshot.Node whose inputs are constants; LancerError where it asks for a place to look at."""
    library = load_library()
    value = (ctypes.c_float * 4)()
    check(library.lancer_evaluate_node(ctypes.byref(marshal.node(node)), value), library)
    return tuple(value)
