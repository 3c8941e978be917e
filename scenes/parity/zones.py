"""Nodes that Blender resolves before Cycles reads a tree: repeat zones, closures, bundles and menus."""

import bpy

from .. import parts
from .boards import set_board, size_of, tile_mesh
from .catalogue import case
from .nodes import Nodes, material, world

_SINCE = (5, 0)
_KINDS = {"FLOAT": 0.3, "RGBA": (0.2, 0.5, 0.7, 1.0), "VECTOR": (0.1, 0.2, 0.6), "INT": 2}


def _math(nodes, operation, *values, **props):
    return nodes.add("ShaderNodeMath", *values, props={"operation": operation, **props}).outputs[0]


def _place(nodes):
    return nodes.add("ShaderNodeTexCoord").outputs["Generated"]


def _noise(nodes, scale=3.0):
    return nodes.add("ShaderNodeTexNoise", Vector=_place(nodes), Scale=scale, Detail=0.0)


# ---- the nodes ----


def repeat(nodes, items, iterations, body, muted=()):
    """Adds a zone of {name: type}; body(nodes, inputs by name, iteration) gives the outputs by name. Returns both nodes."""
    first, last = (nodes.add(f"GeometryNodeRepeat{end}") for end in ("Input", "Output"))
    first.pair_with_output(last)
    last.repeat_items.clear()
    for name, kind in items.items():
        last.repeat_items.new(kind, name)
    nodes.give(first.inputs["Iterations"], iterations)
    for name, output in body(nodes, first.outputs, first.outputs["Iteration"]).items():
        nodes.link(output, last.inputs[name])
    first.mute, last.mute = "first" in muted, "last" in muted
    return first, last


def closure(nodes, inputs, outputs, body):
    """Adds a zone whose body(nodes, inputs by name) gives the outputs by name; returns its socket."""
    first, last = nodes.add("NodeClosureInput"), nodes.add("NodeClosureOutput")
    first.pair_with_output(last)
    for items, wanted in ((last.input_items, inputs), (last.output_items, outputs)):
        items.clear()
        for name, kind in wanted.items():
            items.new(kind, name)
    for name, output in body(nodes, first.outputs).items():
        nodes.link(output, last.inputs[name])
    return last.outputs[0]


def evaluate(nodes, socket, inputs, outputs, **values):
    node = nodes.add("NodeEvaluateClosure")
    for items, wanted in ((node.input_items, inputs), (node.output_items, outputs)):
        items.clear()
        for name, kind in wanted.items():
            items.new(kind, name)
    if socket is not None:
        nodes.link(socket, node.inputs[0])
    for name, value in values.items():
        nodes.give(node.inputs[name], value)
    return node


def combine(nodes, items, **values):
    node = nodes.add("NodeCombineBundle")
    for name, kind in items.items():
        node.bundle_items.new(kind, name)
    for name, value in values.items():
        nodes.give(node.inputs[name], value)
    return node.outputs[0]


def separate(nodes, bundle, **items):
    node = nodes.add("NodeSeparateBundle")
    for name, kind in items.items():
        node.bundle_items.new(kind, name)
    if bundle is not None:
        nodes.link(bundle, node.inputs[0])
    return node.outputs


def menu(nodes, kind, chosen, *values):
    """Adds a Menu Switch of the values A, B and so on."""
    node = nodes.add("GeometryNodeMenuSwitch", props={"data_type": kind})
    for number, value in enumerate(values):
        if number >= len(node.enum_items):
            node.enum_items.new("ABCDE"[number])
        nodes.give(node.inputs[number + 1], value)
    nodes.give(node.inputs[0], chosen)
    return node


# ---- repeat zones ----


def _grown(iterations, start=0.1, **more):
    """A number that grows by a noise of its own size and by the number of the iteration."""

    def value(nodes):
        def body(nodes, inputs, iteration):
            bumps = _noise(nodes, _math(nodes, "MULTIPLY_ADD", inputs["Size"], 10.0, 1.0))
            step = _math(nodes, "MULTIPLY_ADD", iteration, 0.1, bumps.outputs[0])
            return {"Size": _math(nodes, "MULTIPLY_ADD", step, 0.2, inputs["Size"])}

        given = iterations(nodes) if callable(iterations) else iterations
        first, last = repeat(nodes, {"Size": "FLOAT"}, given, body, **more)
        nodes.give(first.inputs["Size"], start)
        return last.outputs["Size"]

    return value


def _number(x):
    def value(nodes):
        node = nodes.add("ShaderNodeValue")
        node.outputs[0].default_value = x
        return _math(nodes, "MULTIPLY", node.outputs[0], 1.0)

    return value


