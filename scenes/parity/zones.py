"""Nodes that Blender resolves before Cycles reads a tree: repeat zones and closures."""

from .. import parts
from .boards import size_of
from .catalogue import case
from .nodes import Nodes, material, world
from .zone_nodes import KINDS, SINCE, closure, evaluate, math_of, menu, noise_of, number_of, place, repeat, show_all, squared


def _grown(iterations, start=0.1, **more):
    """A number that grows by a noise of its own size and by the number of the iteration."""

    def value(nodes):
        def body(nodes, inputs, iteration):
            bumps = noise_of(nodes, math_of(nodes, "MULTIPLY_ADD", inputs["Size"], 10.0, 1.0))
            step = math_of(nodes, "MULTIPLY_ADD", iteration, 0.1, bumps.outputs[0])
            return {"Size": math_of(nodes, "MULTIPLY_ADD", step, 0.2, inputs["Size"])}

        given = iterations(nodes) if callable(iterations) else iterations
        first, last = repeat(nodes, {"Size": "FLOAT"}, given, body, **more)
        nodes.give(first.inputs["Size"], start)
        return last.outputs["Size"]

    return value


def _backfacing(nodes):
    return nodes.add("ShaderNodeNewGeometry").outputs["Backfacing"]


def _passed(kind, shown, count):
    """A value of one type through a zone that changes it by one of another type."""

    def value(nodes):
        def body(nodes, inputs, iteration):
            return {"A": inputs["B"], "B": inputs["A"]}

        first, last = repeat(nodes, {"A": kind, "B": shown}, count, body)
        nodes.give(first.inputs["A"], KINDS[kind] if count else noise_of(nodes).outputs["Color"])
        nodes.give(first.inputs["B"], noise_of(nodes).outputs["Color"])
        return last.outputs["B"] if shown != "INT" else math_of(nodes, "MULTIPLY", last.outputs["B"], 0.3)

    return value


def _nested(nodes):
    """Zones inside a zone; the number of the inner iterations is that of the outer one."""

    def inner(nodes, inputs, iteration):
        return {"X": math_of(nodes, "MULTIPLY_ADD", inputs["X"], 0.8, 0.1)}

    def outer(nodes, inputs, iteration):
        first, last = repeat(nodes, {"X": "FLOAT"}, iteration, inner)
        nodes.link(inputs["Y"], first.inputs["X"])
        return {"Y": last.outputs["X"]}

    first, last = repeat(nodes, {"Y": "FLOAT"}, 4, outer)
    nodes.link(noise_of(nodes).outputs[0], first.inputs["Y"])
    return last.outputs["Y"]


def _layers(nodes):
    """Shaders added and mixed, layer by layer."""

    def body(nodes, inputs, iteration):
        fraction = math_of(nodes, "MULTIPLY", iteration, 0.25)
        color = nodes.add("ShaderNodeCombineXYZ", fraction, 0.5, noise_of(nodes).outputs[0])
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
    return math_of(nodes, "ADD", *fresnels)


_REPEATED = [
    *(_grown(count) for count in (0, 1, 5, -3)),
    *(_grown(number_of(x)) for x in (2.0, 2.6, -1.0)),
    _grown(_backfacing),
    *(_grown(2, muted=muted) for muted in (("first",), ("last",), ("first", "last"))),
    *(_passed(kind, shown, count) for kind in KINDS for shown in KINDS if kind != shown for count in (0, 1, 2)),
    _nested,
    _layers,
    _unlinked_shader,
    _turned,
]


@case(since=SINCE, size=size_of(len(_REPEATED)), bounces=0, quick=True)
def repeat_zones(scene):
    """Iterations constant, 0, negative, linked and varying; muted zones; zones in zones; all types, and their conversions."""
    show_all(scene, _REPEATED)


def _once(nodes):
    made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, squared)
    return evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=noise_of(nodes)).outputs["Y"]


def _twice(nodes):
    """One closure at two nodes, with different inputs."""
    made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, squared)
    numbers = [
        evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=x).outputs["Y"] for x in (0.5, noise_of(nodes).outputs[0])
    ]
    return math_of(nodes, "ADD", *numbers)


def _missing(nodes):
    node = evaluate(nodes, None, {"X": "FLOAT"}, {"Y": "FLOAT", "Z": "RGBA"}, X=0.4)
    return math_of(nodes, "ADD", node.outputs["Y"], 0.25)


def _missing_color(nodes):
    return evaluate(nodes, None, {"X": "FLOAT"}, {"Y": "FLOAT", "Z": "RGBA"}, X=0.4).outputs["Z"]


def _other_items(nodes):
    """Inputs and outputs that only one side has, and of other types."""
    made = closure(
        nodes,
        {"X": "FLOAT", "Alone": "FLOAT"},
        {"Y": "FLOAT"},
        lambda nodes, inputs: {"Y": math_of(nodes, "ADD", inputs["X"], inputs["Alone"])},
    )
    node = evaluate(
        nodes, made, {"X": "RGBA", "More": "FLOAT"}, {"Y": "RGBA", "None": "FLOAT"}, X=noise_of(nodes).outputs["Color"]
    )
    return nodes.add("ShaderNodeMixRGB", 0.3, node.outputs["Y"], node.outputs["None"]).outputs[0]


