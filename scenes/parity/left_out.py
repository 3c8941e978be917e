"""Nodes that Cycles does not know: it leaves out their links, and the inputs keep their own values."""

import bpy

from .boards import output_of, set_board, size_of, tile_mesh
from .catalogue import case, variants
from .images import gradient
from .nodes import Nodes

_MARK = (0.9, 0.3, 0.1)  # the constants of inputs


def _to_rgb(nodes, output="Color"):
    node = nodes.add("ShaderNodeShaderToRGB")
    nodes.link(nodes.add("ShaderNodeEmission", Color=(0.1, 0.9, 0.2)), node.inputs[0])
    return next(socket for socket in node.outputs if socket.name == output)


def _script(nodes, output=None):
    text = bpy.data.texts.get("script.osl") or bpy.data.texts.new("script.osl")
    node = nodes.add("ShaderNodeScript", props={"script": text})
    return node.outputs.new("NodeSocketColor", "Color") if len(node.outputs) == 0 else node.outputs[0]


def _squeezed(nodes, output=None):
    return nodes.add("ShaderNodeSqueeze", nodes.add("ShaderNodeTexCoord").outputs["Generated"]).outputs[0]


def _kept(source, output="Color"):
    return lambda nodes: nodes.add("ShaderNodeEmission", Color=_linked(nodes, source(nodes, output))).outputs[0]


def _linked(nodes, output):
    """A colour whose own value is the mark, and to which a node is linked."""
    mix = nodes.add("ShaderNodeMixRGB", 0.25, _MARK, (0.1, 0.2, 0.3))
    nodes.link(output, mix.inputs[1])
    return mix.outputs[0]


def _rerouted(source):
    def value(nodes):
        bend = nodes.add("NodeReroute")
        nodes.link(source(nodes), bend.inputs[0])
        return _linked(nodes, bend.outputs[0])

    return value


def _muted(source):
    def value(nodes):
        output = source(nodes)
        output.node.mute = True
        return _linked(nodes, output)

    return value


def _in_group(source):
    """The source inside a group, whose output has a value of its own."""

    def value(nodes):
        tree = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
        _add_socket(tree, "OUTPUT")
        inside = Nodes(tree)
        end = inside.add("NodeGroupOutput")
        end.inputs[0].default_value = (0.2, 0.8, 0.4, 1.0)
        inside.link(source(inside), end.inputs[0])
        return _linked(nodes, nodes.add("ShaderNodeGroup", props={"node_tree": tree}).outputs[0])

    return value


def _into_group(source):
    """The source linked to a group, inside which the input is linked on."""

    def value(nodes):
        tree = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
        _add_socket(tree, "INPUT")
        _add_socket(tree, "OUTPUT")
        inside = Nodes(tree)
        inside.link(_linked(inside, inside.add("NodeGroupInput").outputs[0]), inside.add("NodeGroupOutput").inputs[0])
        node = nodes.add("ShaderNodeGroup", props={"node_tree": tree})
        node.inputs[0].default_value = (0.2, 0.8, 0.4, 1.0)
        nodes.link(source(nodes), node.inputs[0])
        return node.outputs[0]

    return value


def _add_socket(tree, side, kind="Color"):
    if bpy.app.version >= (4, 0):
        return tree.interface.new_socket(kind, in_out=side, socket_type=f"NodeSocket{kind}")
    return (tree.inputs if side == "INPUT" else tree.outputs).new(f"NodeSocket{kind}", kind)


def _as_vector(source):
    """A texture whose coordinates are linked to the node: it has the default ones."""
    return lambda nodes: nodes.add("ShaderNodeTexNoise", Vector=source(nodes), Scale=3.0, Detail=0.0).outputs["Color"]


def _as_factor(source):
    return lambda nodes: nodes.add("ShaderNodeMixRGB", source(nodes), _MARK, (0.1, 0.2, 0.9)).outputs[0]


def _as_normal(source):
    return lambda nodes: nodes.add("ShaderNodeFresnel", Normal=source(nodes)).outputs[0]


def _as_surface(source):
    return lambda nodes: nodes.add("ShaderNodeAddShader", source(nodes), nodes.add("ShaderNodeEmission", Color=_MARK)).outputs[
        0
    ]


def _mixed_surface(nodes):
    own = nodes.add("ShaderNodeEeveeSpecular", (0.2, 0.9, 0.1))
    return nodes.add("ShaderNodeMixShader", 0.3, own, nodes.add("ShaderNodeEmission", Color=_MARK)).outputs[0]


