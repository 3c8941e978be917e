"""Nodes that Blender resolves before Cycles reads a tree: bundles, menus, zones in groups, and nodes of constants."""

import bpy

from .boards import size_of
from .catalogue import case
from .nodes import Nodes
from .zone_nodes import (
    KINDS,
    SINCE,
    closure,
    combine,
    evaluate,
    math_of,
    menu,
    noise_of,
    number_of,
    repeat,
    separate,
    show_all,
    squared,
)  # fmt: skip


def _bundled(shown):
    def value(nodes):
        noise = noise_of(nodes)
        made = combine(nodes, {"A": "FLOAT", "B": "RGBA", "C": "VECTOR"}, A=noise.outputs[0], B=(0.7, 0.2, 0.1), C=noise)
        return separate(nodes, made, A="FLOAT", B="RGBA", C="VECTOR")[shown]

    return value


def _lacking(nodes):
    """An item that the bundle lacks, one of another type, and items in another order."""
    made = combine(nodes, {"A": "FLOAT", "B": "RGBA"}, A=noise_of(nodes), B=(0.7, 0.2, 0.1))
    found = separate(nodes, made, B="FLOAT", None_="RGBA", A="RGBA")
    mixed = nodes.add("ShaderNodeMixRGB", 0.3, found["A"], found["None_"]).outputs[0]
    return nodes.add("ShaderNodeMixRGB", 0.5, mixed, found["B"]).outputs[0]


def _no_bundle(nodes):
    return separate(nodes, None, A="RGBA")["A"]


def _in_bundle(nodes):
    """A bundle in a bundle, with a closure and a shader."""
    made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, squared)
    shine = nodes.add("ShaderNodeEmission", Color=(0.1, 0.4, 0.2))
    inner = combine(nodes, {"F": "CLOSURE", "S": "SHADER"}, F=made, S=shine)
    outer = combine(nodes, {"Inner": "BUNDLE"}, Inner=inner)
    found = separate(nodes, separate(nodes, outer, Inner="BUNDLE")["Inner"], F="CLOSURE", S="SHADER")
    node = evaluate(nodes, found["F"], {"X": "FLOAT"}, {"Y": "FLOAT"}, X=noise_of(nodes))
    own = nodes.add("ShaderNodeEmission", Color=node.outputs["Y"])
    return nodes.add("ShaderNodeAddShader", found["S"], own).outputs[0]


def _repeated_bundle(nodes):
    def body(nodes, inputs, iteration):
        found = separate(nodes, inputs["All"], A="FLOAT", B="FLOAT")
        step = math_of(nodes, "MULTIPLY", found["A"], 0.8)
        return {"All": combine(nodes, {"A": "FLOAT", "B": "FLOAT"}, A=step, B=math_of(nodes, "ADD", found["B"], step))}

    first, last = repeat(nodes, {"All": "BUNDLE"}, 3, body)
    nodes.link(combine(nodes, {"A": "FLOAT", "B": "FLOAT"}, A=noise_of(nodes), B=0.05), first.inputs["All"])
    return math_of(nodes, "MULTIPLY", separate(nodes, last.outputs["All"], B="FLOAT")["B"], 0.5)


_BUNDLES = [*(_bundled(name) for name in "ABC"), _lacking, _no_bundle, _in_bundle, _repeated_bundle]


@case(since=SINCE, size=size_of(len(_BUNDLES)), bounces=0, quick=True)
def bundles(scene):
    """Items of all types, missing, of another type, in another order; a bundle in a bundle and in a repeat zone."""
    show_all(scene, _BUNDLES)


def _joined(nodes):
    """Two bundles with an item in common."""
    first = combine(nodes, {"A": "FLOAT", "B": "FLOAT"}, A=0.3, B=noise_of(nodes))
    second = combine(nodes, {"B": "FLOAT", "C": "FLOAT"}, B=0.2, C=0.1)
    node = nodes.add("NodeJoinBundle")
    for made in (first, second):
        nodes.link(made, node.inputs[0])
    found = separate(nodes, node.outputs[0], A="FLOAT", B="FLOAT", C="FLOAT")
    return nodes.add("ShaderNodeCombineXYZ", *(found[name] for name in "ABC")).outputs[0]


def _listed(kind, chosen, shown=0):
    values = {"FLOAT": (0.2, 0.9), "RGBA": ((0.9, 0.1, 0.2, 1.0), None), "VECTOR": ((0.2, 0.3, 0.4), None), "INT": (1, 3)}

    def value(nodes):
        first, second = values[kind]
        node = menu(nodes, kind, chosen, first, noise_of(nodes).outputs["Color"] if second is None else second)
        return math_of(nodes, "MULTIPLY", node.outputs[shown], 0.3) if kind == "INT" or shown else node.outputs[0]

    return value


def _listed_shader(nodes):
    shaders = (nodes.add("ShaderNodeEmission", Color=color) for color in ((0.9, 0.1, 0.2), (0.1, 0.2, 0.9)))
    return menu(nodes, "SHADER", "B", *shaders).outputs[0]


