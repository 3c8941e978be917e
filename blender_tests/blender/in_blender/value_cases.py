"""Value nodes with constants: compare the exporter's constants with Cycles' render of the same nodes."""

import random

import bpy
import numpy as np
import stage
from export_cases import export

# Light is not negative: this offset is added to every value.
LIFT = 128.0
POSITIVE = ("Fac", "Factor", "Steps")  # Blender 5 folds a constant negative number of steps differently
ROWS = 4  # of pixels: the smallest height that Blender renders
SKIPPED_OPERATIONS = {"SINH", "COSH", "EXPONENT"}  # beyond LIFT's precision for the numbers used


class Board:
    """Squares side by side, each showing one value."""

    def __init__(self):
        self.scene = stage.empty(engine="CYCLES")
        self.names = []

    def square(self, name, build):
        """Add a square. build(tree) returns the output socket to show."""
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        shown = build(tree)
        lifted = tree.nodes.new("ShaderNodeVectorMath")
        lifted.operation, lifted.inputs[1].default_value = "ADD", (LIFT,) * 3
        emission, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(shown, lifted.inputs[0])
        tree.links.new(lifted.outputs[0], emission.inputs["Color"])
        tree.links.new(emission.outputs[0], output.inputs["Surface"])
        x = float(len(self.names))
        stage.mesh(name, [(x, 0, 0), (x + 1, 0, 0), (x + 1, ROWS, 0), (x, ROWS, 0)], [(0, 1, 2, 3)], material)
        self.names.append(name)

    def answer(self):
        """Return {name: [Cycles' value, ours]}."""
        scene, count = self.scene, len(self.names)
        camera = stage.camera((count / 2, ROWS / 2, 1), (count / 2, ROWS / 2, 0), type="ORTHO", ortho_scale=float(count))
        camera.rotation_euler = (0, 0, 0)
        scene.render.resolution_x, scene.render.resolution_y = count, ROWS
        scene.cycles.samples, scene.cycles.pixel_filter_type, scene.cycles.use_denoising = 1, "BOX", False
        scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0.0
        rendered = stage.picture(scene)[0, :, :3].astype(float) - LIFT
        ours = {material.name: np.array(material.emission, float) - LIFT for material in export().materials}
        return {name: [rendered[i].tolist(), ours[name].tolist()] for i, name in enumerate(self.names)}


def numbers(rng, width=None):
    values = [round(rng.uniform(-1.4, 1.4), 3) for _ in range(width or 1)]
    return values if width else values[0]


def fill(node, rng):
    """Set every input with a constant to a random one."""
    for socket in node.inputs:
        if socket.type == "VALUE":
            socket.default_value = abs(numbers(rng)) if socket.name in POSITIVE else numbers(rng)
        elif socket.type == "VECTOR":
            socket.default_value = [abs(x) if socket.name in POSITIVE else x for x in numbers(rng, 3)]
        elif socket.type == "RGBA":
            socket.default_value = [abs(x) for x in numbers(rng, 3)] + [1.0]


def simple(board, kind, label, rng, output=None, **settings):
    def build(tree):
        node = tree.nodes.new(kind)
        for field, value in settings.items():
            setattr(node, field, value)
        fill(node, rng)
        enabled = [socket for socket in node.outputs if socket.enabled]
        return enabled[0] if output is None else next(socket for socket in node.outputs if socket.identifier == output)

    board.square(label, build)


def choices(kind, field):
    """Return the values of an enumerated property of a node in this Blender."""
    material = bpy.data.materials.new("asked")
    material.use_nodes = True
    node = material.node_tree.nodes.new(kind)
    return [item.identifier for item in node.bl_rna.properties[field].enum_items]


def mathematics():
    board, rng = Board(), random.Random(1)
    for operation in choices("ShaderNodeMath", "operation"):
        if operation not in SKIPPED_OPERATIONS:
            for clamp in (False, True):
                simple(board, "ShaderNodeMath", f"{operation} {clamp}", rng, operation=operation, use_clamp=clamp)
    return board.answer()


def vectors():
    board, rng = Board(), random.Random(2)
    for operation in choices("ShaderNodeVectorMath", "operation"):
        simple(board, "ShaderNodeVectorMath", operation, rng, operation=operation)
    for kind in choices("ShaderNodeMapping", "vector_type"):
        simple(board, "ShaderNodeMapping", f"mapping {kind}", rng, vector_type=kind)
    for kind in choices("ShaderNodeVectorRotate", "rotation_type"):
        for invert in (False, True):
            simple(board, "ShaderNodeVectorRotate", f"rotate {kind} {invert}", rng, rotation_type=kind, invert=invert)
    for kind in choices("ShaderNodeMapRange", "interpolation_type"):
        for data in choices("ShaderNodeMapRange", "data_type"):
            for clamp in (False, True):
                settings = {"interpolation_type": kind, "data_type": data, "clamp": clamp}
                simple(board, "ShaderNodeMapRange", f"range {kind} {data} {clamp}", rng, **settings)
    for kind in choices("ShaderNodeClamp", "clamp_type"):
        simple(board, "ShaderNodeClamp", f"clamp {kind}", rng, clamp_type=kind)
    simple(board, "ShaderNodeNormal", "normal", rng, "Normal")
    simple(board, "ShaderNodeNormal", "dot", rng, "Dot")
    return board.answer()