_USES = (_kept, _rerouted, _muted, _in_group, _into_group, _as_vector, _as_factor, _as_normal, _as_surface)
_SURFACES = (output_of("ShaderNodeEeveeSpecular", "BSDF"), _mixed_surface, _as_surface(_script), _script)


@variants(
    values={
        "to_rgb": [use(_to_rgb) for use in _USES] + [_kept(_to_rgb, "Alpha")],
        "script": [use(_script) for use in _USES],
        "squeeze": [use(_squeezed) for use in _USES],
        "surface": _SURFACES,
    },
    size=size_of(10),
    bounces=0,
    quick=True,
)
def without_effect(scene, values):
    """Linked to a colour, by a reroute, muted, in and into a group, as coordinates, factor, normal and surface."""
    mesh = tile_mesh()
    set_board(scene, [(mesh, value) for value in values])


_NORMAL = (0.4, 0.1, 0.9)


def _through_group(use, linked=False, kind="Vector", hidden=False, given=_NORMAL):
    """use(nodes, output) inside a group, of the group's own constant, or of a constant node linked to it."""

    def value(nodes):
        tree = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
        _add_socket(tree, "INPUT", kind).hide_value = hidden
        _add_socket(tree, "OUTPUT")
        inside = Nodes(tree)
        result = use(inside, inside.add("NodeGroupInput").outputs[0])
        inside.link(result, inside.add("NodeGroupOutput").inputs[0])
        node = nodes.add("ShaderNodeGroup", props={"node_tree": tree})
        nodes.give(node.inputs[0], 0.7 if kind == "Float" else given)
        if linked:
            nodes.link(nodes.add("ShaderNodeCombineXYZ", *_NORMAL), node.inputs[0])
        return node.outputs[0]

    return value


def _out_of_group(use):
    """The constant of an output inside a group."""

    def value(nodes):
        tree = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
        _add_socket(tree, "OUTPUT", "Vector")
        tree.nodes.new("NodeGroupOutput").inputs[0].default_value = _NORMAL
        return use(nodes, nodes.add("ShaderNodeGroup", props={"node_tree": tree}).outputs[0])

    return value


def _direct(use, given=_NORMAL):
    return lambda nodes: use(nodes, nodes.add("ShaderNodeCombineXYZ", *given).outputs[0])


def _by_reroute(use):
    def value(nodes):
        return use(nodes, nodes.add("NodeReroute").outputs[0])

    return value


def _noise(nodes, output):
    return nodes.add("ShaderNodeTexNoise", Vector=output, Scale=3.0, Detail=0.0).outputs["Color"]


def _varying_noise(nodes, output):
    """Blender evaluates only nodes of constants alone."""
    scale = nodes.add("ShaderNodeNewGeometry").outputs["Position"]
    return nodes.add("ShaderNodeTexNoise", Vector=output, Scale=scale, Detail=0.0).outputs["Color"]


def _gradient(nodes, output):
    return nodes.add("ShaderNodeTexGradient", Vector=output).outputs["Color"]


def _picture(nodes, output):
    return nodes.add("ShaderNodeTexImage", Vector=output, props={"image": gradient()}).outputs["Color"]


def _fresnel(nodes, output):
    return nodes.add("ShaderNodeFresnel", IOR=2.5, Normal=output).outputs[0]


def _weight(nodes, output):
    return nodes.add("ShaderNodeLayerWeight", Normal=output).outputs["Facing"]


def _schlick(nodes, output):
    return nodes.add("ShaderNodeLayerWeight", Normal=output).outputs["Fresnel"]


def _bumped(nodes, output):
    return nodes.add("ShaderNodeBump", Normal=output).outputs[0]


_VECTOR_USES = (_noise, _varying_noise, _gradient, _picture, _fresnel, _weight, _schlick, _bumped)
_WAYS = (
    _through_group,
    lambda use: _through_group(use, linked=True),
    lambda use: _through_group(use, hidden=True),
    lambda use: _through_group(use, given=(0.0, 0.0, 0.0)),
    lambda use: _through_group(use, kind="Color"),
    lambda use: _through_group(use, kind="Color", hidden=True),
    lambda use: _through_group(use, kind="Float"),
    _out_of_group,
    _direct,
    lambda use: _direct(use, (0.0, 0.0, 0.0)),
    _by_reroute,
)


@case(size=size_of(len(_VECTOR_USES) * len(_WAYS)), bounces=0, quick=True)
def constants_as_links(scene):
    """A constant vector by way of a group, a node or a reroute, where an unlinked input has a value that varies."""
    mesh = tile_mesh()
    set_board(scene, [(mesh, way(use)) for way in _WAYS for use in _VECTOR_USES])
