"""Zones, closures, bundles and menus under construction, for the scenes that compare them."""

from .boards import set_board, tile_mesh

SINCE = (5, 0)
KINDS = {"FLOAT": 0.3, "RGBA": (0.2, 0.5, 0.7, 1.0), "VECTOR": (0.1, 0.2, 0.6), "INT": 2}


def math_of(nodes, operation, *values, **props):
    return nodes.add("ShaderNodeMath", *values, props={"operation": operation, **props}).outputs[0]


def place(nodes):
    return nodes.add("ShaderNodeTexCoord").outputs["Generated"]


def noise_of(nodes, scale=3.0):
    return nodes.add("ShaderNodeTexNoise", Vector=place(nodes), Scale=scale, Detail=0.0)


def number_of(x):
    def value(nodes):
        node = nodes.add("ShaderNodeValue")
        node.outputs[0].default_value = x
        return math_of(nodes, "MULTIPLY", node.outputs[0], 1.0)

    return value


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


def squared(nodes, inputs):
    return {"Y": math_of(nodes, "MULTIPLY", inputs["X"], inputs["X"])}


def show_all(scene, values):
    mesh = tile_mesh()
    set_board(scene, [(mesh, value) for value in values])
