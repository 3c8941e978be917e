"""Passes that the artist makes: light groups and AOVs; and those for other denoisers."""

import bpy

from .. import parts
from .catalogue import case
from .nodes import shader
from .passes_light import _still_life
from .stages import ball, camera, floor, lamp, sky

_GROUPS = ("key", "glow", "sky")
_GROUP_PASSES = tuple(f"Combined_{name}" for name in _GROUPS)


def _group(name):
    """Adds a light group to the view layer."""
    bpy.ops.scene.view_layer_add_lightgroup(name=name)


def _aov(name, kind):
    layer = bpy.context.view_layer
    aov = layer.aovs.add()
    aov.name, aov.type = name, kind


def _grouped(scene):
    """The still life, whose lamp, emitter and sky belong to a group each, beside a lamp of none."""
    _still_life(scene)
    for name in _GROUPS:
        _group(name)
    scene.world.lightgroup = "sky"
    for thing in scene.objects:
        if thing.type == "LIGHT":
            thing.lightgroup = "key"
    glow = scene.objects["Glow"]
    glow.lightgroup, glow.scale = "glow", (3.0, 3.0, 3.0)
    parts.add_light(scene, "Other", "POINT", 40.0, (-2.0, -2.0, 2.0), (0, 0, 0.5), shadow_soft_size=0.4)


@case(passes=("Combined", *_GROUP_PASSES), bounces=1)
def pass_light_groups(scene):
    """The light of a lamp, an emitter and a sky, each by itself, beside a lamp that is in no group."""
    _grouped(scene)


@case(passes=("Combined", *_GROUP_PASSES, "Environment"), bounces=1)
def pass_light_groups_transparent(scene):
    """Behind a transparent film the sky stays in its group where the pass Environment is on."""
    _grouped(scene)
    scene.render.film_transparent = True


def _gives(surface, color, value):
    """Lets a material or a world give a colour and a value, which sockets may be linked to."""
    tree = surface.node_tree
    for target, socket, given in (("Tint", "Color", color), ("Number", "Value", value)):
        node = tree.nodes.new("ShaderNodeOutputAOV")
        if hasattr(node, "aov_name"):
            node.aov_name = target
        else:
            node.name = target
        if isinstance(given, bpy.types.NodeSocket):
            tree.links.new(given, node.inputs[socket])
        else:
            node.inputs[socket].default_value = given
    return surface


def _with_coordinates(surface):
    """Gives the generated coordinates as a colour, and the height as a value."""
    tree = surface.node_tree
    coordinates, split = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(coordinates.outputs["Generated"], split.inputs[0])
    return _gives(surface, coordinates.outputs["Generated"], split.outputs["Z"])


@case(passes=("Tint", "Number"), bounces=0)
def pass_aov(scene):
    """Values by nodes, constant ones, beside an object that gives none, before a sky that gives some."""
    _aov("Tint", "COLOR")
    _aov("Number", "VALUE")
    floor(scene)
    matt = _with_coordinates(shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.3, 0.2)))
    ball(scene, matt, radius=0.6, location=(-1.3, 0.3, 0.6))
    steel = _gives(shader("ShaderNodeBsdfGlossy", Roughness=0.4), (0.2, 3.0, -0.5, 1.0), -2.0)
    ball(scene, steel, radius=0.6, location=(0, 0.3, 0.6))
    ball(scene, shader("ShaderNodeBsdfDiffuse"), radius=0.6, location=(1.3, 0.3, 0.6))
    sky(scene)
    world = scene.world
    coordinates = world.node_tree.nodes.new("ShaderNodeTexCoord")
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    world.node_tree.links.new(coordinates.outputs["Generated"], background.inputs["Color"])
    _gives(world, (0.1, 0.2, 0.3, 1.0), 0.5)
    lamp(scene)
    camera(scene, (0, -4.5, 1.5), (0, 0, 0.6))


@case(passes=("Tint", "Number"), bounces=0)
def pass_aov_through_panes(scene):
    """Panes of several opacities around the threshold, each of which gives values, before a ball that gives some."""
    _aov("Tint", "COLOR")
    _aov("Number", "VALUE")
    floor(scene)
    for number, alpha in enumerate((0.0, 0.3, 0.7, 1.0)):
        surface = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.7, 0.3), Alpha=alpha)
        pane = _gives(surface, (1.0, 0.1 * number, 0.0, 1.0), 1.0)
        place = number - 1.5, -1.5, 0.9
        parts.place(scene, f"Pane {number}", parts.plane_mesh("Pane", 0.8), pane, place, rotation=(1.4, 0, 0.1))
    ball(scene, _gives(shader("ShaderNodeBsdfDiffuse"), (0.0, 0.0, 1.0, 1.0), 10.0), radius=1.0, location=(0, 0.6, 1.0))
    sky(scene, strength=0.8)
    lamp(scene)
    camera(scene, (0, -4.5, 1.5), (0, 0, 0.8))


@case("LOBES", passes=("Denoising Specular Albedo", "Denoising Roughness"), since=(5, 2))
def pass_denoising_specular(scene):
    """Mirror-like, rough and matt surfaces, and a pane before them."""
    floor(scene)
    for number, roughness in enumerate((0.05, 0.2, 0.3, 0.6)):
        surface = shader(
            "ShaderNodeBsdfPrincipled", Base_Color=(0.8, 0.6, 0.3), Metallic=1.0 * (number % 2), Roughness=roughness
        )
        ball(scene, surface, radius=0.45, location=(number - 1.5, 0.3, 0.45))
    pane = shader("ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.7, 0.3), Alpha=0.4, Roughness=0.1)
    parts.place(scene, "Pane", parts.plane_mesh("Pane", 1.2), pane, (0.3, -1.2, 0.7), rotation=(1.4, 0, 0.2))
    sky(scene)
    lamp(scene)
    camera(scene, (0, -4.5, 1.5), (0, 0, 0.6))
