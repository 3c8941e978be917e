"""Node trees with zones, closures, bundles or menus, which Blender resolves into plain nodes before Cycles reads them."""

import re

import bpy

from .course_models import model_of
from .walk import GROUPS

_HAS_ZONES = bpy.app.version >= (5, 0)
_ZONES = {
    "FunctionNodeInputMenu", "GeometryNodeMenuSwitch", "GeometryNodeRepeatInput", "GeometryNodeRepeatOutput",
    "NodeClosureInput", "NodeClosureOutput", "NodeCombineBundle", "NodeEvaluateClosure", "NodeImplicitConversion",
    "NodeJoinBundle", "NodeSeparateBundle",
}  # fmt: skip
# Blender numbers the nodes of a resolved tree: one node may appear several times.
_NUMBER = re.compile(r"^\d+_")


class ShaderTree:
    """The nodes of a material, world or light as Cycles reads them."""

    def __init__(self, block):
        self.tree = block.node_tree
        self.models = ()  # names of the course's groups that became their nodes
        # Blender frees a resolved tree with this object.
        self._owner = None
        trees = _trees_inside(self.tree) if _HAS_ZONES and self.tree is not None else ()
        if any(node.bl_idname in _ZONES for tree in trees for node in tree.nodes):
            self.models = tuple(sorted(tree.name for tree in trees if model_of(tree) is not None))
            self._owner = block.inline_shader_nodes()
            self.tree = self._owner.node_tree

    def name(self, node):
        """Return the name of a node, which the user gave it."""
        return node.name if self._owner is None else _NUMBER.sub("", node.name)


def _trees_inside(tree):
    """Return a tree and those of all groups inside, each once."""
    found, open_ = {}, [tree]
    while open_:
        tree = open_.pop()
        if tree is not None and tree.as_pointer() not in found:
            found[tree.as_pointer()] = tree
            open_.extend(node.node_tree for node in tree.nodes if node.type in GROUPS)
    return found.values()