def _backfacing(nodes):
    return nodes.add("ShaderNodeNewGeometry").outputs["Backfacing"]


def _passed(kind, shown, count):
    """A value of one type through a zone that changes it by one of another type."""

    def value(nodes):
        def body(nodes, inputs, iteration):
            return {"A": inputs["B"], "B": inputs["A"]}

        first, last = repeat(nodes, {"A": kind, "B": shown}, count, body)
        nodes.give(first.inputs["A"], _KINDS[kind] if count else _noise(nodes).outputs["Color"])
        nodes.give(first.inputs["B"], _noise(nodes).outputs["Color"])
        return last.outputs["B"] if shown != "INT" else _math(nodes, "MULTIPLY", last.outputs["B"], 0.3)

    return value


def _nested(nodes):
    """Zones inside a zone; the number of the inner iterations is that of the outer one."""

    def inner(nodes, inputs, iteration):
        return {"X": _math(nodes, "MULTIPLY_ADD", inputs["X"], 0.8, 0.1)}

    def outer(nodes, inputs, iteration):
        first, last = repeat(nodes, {"X": "FLOAT"}, iteration, inner)
        nodes.link(inputs["Y"], first.inputs["X"])
        return {"Y": last.outputs["X"]}

    first, last = repeat(nodes, {"Y": "FLOAT"}, 4, outer)
    nodes.link(_noise(nodes).outputs[0], first.inputs["Y"])
    return last.outputs["Y"]


def _layers(nodes):
    """Shaders added and mixed, layer by layer."""

    def body(nodes, inputs, iteration):
        fraction = _math(nodes, "MULTIPLY", iteration, 0.25)
        color = nodes.add("ShaderNodeCombineXYZ", fraction, 0.5, _noise(nodes).outputs[0])
        own = nodes.add("ShaderNodeEmission", Color=color.outputs[0])
        return {"Layers": nodes.add("ShaderNodeMixShader", 0.4, inputs["Layers"], own).outputs[0]}

    first, last = repeat(nodes, {"Layers": "SHADER"}, 4, body)
    nodes.link(nodes.add("ShaderNodeEmission", Color=(0.9, 0.1, 0.1)), first.inputs["Layers"])
    return last.outputs["Layers"]


def _unlinked_shader(nodes):
    first, last = repeat(nodes, {"Layers": "SHADER"}, 0, lambda nodes, inputs, iteration: {"Layers": inputs["Layers"]})
    shine = nodes.add("ShaderNodeEmission", Color=(0.9, 0.1, 0.1))
    return nodes.add("ShaderNodeAddShader", shine, last.outputs["Layers"]).outputs[0]


def _turned(nodes):
    """A normal of constant direction and a normal of a link, both through zones."""

    def body(nodes, inputs, iteration):
        return {"N": inputs["N"], "M": inputs["M"]}

    first, last = repeat(nodes, {"N": "VECTOR", "M": "VECTOR"}, 1, body)
    nodes.give(first.inputs["N"], (0.5, 0.0, 0.8))
    nodes.link(nodes.add("ShaderNodeNewGeometry").outputs["Normal"], first.inputs["M"])
    fresnels = [nodes.add("ShaderNodeFresnel", IOR=1.8, Normal=last.outputs[name]).outputs[0] for name in "NM"]
    return _math(nodes, "ADD", *fresnels)


_REPEATED = [
    *(_grown(count) for count in (0, 1, 5, -3)),
    *(_grown(_number(x)) for x in (2.0, 2.6, -1.0)),
    _grown(_backfacing),
    *(_grown(2, muted=muted) for muted in (("first",), ("last",), ("first", "last"))),
    *(_passed(kind, shown, count) for kind in _KINDS for shown in _KINDS if kind != shown for count in (0, 1, 2)),
    _nested,
    _layers,
    _unlinked_shader,
    _turned,
]


def _board(scene, values):
    mesh = tile_mesh()
    set_board(scene, [(mesh, value) for value in values])


@case(since=_SINCE, size=size_of(len(_REPEATED)), bounces=0, quick=True)
def repeat_zones(scene):
    """Iterations constant, 0, negative, linked and varying; muted zones; zones in zones; all types, and their conversions."""
    _board(scene, _REPEATED)


# ---- closures ----


def _squared(nodes, inputs):
    return {"Y": _math(nodes, "MULTIPLY", inputs["X"], inputs["X"])}


def _once(nodes):
    made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, _squared)
    return evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=_noise(nodes)).outputs["Y"]


