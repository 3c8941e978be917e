"""Random programs of nodes, read with and without folding: the core gives the same values for both."""

import itertools
import random

import bpy
import numpy as np
import stage
from export_cases import export
from material_cases import Tree

from addon.bindings.enums import Coordinate, MathOperation, MixMode, NodeKind, VectorOperation
from addon.bindings.session import Scene
from addon.bindings.shading import Material, NodeRef
from addon.bindings.snapshot import SceneSnapshot
from addon.export import cycles_folds, node_builder
from addon.export.describe import describe_material
from addon.messages.messages import Messages
from addon.ui.node_use import use_of

# Constants of which operations often are neutral.
_CONSTANTS = (0.0, -0.0, 1.0, 1.0, -1.0, 0.5)
_RULES = ("of_math", "of_vector_math", "first_of_mix", "of_mix")
_UV = np.concatenate([np.random.default_rng(1).uniform(-2, 2, (40, 2)), [(0, 0), (-0.0, 1), (1, 1), (-1, -0.0)]])


class _Plain(node_builder.NodeBuilder):
    """Adds every node that is not constant."""

    def emit(self, *inputs, **fields):
        # A scope without earlier nodes shares none.
        self._scopes[-1].numbers.clear()
        return super().emit(*inputs, **fields)


def _program(build, rng):
    """Return the values of 40 random operations. Each reads earlier ones or a constant."""
    uv = build.emit(NodeKind.COORDINATE, option=Coordinate.UV)
    large = build.op(MathOperation.MULTIPLY, build.component(uv, 0), 3e38)
    numbers, vectors = [build.component(uv, 1), large, build.op(MathOperation.MULTIPLY, large, 8.0)], [uv]
    for _ in range(40):
        some = [rng.choice(numbers) if rng.random() < 0.6 else rng.choice(_CONSTANTS) for _ in range(3)]
        wide = [rng.choice(vectors) if rng.random() < 0.6 else (rng.choice(_CONSTANTS),) * 3 for _ in range(3)]
        if rng.random() < 0.2:
            some[1], wide[1] = some[0], wide[0]
        if rng.random() < 0.5:
            made = _number(build, rng, some, wide)
            numbers.append(made if isinstance(made, (NodeRef, float)) else made[0])
        else:
            made = _vector(build, rng, some, wide)
            vectors.append(made if isinstance(made, (NodeRef, tuple)) else (made,) * 3)
    return numbers + vectors


def _number(build, rng, some, wide):
    which = rng.random()
    if which < 0.6:
        return build.op(rng.choice(list(MathOperation)), *some, clamped=rng.random() < 0.2)
    if which < 0.8:
        return build.component(rng.choice((*wide, *some)), rng.randrange(3))
    return build.emit(NodeKind.CLAMP, some[0], rng.choice((0.0, -0.0)), 1.0)


def _vector(build, rng, some, wide):
    which = rng.random()
    if which < 0.6:
        return build.vector_op(rng.choice(list(VectorOperation)), *wide, scale=some[0])
    if which < 0.7:
        return build.emit(NodeKind.GAMMA, wide[0], some[0])
    parts = [build.component(wide[0], axis) for axis in range(3)]
    return build.combine(*rng.choice((some, parts, some[:1] * 3)))


def _values(nodes, values):
    """Yield the results of values, (places, 3) each."""
    with Scene.upload(SceneSnapshot(materials=(Material(name="m", nodes=nodes),))) as scene:
        for value in values:
            if isinstance(value, NodeRef):
                yield scene.node(0, value.node, _UV)[:, :3]
            else:
                yield np.broadcast_to(np.float32(value), (len(_UV), 3))


def _bits(values):
    """Return the bits of floats; those of a NaN do not count."""
    values = np.array(values, np.float32)
    values[np.isnan(values)] = np.nan
    return values.view(np.uint32)


def _pairs(rules):
    """Yield the values of each rule of cycles_folds, by its arguments, and those of the node in its place."""
    build = node_builder.NodeBuilder("both", Messages(), None, "mid-grey")
    uv = build.emit(NodeKind.COORDINATE, option=Coordinate.UV)
    number, zero, one = build.component(uv, 0), 0.0, 1.0
    pairs = []
    for options in itertools.product((zero, one), repeat=2):
        for a, b in ((number, options[0]), (options[0], number)):
            for operation in MathOperation:
                pairs.append((rules.of_math(operation, a, b), lambda o=operation, x=(a, b): build.op(o, *x)))
        for a, b in ((uv, (options[0],) * 3), ((options[0],) * 3, uv)):
            for operation in VectorOperation:
                kept = rules.of_vector_math(operation, a, b, options[1])
                pairs.append((kept, lambda o=operation, x=(a, b), s=options[1]: build.vector_op(o, *x, scale=s)))
            for mode in MixMode:
                kept = rules.of_mix(mode, options[1], a, b)
                pairs.append((kept, lambda o=mode, x=(options[1], a, b): build.emit(NodeKind.MIX, *x, option=o)))
    return build, [(kept, make()) for kept, make in pairs if kept is not None]


