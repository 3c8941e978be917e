"""Shaders and values that other nodes mix, add, group and compute."""

import bpy

from .catalogue import case, variants
from .images import checker, gradient
from .nodes import Nodes, find, first_output, material
from .reasons import CLEAR3, CLEAR3_TOLD
from .stages import card, lamp, studio


def _two(nodes):
    return (
        nodes.add("ShaderNodeBsdfDiffuse", Color=(0.8, 0.2, 0.1)),
        nodes.add("ShaderNodeBsdfGlossy", props={"distribution": "GGX"}, Color=(0.6, 0.8, 0.9), Roughness=0.0),
    )


def _mix(nodes, factor, first, second):
    mix = nodes.add("ShaderNodeMixShader", factor)
    nodes.link(first, mix.inputs[1])
    nodes.link(second, mix.inputs[2])
    return mix


def _add(nodes, first, second):
    total = nodes.add("ShaderNodeAddShader")
    nodes.link(first, total.inputs[0])
    nodes.link(second, total.inputs[1])
    return total


@case()
def mix_shader(scene):
    studio(scene, material(lambda nodes: _mix(nodes, 0.3, *_two(nodes))))


@case(blender3=((0.05, 0.2), CLEAR3, CLEAR3_TOLD))
def mix_shader_clear_leaf(scene):
    """A surface that transmits light both straight through and scattered."""

    def build(nodes):
        clear = nodes.add("ShaderNodeBsdfTransparent", Color=(0.9, 0.6, 0.3))
        return _mix(nodes, 0.5, clear, nodes.add("ShaderNodeBsdfTranslucent", Color=(0.3, 0.8, 0.2)))

    studio(scene, material(build))


@case()
def mix_shader_rough(scene):
    """Light reflected between the facets of a rough surface keeps its own colour, however small its share."""

    def build(nodes):
        clay = nodes.add("ShaderNodeBsdfDiffuse", Color=(0.3, 0.1, 0.95), Roughness=1.0)
        return _mix(nodes, 0.5, clay, nodes.add("ShaderNodeBsdfDiffuse", Color=(0.2, 0.2, 0.2)))

    studio(scene, material(build))


@case(
    limit=(0.005, 0.03),
    reason="from 5.0 on, Cycles counts some light of the other layer twice there: its picture of the mix exceeds the sum of "
    "its pictures of the two layers by this amount; in Lancer both are equal",
)
def mix_shader_turned_away(scene):
    """One of two layers faces inwards on half of the ball: its normal does not follow the visible side."""

    def build(nodes):
        fixed = nodes.add("ShaderNodeNormalMap", props={"space": "WORLD"}, Color=(0.3, 0.4, 0.9))
        matt = nodes.add("ShaderNodeBsdfDiffuse", Color=(0.8, 0.5, 0.2), Normal=fixed)
        gloss = nodes.add("ShaderNodeBsdfGlossy", props={"distribution": "GGX"}, Color=(0.7, 0.8, 0.9), Roughness=0.5)
        return _mix(nodes, 0.5, matt, gloss)

    studio(scene, material(build))


@case()
def mix_shader_beyond_one(scene):
    """A factor outside 0 to 1 is clamped."""
    studio(scene, material(lambda nodes: _mix(nodes, nodes.add("ShaderNodeMath", 0.9, 0.6), *_two(nodes))))


@case()
def add_shader(scene):
    studio(scene, material(lambda nodes: _add(nodes, *_two(nodes))))


@case()
def mix_add_nested(scene):
    def build(nodes):
        first, second = _two(nodes)
        glow = nodes.add("ShaderNodeEmission", Color=(0.2, 0.3, 1.0), Strength=0.3)
        clear = nodes.add("ShaderNodeBsdfTransparent", Color=(0.9, 1.0, 0.9))
        return _mix(nodes, 0.25, _add(nodes, _mix(nodes, 0.6, first, second), glow), _mix(nodes, 0.5, clear, first))

    studio(scene, material(build))


@case()
def mix_shader_with_nothing(scene):
    """An empty input of a mix is black, not transparent."""

    def build(nodes):
        mix = nodes.add("ShaderNodeMixShader", 0.4)
        nodes.link(_two(nodes)[0], mix.inputs[1])
        return mix

    studio(scene, material(build))


@case(quick=True)
def mix_shader_textured_factor(scene):
    def build(nodes):
        picture = nodes.add("ShaderNodeTexImage", props={"image": checker(), "interpolation": "Closest"})
        return _mix(nodes, picture.outputs["Color"], *_two(nodes))

    card(scene, material(build))
    lamp(scene)


