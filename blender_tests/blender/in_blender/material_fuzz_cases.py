"""Materials of random nodes, as they are exported."""

import random

import bpy
import numpy as np
import stage
from material_cases import Tree, read, told

from addon.bindings.shading import NodeRef
from addon.export.describe import describe_material


def fuzz(count, zones=False):
    """Set and link every node of materials at random, also in groups. Return what was built, and the failures.

    zones: also nodes that Blender resolves, which it then does with most of the trees.
    """
    stage.empty()
    material = bpy.data.materials.new("asked")
    material.use_nodes = True
    kinds = []
    for name in sorted(dir(bpy.types)):
        kind = getattr(bpy.types, name)
        is_node = isinstance(kind, type) and issubclass(kind, bpy.types.Node)
        # A link to a reroute changes its sockets, which the links below are made of.
        if name.startswith("ShaderNode") or zones and is_node and name != "NodeReroute":
            try:
                material.node_tree.nodes.new(name)
                kinds.append(name)
            except RuntimeError:
                pass
    picture = bpy.data.images.new("picture", 4, 4, alpha=True)
    group = bpy.data.node_groups.new("group", "ShaderNodeTree")
    result = {"kinds": len(kinds), "lobes": 0, "nodes": 0, "backward": 0, "wild": 0}
    for seed in range(int(count)):
        rng = random.Random(seed)
        group.nodes.clear()
        _fill(rng, group, kinds, 6, picture, None)
        tree = Tree(f"fuzz {seed}")
        nodes = _fill(rng, tree.tree, kinds, 30, picture, group)
        if zones:
            _pair(rng, nodes)
        outputs = [socket for node in nodes for socket in node.outputs]
        shaders = [socket for socket in outputs if socket.type == "SHADER"]
        if shaders:
            tree.show(rng.choice(shaders))
        tree.tree.links.new(rng.choice(outputs), tree.output.inputs["Displacement"])
        record = read(tree.material)[0]
        describe_material(tree.material)
        result["lobes"] += len(record.lobes)
        result["nodes"] += len(record.nodes)
        result["wild"] += sum(not finite(value) for value in told_numbers(told(record)))
        for number, node in enumerate(record.nodes):
            result["backward"] += sum(isinstance(value, NodeRef) and value.node >= number for value in node.inputs)
    return result


def finite(value):
    """Return whether the number is finite in single precision, in which the core computes."""
    return bool(np.isfinite(np.float32(value)))


def told_numbers(value):
    """Return all numbers of the plain data of a record."""
    if isinstance(value, (dict, list)):
        return [number for item in (value.values() if isinstance(value, dict) else value) for number in told_numbers(item)]
    return [value] if isinstance(value, float) else []


def _fill(rng, tree, kinds, count, picture, group):
    nodes = [tree.nodes.new(kind) for kind in rng.choices(kinds, k=count)]
    for node in nodes:
        for field in node.bl_rna.properties:
            if field.is_readonly or field.identifier.startswith("bl_"):
                continue
            try:
                if field.type == "ENUM":
                    setattr(node, field.identifier, rng.choice([item.identifier for item in field.enum_items]))
                elif field.type == "BOOLEAN":
                    setattr(node, field.identifier, rng.random() < 0.2)
            except (TypeError, AttributeError, IndexError):
                pass  # not among the current choices, or there is none
        if hasattr(node, "image") and rng.random() < 0.7:
            node.image = picture
        if node.type == "GROUP":
            node.node_tree = group
        for socket in node.inputs:
            if socket.type == "VALUE":
                socket.default_value = rng.choice([0.0, 1.0, 0.3, -2.0, 1e30, float("nan"), rng.random()])
            elif socket.type in ("VECTOR", "RGBA"):
                socket.default_value = [rng.choice([0.0, 1.0, 0.4, -1.0, 5.0]) for _ in socket.default_value]
    outputs = {}
    for node in nodes:
        for socket in node.outputs:
            if socket.type != "CUSTOM":
                outputs.setdefault(socket.type == "SHADER", []).append(socket)
    # Three of four links join sockets of the same kind, so that most links are valid.
    for socket in (socket for node in nodes for socket in node.inputs if socket.type != "CUSTOM"):
        alike = outputs.get((socket.type == "SHADER") == (rng.random() < 0.75))
        if alike and rng.random() < 0.7:
            tree.links.new(rng.choice(alike), socket)
    return nodes


def _pair(rng, nodes):
    """Make zones of the nodes of their ends, with items of any type."""
    for begin, end in (("GeometryNodeRepeatInput", "GeometryNodeRepeatOutput"), ("NodeClosureInput", "NodeClosureOutput")):
        ends = [node for node in nodes if node.bl_idname == end]
        for node in nodes:
            if node.bl_idname == begin and ends:
                last = ends.pop()
                node.pair_with_output(last)
                for items in (getattr(last, name, None) for name in ("repeat_items", "input_items", "output_items")):
                    if items is not None:
                        items.new(rng.choice(("FLOAT", "RGBA", "VECTOR", "SHADER", "BUNDLE", "CLOSURE")), "Item")
