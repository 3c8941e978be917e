"""Attributes that the Raycast of Blender 5.2 reads where its rays end: each mesh has them, whatever its own materials read."""

import re

import bpy

from .attributes import attribute_name

_EXISTS = hasattr(bpy.types, "ShaderNodeRaycast")
# Names by which Cycles gives what no mesh has as an attribute.
COMPUTED = {"generated", "generated_transform", "N", "Ng", "undisplaced", "tangent", "tangent_sign"}
_OUTPUT = re.compile(r"Attribute_(\d+)(_Alpha)?")


def sampled_name(node, output):
    """Return (the attribute that an output of a Raycast gives, "" for none; whether the output is its alpha)."""
    number, alpha = _OUTPUT.fullmatch(output).groups()
    name = next((socket.default_value for socket in node.inputs if socket.identifier == f"Value_{number}"), "")
    return name, alpha is not None


def of_all_hits():
    """Return the names, as attribute_name() has them, that a Raycast of any material or node group reads."""
    return _of_trees() if _EXISTS else frozenset()


def _of_trees():
    trees = [material.node_tree for material in bpy.data.materials if material.node_tree is not None]
    groups = [group for group in bpy.data.node_groups if group.bl_idname == "ShaderNodeTree"]
    casts = [node for tree in trees + groups for node in tree.nodes if node.type == "MATERIAL_RAYCAST"]
    return frozenset().union(*map(_of_node, casts))


def _of_node(node):
    names = (sampled_name(node, f"Attribute_{number}")[0] for number in range(len(node.sample_attribute_items)))
    return frozenset(attribute_name(name) for name in names if name)