def _twice(nodes):
    """One closure at two nodes, with different inputs."""
    made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, _squared)
    numbers = [evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=x).outputs["Y"] for x in (0.5, _noise(nodes).outputs[0])]
    return _math(nodes, "ADD", *numbers)


def _missing(nodes):
    node = evaluate(nodes, None, {"X": "FLOAT"}, {"Y": "FLOAT", "Z": "RGBA"}, X=0.4)
    return _math(nodes, "ADD", node.outputs["Y"], 0.25)


def _missing_color(nodes):
    return evaluate(nodes, None, {"X": "FLOAT"}, {"Y": "FLOAT", "Z": "RGBA"}, X=0.4).outputs["Z"]


def _other_items(nodes):
    """Inputs and outputs that only one side has, and of other types."""
    made = closure(
        nodes,
        {"X": "FLOAT", "Alone": "FLOAT"},
        {"Y": "FLOAT"},
        lambda nodes, inputs: {"Y": _math(nodes, "ADD", inputs["X"], inputs["Alone"])},
    )
    node = evaluate(
        nodes, made, {"X": "RGBA", "More": "FLOAT"}, {"Y": "RGBA", "None": "FLOAT"}, X=_noise(nodes).outputs["Color"]
    )
    return nodes.add("ShaderNodeMixRGB", 0.3, node.outputs["Y"], node.outputs["None"]).outputs[0]


def _captured(nodes):
    """A value from outside the zone."""
    bumps = _noise(nodes).outputs[0]
    made = closure(
        nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, lambda nodes, inputs: {"Y": _math(nodes, "MULTIPLY", inputs["X"], bumps)}
    )
    return evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=0.7).outputs["Y"]


def _chosen(nodes):
    """A closure chosen by a menu, evaluated in a repeat zone."""
    first = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, _squared)
    second = closure(
        nodes,
        {"X": "FLOAT"},
        {"Y": "FLOAT"},
        lambda nodes, inputs: {"Y": _math(nodes, "MULTIPLY_ADD", inputs["X"], 0.5, 0.2)},
    )
    made = menu(nodes, "CLOSURE", "B", first, second).outputs[0]

    def body(nodes, inputs, iteration):
        return {"V": evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=inputs["V"]).outputs["Y"]}

    start, end = repeat(nodes, {"V": "FLOAT"}, 3, body)
    nodes.link(_noise(nodes).outputs[0], start.inputs["V"])
    return end.outputs["V"]


def _handed(nodes):
    """A closure that evaluates another one, given as its input."""
    inner = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, _squared)

    def body(nodes, inputs):
        return {"Y": evaluate(nodes, inputs["F"], {"X": "FLOAT"}, {"Y": "FLOAT"}, X=inputs["X"]).outputs["Y"]}

    outer = closure(nodes, {"F": "CLOSURE", "X": "FLOAT"}, {"Y": "FLOAT"}, body)
    return evaluate(nodes, outer, {"F": "CLOSURE", "X": "FLOAT"}, {"Y": "FLOAT"}, F=inner, X=_noise(nodes)).outputs["Y"]


def _shading(nodes):
    made = closure(
        nodes,
        {"Tint": "RGBA"},
        {"Surface": "SHADER"},
        lambda nodes, inputs: {"Surface": nodes.add("ShaderNodeEmission", Color=inputs["Tint"]).outputs[0]},
    )
    node = evaluate(nodes, made, {"Tint": "RGBA"}, {"Surface": "SHADER"}, Tint=_noise(nodes).outputs["Color"])
    return node.outputs["Surface"]


def _muted_evaluation(nodes):
    made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, _squared)
    node = evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=_noise(nodes))
    node.mute = True
    return node.outputs["Y"]


_CLOSURES = [
    _once, _twice, _missing, _missing_color, _other_items, _captured, _chosen, _handed, _shading, _muted_evaluation,
]  # fmt: skip


@case(since=_SINCE, size=size_of(len(_CLOSURES)), bounces=0, quick=True)
def closure_zones(scene):
    """Closures once and twice, missing, with other items, with values from outside, chosen, handed on, muted."""
    _board(scene, _CLOSURES)


# ---- bundles and menus ----


def _bundled(shown):
    def value(nodes):
        noise = _noise(nodes)
        made = combine(nodes, {"A": "FLOAT", "B": "RGBA", "C": "VECTOR"}, A=noise.outputs[0], B=(0.7, 0.2, 0.1), C=noise)
        return separate(nodes, made, A="FLOAT", B="RGBA", C="VECTOR")[shown]

    return value