def _in_group(build, items, **values):
    """The value of a group whose nodes build(nodes, inputs) makes."""

    def value(nodes):
        tree = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
        for name, kind in items.items():
            tree.interface.new_socket(name, in_out="INPUT", socket_type=kind)
        tree.interface.new_socket("Result", in_out="OUTPUT", socket_type="NodeSocketColor")
        inside = Nodes(tree)
        given = inside.add("NodeGroupInput")
        inside.link(build(inside, given.outputs), inside.add("NodeGroupOutput").inputs[0])
        node = nodes.add("ShaderNodeGroup", props={"node_tree": tree})
        for name, x in values.items():
            nodes.give(node.inputs[name], x(nodes) if callable(x) else x)
        return node.outputs[0]

    return value


def _group_of_menu(nodes, inputs):
    node = menu(nodes, "RGBA", "A", (0.9, 0.1, 0.2), noise_of(nodes).outputs["Color"], (0.2, 0.6, 0.1))
    nodes.link(inputs["Choice"], node.inputs[0])
    return node.outputs[0]


def _group_of_repetitions(nodes, inputs):
    def body(nodes, own, iteration):
        return {"V": math_of(nodes, "MULTIPLY_ADD", own["V"], 0.7, 0.1)}

    first, last = repeat(nodes, {"V": "FLOAT"}, inputs["Count"], body)
    nodes.link(noise_of(nodes).outputs[0], first.inputs["V"])
    return last.outputs["V"]


def _group_of_closure(nodes, inputs):
    return evaluate(nodes, inputs["F"], {"X": "FLOAT"}, {"Y": "FLOAT"}, X=noise_of(nodes)).outputs["Y"]


def _given_closure(nodes):
    return closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, squared)


_MENU, _INT, _CLOSURE = (f"NodeSocket{kind}" for kind in ("Menu", "Int", "Closure"))
_MENUS = [
    *(_listed(kind, chosen) for kind in KINDS for chosen in "AB"),
    *(_listed("FLOAT", "B", shown) for shown in (1, 2)),
    _listed_shader,
    *(_in_group(_group_of_menu, {"Choice": _MENU}, Choice=chosen) for chosen in "ABC"),
    *(_in_group(_group_of_repetitions, {"Count": _INT}, Count=count) for count in (0, 3, number_of(2.0))),
    _in_group(_group_of_closure, {"F": _CLOSURE}, F=_given_closure),
    _in_group(_group_of_closure, {"F": _CLOSURE}),
]


@case(since=SINCE, size=size_of(len(_MENUS)), bounces=0, quick=True)
def menus_and_groups(scene):
    """Menus of all types; menus, zones and closures in groups, chosen and given from outside."""
    show_all(scene, _MENUS)


def _constant(kind, **props):
    return lambda nodes: nodes.add(kind, props=props).outputs[0]


def _menu_of_node(nodes):
    node = menu(nodes, "RGBA", "A", (0.9, 0.1, 0.2), noise_of(nodes).outputs["Color"])
    source = nodes.add("FunctionNodeInputMenu")
    nodes.link(source, node.inputs[0])
    source.value = "B"
    return node.outputs[0]


def _time(output, factor):
    return lambda nodes: math_of(nodes, "MULTIPLY", nodes.add("GeometryNodeInputSceneTime").outputs[output], factor)


def _converted(nodes):
    return nodes.add("NodeImplicitConversion", noise_of(nodes).outputs["Color"], props={"data_type": "FLOAT"}).outputs[0]


def _flags(nodes):
    """A truth value through a zone, from a number."""

    def body(nodes, inputs, iteration):
        return {"B": inputs["B"]}

    first, last = repeat(nodes, {"B": "BOOLEAN"}, 1, body)
    nodes.link(noise_of(nodes).outputs[0], first.inputs["B"])
    return last.outputs["B"]


_NEWEST = [
    _joined,
    _menu_of_node,
    _constant("FunctionNodeInputBool", boolean=True),
    _constant("FunctionNodeInputVector", vector=(0.2, 0.4, -0.1)),
    lambda nodes: math_of(nodes, "MULTIPLY", nodes.add("FunctionNodeInputInt", props={"integer": 3}).outputs[0], 0.2),
    lambda nodes: nodes.add("NodeImplicitConversion", noise_of(nodes).outputs["Color"], props={"data_type": "FLOAT"}).outputs[
        0
    ],
    _time("Frame", 0.05),
    _time("Seconds", 1.3),
    _flags,
]


@case(since=(5, 2), size=size_of(len(_NEWEST)), bounces=0, quick=True)
def constants_and_joined_bundles(scene):
    """Joined bundles, menus, truth values, whole numbers and vectors of nodes; frame and time of the scene."""
    scene.frame_set(9)
    scene.render.fps, scene.render.fps_base = 30, 1.25
    show_all(scene, _NEWEST)