@variants(
    values={name.lower(): name for name in ("MIX", "ADD", "MULTIPLY", "SCREEN", "SUBTRACT", "OVERLAY", "DARKEN", "DIFFERENCE")}
)
def mix_color(scene, blend):
    def build(nodes):
        picture = nodes.add("ShaderNodeTexImage", props={"image": gradient()})
        mix = nodes.add("ShaderNodeMix", props={"data_type": "RGBA", "blend_type": blend})
        sockets = [socket for socket in mix.inputs if socket.enabled]
        sockets[0].default_value = 0.7
        nodes.link(picture.outputs["Color"], sockets[1])
        sockets[2].default_value = (0.3, 0.5, 0.2, 1.0)
        return nodes.add("ShaderNodeBsdfDiffuse", Color=first_output(mix))

    card(scene, material(build))


@case()
def mix_color_textured_factor(scene):
    def build(nodes):
        picture = nodes.add("ShaderNodeTexImage", props={"image": gradient(colorspace="Non-Color")})
        mix = nodes.add("ShaderNodeMix", props={"data_type": "RGBA"})
        sockets = [socket for socket in mix.inputs if socket.enabled]
        nodes.link(picture.outputs["Color"], sockets[0])
        sockets[1].default_value = (0.8, 0.1, 0.1, 1.0)
        sockets[2].default_value = (0.1, 0.3, 0.9, 1.0)
        return nodes.add("ShaderNodeBsdfDiffuse", Color=first_output(mix))

    card(scene, material(build))


@case()
def folded_values(scene):
    """Constants through Value, RGB, Math, Mix and a reroute give a plain colour and roughness."""

    def build(nodes):
        value = nodes.add("ShaderNodeValue")
        value.outputs[0].default_value = 0.25
        rgb = nodes.add("ShaderNodeRGB")
        rgb.outputs[0].default_value = (0.8, 0.3, 0.1, 1.0)
        power = nodes.add("ShaderNodeMath", value, 0.5, props={"operation": "POWER"})
        total = nodes.add("ShaderNodeMath", power, 0.3, props={"operation": "ADD"})
        mix = nodes.add("ShaderNodeMix", props={"data_type": "RGBA", "blend_type": "MULTIPLY"})
        sockets = [socket for socket in mix.inputs if socket.enabled]
        sockets[0].default_value = 1.0
        nodes.link(rgb, sockets[1])
        sockets[2].default_value = (0.9, 0.8, 0.7, 1.0)
        reroute = nodes.tree.nodes.new("NodeReroute")
        nodes.link(first_output(mix), reroute.inputs[0])
        return nodes.add("ShaderNodeBsdfDiffuse", Color=reroute.outputs[0], Roughness=total)

    studio(scene, material(build))


@case()
def node_group(scene):
    """A group with a value and a shader as inputs and outputs, and another group inside."""

    def build(nodes):
        outer = _group("Outer", lambda inner, ins: _inside(inner, ins))
        call = nodes.add("ShaderNodeGroup", props={"node_tree": outer})
        find(call.inputs, "Tint").default_value = (0.9, 0.3, 0.2, 1.0)
        return call

    studio(scene, material(build))


def _inside(nodes, ins):
    inner = _group("Inner", lambda more, its: more.add("ShaderNodeBsdfDiffuse", Color=its.outputs["Tint"]))
    call = nodes.add("ShaderNodeGroup", props={"node_tree": inner})
    nodes.link(ins.outputs["Tint"], call.inputs["Tint"])
    return _add(nodes, call, nodes.add("ShaderNodeEmission", Color=ins.outputs["Tint"], Strength=0.1))


def _group(name, build):
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
        tree.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    else:
        tree.inputs.new("NodeSocketColor", "Tint")
        tree.outputs.new("NodeSocketShader", "Shader")
    nodes = Nodes(tree)
    ins, outs = nodes.add("NodeGroupInput"), nodes.add("NodeGroupOutput")
    nodes.link(build(nodes, ins), outs.inputs["Shader"])
    return tree


@variants(values={"fresnel": "Fresnel", "facing": "Facing"})
def layer_weight(scene, output):
    def build(nodes):
        weight = nodes.add("ShaderNodeLayerWeight", Blend=0.4)
        return _mix(nodes, weight.outputs[output], *_two(nodes))

    studio(scene, material(build))


@case()
def fresnel(scene):
    studio(scene, material(lambda nodes: _mix(nodes, nodes.add("ShaderNodeFresnel", IOR=1.6), *_two(nodes))))


@case()
def color_ramp(scene):
    def build(nodes):
        picture = nodes.add("ShaderNodeTexImage", props={"image": gradient()})
        ramp = nodes.add("ShaderNodeValToRGB", picture.outputs["Color"])
        ramp.color_ramp.elements[0].color = (0.9, 0.1, 0.1, 1.0)
        ramp.color_ramp.elements.new(0.3).color = (0.1, 0.8, 0.2, 1.0)
        return nodes.add("ShaderNodeBsdfDiffuse", Color=ramp.outputs["Color"])

    card(scene, material(build))