def as_cycles():
    """Return how many nodes Cycles' rules leave out of those with one constant input, and how many then give another number."""
    neutral = node_builder.neutral
    node_builder.neutral = lambda node, nodes: None
    try:
        build, pairs = _pairs(cycles_folds)
    finally:
        node_builder.neutral = neutral
    kept, made = (list(_values(build.nodes, values)) for values in zip(*pairs, strict=True))
    # Zeros of both signs are equal.
    return {"rules": len(pairs), "differ": [i for i, (a, b) in enumerate(zip(kept, made, strict=True)) if (a != b).any()]}


def programs(count):
    """Return how many results of programs differ in a bit between folded and plain ones, and the numbers of their nodes."""
    result = {"differ": [], "plain": 0, "folded": 0, "not finite": 0}
    for seed in range(int(count)):
        built, found, told = [], [], 0
        for kind in (_Plain, node_builder.NodeBuilder):
            neutral = node_builder.neutral
            if kind is _Plain:
                node_builder.neutral = lambda node, nodes: None
            try:
                build = kind("random", Messages(), None, "mid-grey")
                values = _program(build, random.Random(seed))
            finally:
                node_builder.neutral = neutral
            # A constant that is not finite becomes 0, with a message, if no node is left for it.
            told += len(build.messages)
            built.append(build.nodes)
            found.append(list(_values(build.nodes, values)))
        if told:
            continue
        result["plain"] += len(built[0])
        result["folded"] += len(built[1])
        for number, (plain, folded) in enumerate(zip(*found, strict=True)):
            result["not finite"] += int(not np.isfinite(plain).all())
            if (_bits(plain) != _bits(folded)).any():
                result["differ"].append((seed, number))
    return result


def sixty():
    """Return what the panel tells of the material of 60 nodes, and the numbers of nodes with and without folding."""
    import scenes

    scene = scenes.load("sixty_nodes")
    material = bpy.data.materials["Sixty nodes"]
    use = use_of(material.node_tree, describe_material(material).exported)
    scene.render.engine = "LANCER"
    folded = export()
    neutral, rules = node_builder.neutral, [(name, getattr(cycles_folds, name)) for name in _RULES]
    node_builder.neutral = lambda node, nodes: None
    for name, _ in rules:
        setattr(cycles_folds, name, lambda *arguments: None)
    try:
        plain = export()
    finally:
        node_builder.neutral = neutral
        for name, rule in rules:
            setattr(cycles_folds, name, rule)
    number = [m.name for m in folded.materials].index(material.name)
    return {
        "total": use.total,
        "left": use.left,
        "first": use.costs[0][0],
        "nodes": [len(snapshot.materials[number].nodes) for snapshot in (plain, folded)],
    }


def groups():
    """Return the use of a material whose group has a varying and a constant node, and is used twice."""
    stage.empty()
    tree = Tree("grouped")
    inside = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
    kept = [inside.nodes.new(f"ShaderNode{kind}") for kind in ("TexChecker", "Math", "Value")]
    end = inside.nodes.new("NodeGroupOutput")
    if hasattr(inside, "interface"):
        inside.interface.new_socket("Result", in_out="OUTPUT", socket_type="NodeSocketFloat")
    else:
        inside.outputs.new("NodeSocketFloat", "Result")
    checker, raised, _ = kept
    raised.operation = "POWER"
    inside.links.new(checker.outputs["Fac"], raised.inputs[0])
    inside.links.new(raised.outputs[0], end.inputs[0])
    uses = [tree.tree.nodes.new("ShaderNodeGroup") for _ in range(2)]
    for number, use in enumerate(uses):
        use.node_tree, use.name = inside, f"Use {number}"
    diffuse = tree.node("BsdfDiffuse")
    tree.tree.links.new(uses[1].outputs[0], diffuse.inputs["Color"])
    tree.tree.links.new(uses[0].outputs[0], diffuse.inputs["Roughness"])
    found = use_of(tree.tree, describe_material(tree.show(diffuse.outputs[0])).exported)
    return {"total": found.total, "left": found.left, "names": [name for name, _ in found.costs]}