def _captured(nodes):
    """A value from outside the zone."""
    bumps = noise_of(nodes).outputs[0]
    made = closure(
        nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, lambda nodes, inputs: {"Y": math_of(nodes, "MULTIPLY", inputs["X"], bumps)}
    )
    return evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=0.7).outputs["Y"]


def _chosen(nodes):
    """A closure chosen by a menu, evaluated in a repeat zone."""
    first = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, squared)
    second = closure(
        nodes,
        {"X": "FLOAT"},
        {"Y": "FLOAT"},
        lambda nodes, inputs: {"Y": math_of(nodes, "MULTIPLY_ADD", inputs["X"], 0.5, 0.2)},
    )
    made = menu(nodes, "CLOSURE", "B", first, second).outputs[0]

    def body(nodes, inputs, iteration):
        return {"V": evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=inputs["V"]).outputs["Y"]}

    start, end = repeat(nodes, {"V": "FLOAT"}, 3, body)
    nodes.link(noise_of(nodes).outputs[0], start.inputs["V"])
    return end.outputs["V"]


def _handed(nodes):
    """A closure that evaluates another one, given as its input."""
    inner = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, squared)

    def body(nodes, inputs):
        return {"Y": evaluate(nodes, inputs["F"], {"X": "FLOAT"}, {"Y": "FLOAT"}, X=inputs["X"]).outputs["Y"]}

    outer = closure(nodes, {"F": "CLOSURE", "X": "FLOAT"}, {"Y": "FLOAT"}, body)
    return evaluate(nodes, outer, {"F": "CLOSURE", "X": "FLOAT"}, {"Y": "FLOAT"}, F=inner, X=noise_of(nodes)).outputs["Y"]


def _shading(nodes):
    made = closure(
        nodes,
        {"Tint": "RGBA"},
        {"Surface": "SHADER"},
        lambda nodes, inputs: {"Surface": nodes.add("ShaderNodeEmission", Color=inputs["Tint"]).outputs[0]},
    )
    node = evaluate(nodes, made, {"Tint": "RGBA"}, {"Surface": "SHADER"}, Tint=noise_of(nodes).outputs["Color"])
    return node.outputs["Surface"]


def _muted_evaluation(nodes):
    made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, squared)
    node = evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=noise_of(nodes))
    node.mute = True
    return node.outputs["Y"]


_CLOSURES = [
    _once, _twice, _missing, _missing_color, _other_items, _captured, _chosen, _handed, _shading, _muted_evaluation,
]  # fmt: skip


@case(since=SINCE, size=size_of(len(_CLOSURES)), bounces=0, quick=True)
def closure_zones(scene):
    """Closures once and twice, missing, with other items, with values from outside, chosen, handed on, muted."""
    show_all(scene, _CLOSURES)


@case("LOBES", since=SINCE, size=(64, 48))
def zones_of_world_and_lamp(scene):
    """A sky and a lamp by zones, and a relief whose layers a zone adds."""

    def layers(nodes):
        def body(nodes, inputs, iteration):
            scale = math_of(nodes, "MULTIPLY_ADD", iteration, 4.0, 3.0)
            return {"H": math_of(nodes, "MULTIPLY_ADD", noise_of(nodes, scale).outputs[0], 0.2, inputs["H"])}

        last = repeat(nodes, {"H": "FLOAT"}, 3, body)[1]
        relief = nodes.add("ShaderNodeBump", Height=last.outputs["H"], Strength=0.5)
        return nodes.add("ShaderNodeBsdfDiffuse", Normal=relief.outputs[0])

    def sky(nodes):
        direction = nodes.add("ShaderNodeSeparateXYZ", place(nodes)).outputs["Z"]
        made = closure(nodes, {"X": "FLOAT"}, {"Y": "FLOAT"}, squared)
        node = evaluate(nodes, made, {"X": "FLOAT"}, {"Y": "FLOAT"}, X=direction)
        return nodes.add("ShaderNodeBackground", Color=node.outputs["Y"], Strength=menu(nodes, "FLOAT", "B", 1.0, 0.4))

    parts.place(scene, "Floor", parts.plane_mesh("Floor", 4.0), material(layers))
    world(scene, sky)
    lamp = parts.add_light(scene, "Lamp", "POINT", 60.0, (1.0, -1.0, 2.0))
    lamp.data.use_nodes = True
    nodes = Nodes(parts.enable_nodes(lamp.data))
    strength = repeat(
        nodes, {"P": "FLOAT"}, 3, lambda nodes, inputs, iteration: {"P": math_of(nodes, "ADD", inputs["P"], iteration)}
    )[1]
    nodes.link(
        nodes.add("ShaderNodeEmission", Color=(1.0, 0.7, 0.4), Strength=strength.outputs["P"]),
        nodes.add("ShaderNodeOutputLight").inputs["Surface"],
    )
    parts.add_camera(scene, (3.0, -5.0, 3.0), (0.0, 0.0, 0.0))