def colours():
    board, rng = Board(), random.Random(3)
    for mode in choices("ShaderNodeMixRGB", "blend_type"):
        for clamp in (False, True):
            simple(board, "ShaderNodeMixRGB", f"old {mode} {clamp}", rng, blend_type=mode, use_clamp=clamp)
        simple(board, "ShaderNodeMix", f"{mode}", rng, "Result_Color", data_type="RGBA", blend_type=mode, clamp_factor=False)
    for data, output in (("FLOAT", "Result_Float"), ("VECTOR", "Result_Vector")):
        for clamp in (False, True):
            simple(board, "ShaderNodeMix", f"{data} {clamp}", rng, output, data_type=data, clamp_factor=clamp)
    settings = {"data_type": "VECTOR", "factor_mode": "NON_UNIFORM", "clamp_factor": False}
    simple(board, "ShaderNodeMix", "each factor", rng, "Result_Vector", **settings)
    for kind in ("Gamma", "Invert", "BrightContrast", "HueSaturation", "RGBToBW", "CombineXYZ"):
        simple(board, "ShaderNode" + kind, kind, rng)
    for mode in choices("ShaderNodeSeparateColor", "mode"):
        for i, output in enumerate(("Red", "Green", "Blue")):
            simple(board, "ShaderNodeSeparateColor", f"separate {mode} {i}", rng, output, mode=mode)
        simple(board, "ShaderNodeCombineColor", f"combine {mode}", rng, mode=mode)
    return board.answer()


def group(name, kinds_in, kinds_out):
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for names, way in ((kinds_in, "INPUT"), (kinds_out, "OUTPUT")):
        for socket, kind in names.items():
            if hasattr(tree, "interface"):
                tree.interface.new_socket(socket, in_out=way, socket_type=kind)
            else:
                (tree.inputs if way == "INPUT" else tree.outputs).new(kind, socket)
    return tree, tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")


def links():
    """Groups within groups, defaults of their inputs, muted nodes, reroutes, and conversions by links."""
    board = Board()
    inner, inner_in, inner_out = group("Inner", {"c": "NodeSocketColor", "f": "NodeSocketFloat"}, {"r": "NodeSocketVector"})
    scale = inner.nodes.new("ShaderNodeVectorMath")
    scale.operation = "MULTIPLY"
    inner.links.new(inner_in.outputs["c"], scale.inputs[0])
    inner.links.new(inner_in.outputs["f"], scale.inputs[1])
    inner.links.new(scale.outputs[0], inner_out.inputs["r"])
    outer, outer_in, outer_out = group("Outer", {"x": "NodeSocketColor"}, {"a": "NodeSocketColor", "b": "NodeSocketFloat"})
    for number, target in enumerate(("a", "b")):
        node = outer.nodes.new("ShaderNodeGroup")
        node.node_tree = inner
        node.inputs["f"].default_value = 0.5 + number
        outer.links.new(outer_in.outputs["x"], node.inputs["c"])
        outer.links.new(node.outputs["r"], outer_out.inputs[target])

    def grouped(output, linked):
        def build(tree):
            node = tree.nodes.new("ShaderNodeGroup")
            node.node_tree = outer
            node.inputs["x"].default_value = (0.25, 0.5, 0.125, 1.0)
            if linked:
                value = tree.nodes.new("ShaderNodeCombineXYZ")
                for socket, number in zip(value.inputs, (0.75, 0.25, 0.5), strict=True):
                    socket.default_value = number
                way = tree.nodes.new("NodeReroute")
                tree.links.new(value.outputs[0], way.inputs[0])
                tree.links.new(way.outputs[0], node.inputs["x"])
            return node.outputs[output]

        return build

    for output in ("a", "b"):
        for linked in (False, True):
            board.square(f"group {output} {linked}", grouped(output, linked))

    def receiver(kind, linked=False, **settings):
        """Return a builder of a node whose constant shows if a link to it has no effect."""

        def build(tree):
            node, end = tree.nodes.new(kind), tree.nodes.new("ShaderNodeVectorMath")
            end.inputs[0].default_value = (7.0, 8.0, 9.0)
            for field, value in settings.items():
                setattr(node, field, value)
            if kind == "ShaderNodeMixRGB":
                node.inputs[1].default_value = (0.2, 0.4, 0.6, 1.0)
            if linked:
                value = tree.nodes.new("ShaderNodeValue")
                value.outputs[0].default_value = 0.75
                tree.links.new(value.outputs[0], next(socket for socket in node.inputs if socket.type == "RGBA"))
            tree.links.new(node.outputs[0], end.inputs[0])
            return end.outputs[0]

        return build

    board.square("muted", receiver("ShaderNodeMixRGB", mute=True))
    board.square("muted linked", receiver("ShaderNodeMixRGB", True, mute=True))
    board.square("muted without input", receiver("ShaderNodeRGB", mute=True))
    board.square("muted group", receiver("ShaderNodeGroup", node_tree=outer, mute=True))
    board.square("loose reroute", receiver("NodeReroute"))
    board.square("linked reroute", receiver("NodeReroute", True))

    def luminance(tree):
        color, node = tree.nodes.new("ShaderNodeRGB"), tree.nodes.new("ShaderNodeMath")
        color.outputs[0].default_value = (0.9, 0.3, 0.1, 1.0)
        node.operation, node.inputs[1].default_value = "ADD", 0.0
        tree.links.new(color.outputs[0], node.inputs[0])
        return node.outputs[0]

    def mean(tree):
        vector, node = tree.nodes.new("ShaderNodeCombineXYZ"), tree.nodes.new("ShaderNodeMath")
        for socket, value in zip(vector.inputs, (0.9, 0.3, 0.1), strict=True):
            socket.default_value = value
        node.operation, node.inputs[1].default_value = "ADD", 0.0
        tree.links.new(vector.outputs[0], node.inputs[0])
        return node.outputs[0]

    board.square("colour to number", luminance)
    board.square("vector to number", mean)
    return board.answer()