def _lacking(nodes):
    """An item that the bundle lacks, one of another type, and items in another order."""
    made = combine(nodes, {"A": "FLOAT", "B": "RGBA"}, A=_noise(nodes), B=(0.7, 0.2, 0.1))
    found = separate(nodes, made, B="FLOAT", None_="RGBA", A="RGBA")
    mixed = nodes.add("ShaderNodeMixRGB", 0.3, found["A"], found["None_"]).outputs[0]
    return nodes.add("ShaderNodeMixRGB", 0.5, mixed, found["B"]).outputs[0]


def _no_bundle(nodes):
    return separate(nodes, None, A="RGBA")["A"]


def _in_bundle(nodes):
    """A bundle in a bundle, with a closure and a shader."""
    made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, _squared)
    shine = nodes.add("ShaderNodeEmission", Color=(0.1, 0.4, 0.2))
    inner = combine(nodes, {"F": "CLOSURE", "S": "SHADER"}, F=made, S=shine)
    outer = combine(nodes, {"Inner": "BUNDLE"}, Inner=inner)
    found = separate(nodes, separate(nodes, outer, Inner="BUNDLE")["Inner"], F="CLOSURE", S="SHADER")
    node = evaluate(nodes, found["F"], {"X": "FLOAT"}, {"Y": "FLOAT"}, X=_noise(nodes))
    own = nodes.add("ShaderNodeEmission", Color=node.outputs["Y"])
    return nodes.add("ShaderNodeAddShader", found["S"], own).outputs[0]


def _repeated_bundle(nodes):
    def body(nodes, inputs, iteration):
        found = separate(nodes, inputs["All"], A="FLOAT", B="FLOAT")
        step = _math(nodes, "MULTIPLY", found["A"], 0.8)
        return {"All": combine(nodes, {"A": "FLOAT", "B": "FLOAT"}, A=step, B=_math(nodes, "ADD", found["B"], step))}

    first, last = repeat(nodes, {"All": "BUNDLE"}, 3, body)
    nodes.link(combine(nodes, {"A": "FLOAT", "B": "FLOAT"}, A=_noise(nodes), B=0.05), first.inputs["All"])
    return _math(nodes, "MULTIPLY", separate(nodes, last.outputs["All"], B="FLOAT")["B"], 0.5)


_BUNDLES = [*(_bundled(name) for name in "ABC"), _lacking, _no_bundle, _in_bundle, _repeated_bundle]


@case(since=_SINCE, size=size_of(len(_BUNDLES)), bounces=0, quick=True)
def bundles(scene):
    """Items of all types, missing, of another type, in another order; a bundle in a bundle and in a repeat zone."""
    _board(scene, _BUNDLES)


def _joined(nodes):
    """Two bundles with an item in common."""
    first = combine(nodes, {"A": "FLOAT", "B": "FLOAT"}, A=0.3, B=_noise(nodes))
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
        node = menu(nodes, kind, chosen, first, _noise(nodes).outputs["Color"] if second is None else second)
        return _math(nodes, "MULTIPLY", node.outputs[shown], 0.3) if kind == "INT" or shown else node.outputs[0]

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
    node = menu(nodes, "RGBA", "A", (0.9, 0.1, 0.2), _noise(nodes).outputs["Color"], (0.2, 0.6, 0.1))
    nodes.link(inputs["Choice"], node.inputs[0])
    return node.outputs[0]


def _group_of_repetitions(nodes, inputs):
    def body(nodes, own, iteration):
        return {"V": _math(nodes, "MULTIPLY_ADD", own["V"], 0.7, 0.1)}

    first, last = repeat(nodes, {"V": "FLOAT"}, inputs["Count"], body)
    nodes.link(_noise(nodes).outputs[0], first.inputs["V"])
    return last.outputs["V"]


def _group_of_closure(nodes, inputs):
    return evaluate(nodes, inputs["F"], {"X": "FLOAT"}, {"Y": "FLOAT"}, X=_noise(nodes)).outputs["Y"]


def _given_closure(nodes):
    return closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, _squared)


_MENU, _INT, _CLOSURE = (f"NodeSocket{kind}" for kind in ("Menu", "Int", "Closure"))
_MENUS = [
    *(_listed(kind, chosen) for kind in _KINDS for chosen in "AB"),
    *(_listed("FLOAT", "B", shown) for shown in (1, 2)),
    _listed_shader,
    *(_in_group(_group_of_menu, {"Choice": _MENU}, Choice=chosen) for chosen in "ABC"),
    *(_in_group(_group_of_repetitions, {"Count": _INT}, Count=count) for count in (0, 3, _number(2.0))),
    _in_group(_group_of_closure, {"F": _CLOSURE}, F=_given_closure),
    _in_group(_group_of_closure, {"F": _CLOSURE}),
]


@case(since=_SINCE, size=size_of(len(_MENUS)), bounces=0, quick=True)
def menus_and_groups(scene):
    """Menus of all types; menus, zones and closures in groups, chosen and given from outside."""
    _board(scene, _MENUS)


def _constant(kind, **props):
    return lambda nodes: nodes.add(kind, props=props).outputs[0]


def _menu_of_node(nodes):
    node = menu(nodes, "RGBA", "A", (0.9, 0.1, 0.2), _noise(nodes).outputs["Color"])
    source = nodes.add("FunctionNodeInputMenu")
    nodes.link(source, node.inputs[0])
    source.value = "B"
    return node.outputs[0]


def _time(output, factor):
    return lambda nodes: _math(nodes, "MULTIPLY", nodes.add("GeometryNodeInputSceneTime").outputs[output], factor)


def _flags(nodes):
    """A truth value through a zone, from a number."""

    def body(nodes, inputs, iteration):
        return {"B": inputs["B"]}

    first, last = repeat(nodes, {"B": "BOOLEAN"}, 1, body)
    nodes.link(_noise(nodes).outputs[0], first.inputs["B"])
    return last.outputs["B"]


_NEWEST = [
    _joined,
    _menu_of_node,
    _constant("FunctionNodeInputBool", boolean=True),
    _constant("FunctionNodeInputVector", vector=(0.2, 0.4, -0.1)),
    lambda nodes: _math(nodes, "MULTIPLY", nodes.add("FunctionNodeInputInt", props={"integer": 3}).outputs[0], 0.2),
    lambda nodes: nodes.add("NodeImplicitConversion", _noise(nodes).outputs["Color"], props={"data_type": "FLOAT"}).outputs[0],
    _time("Frame", 0.05),
    _time("Seconds", 1.3),
    _flags,
]


@case(since=(5, 2), size=size_of(len(_NEWEST)), bounces=0, quick=True)
def constants_and_joined_bundles(scene):
    """Joined bundles, menus, truth values, whole numbers and vectors of nodes; frame and time of the scene."""
    scene.frame_set(9)
    scene.render.fps, scene.render.fps_base = 30, 1.25
    _board(scene, _NEWEST)


# ---- worlds, lamps, displacement ----


@case("LOBES", since=_SINCE, size=(64, 48))
def zones_of_world_and_lamp(scene):
    """A sky and a lamp by zones, and a relief whose layers a zone adds."""

    def layers(nodes):
        def body(nodes, inputs, iteration):
            scale = _math(nodes, "MULTIPLY_ADD", iteration, 4.0, 3.0)
            return {"H": _math(nodes, "MULTIPLY_ADD", _noise(nodes, scale).outputs[0], 0.2, inputs["H"])}

        last = repeat(nodes, {"H": "FLOAT"}, 3, body)[1]
        relief = nodes.add("ShaderNodeBump", Height=last.outputs["H"], Strength=0.5)
        return nodes.add("ShaderNodeBsdfDiffuse", Normal=relief.outputs[0])

    def sky(nodes):
        direction = nodes.add("ShaderNodeSeparateXYZ", _place(nodes)).outputs["Z"]
        made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, _squared)
        node = evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=direction)
        return nodes.add("ShaderNodeBackground", Color=node.outputs["Y"], Strength=menu(nodes, "FLOAT", "B", 1.0, 0.4))

    parts.place(scene, "Floor", parts.plane_mesh("Floor", 4.0), material(layers))
    world(scene, sky)
    lamp = parts.add_light(scene, "Lamp", "POINT", 60.0, (1.0, -1.0, 2.0))
    lamp.data.use_nodes = True
    nodes = Nodes(parts.enable_nodes(lamp.data))
    strength = repeat(
        nodes, {"P": "FLOAT"}, 3, lambda nodes, inputs, iteration: {"P": _math(nodes, "ADD", inputs["P"], iteration)}
    )[1]
    nodes.link(
        nodes.add("ShaderNodeEmission", Color=(1.0, 0.7, 0.4), Strength=strength.outputs["P"]),
        nodes.add("ShaderNodeOutputLight").inputs["Surface"],
    )
    parts.add_camera(scene, (3.0, -5.0, 3.0), (0.0, 0.0, 0.0))
