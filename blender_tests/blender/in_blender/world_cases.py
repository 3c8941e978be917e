"""Worlds of every kind, as they are exported."""

import os
import tempfile

import bpy
import numpy as np
import stage

from addon.bindings.enums import NodeKind
from addon.export.images import Images
from addon.export.world import CUBE_SIDES, export_world
from addon.messages.messages import Messages


def _picture(name, color=(1.0, 1.0, 1.0, 1.0), width=8, height=4):
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    image.pixels.foreach_set(np.tile(np.array(color, np.float32), width * height))
    return image


def _exported(messages, images=None):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return export_world(bpy.context.scene.world, images or Images(), depsgraph, messages).world


def _tree():
    stage.sky()
    tree = bpy.context.scene.world.node_tree
    return tree, next(node for node in tree.nodes if node.type == "BACKGROUND")


def _shown(projection, messages):
    tree, background = _tree()
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image, texture.projection = _picture("sky"), projection
    tree.links.new(texture.outputs[0], background.inputs["Color"])
    world = _exported(messages)
    node = world.nodes[world.radiance.node]
    return [int(node.kind), int(node.option), int(node.image_count)]


def missing():
    """A sky whose image is missing, and one that is not sampled as a light."""
    scene = stage.empty()
    tree, background = _tree()
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    tree.links.new(texture.outputs[0], background.inputs["Color"])
    lost = bpy.data.images.new("lost", 4, 4)
    lost.source, lost.filepath = "FILE", os.path.join(tempfile.mkdtemp(), "nowhere.hdr")
    result = {}
    for name, image, method in (("none", None, "AUTOMATIC"), ("lost", lost, "AUTOMATIC"), ("unsampled", None, "NONE")):
        texture.image, scene.world.cycles.sampling_method = image, method
        messages = Messages()
        world = _exported(messages)
        node = next(node for node in world.nodes if node.kind == NodeKind.ENVIRONMENT)
        result[name] = [hasattr(world.radiance, "node"), int(node.image_count), list(messages)]
    return result


def export():
    scene = stage.empty()
    messages, result = Messages(), {}
    result["none"] = list(_exported(messages).radiance)
    stage.sky((0.2, 0.4, 0.6), 2.5)
    result["constant"] = list(_exported(messages).radiance)
    tree, background = _tree()
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (1, 0, 0, 1), 1.0
    other, mix = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeMixShader")
    other.inputs["Color"].default_value, other.inputs["Strength"].default_value = (0, 0, 1, 1), 2.0
    mix.inputs[0].default_value = 0.25
    tree.links.new(background.outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    result["mixed"] = list(_exported(messages).radiance)
    stage.sky()
    switches = scene.world.cycles_visibility
    switches.camera = switches.scatter = False
    result["hidden"] = [_exported(messages).hidden_from]
    switches.camera = switches.scatter = True
    switches.diffuse = False
    result["hidden"].append(_exported(messages).hidden_from)
    stage.sky()
    result["resolution"] = [_exported(messages).map_resolution]
    scene.world.cycles.sampling_method, scene.world.cycles.sample_map_resolution = "MANUAL", 512
    result["resolution"].append(_exported(messages).map_resolution)
    result["equirectangular"] = _shown("EQUIRECTANGULAR", messages)
    result["mirror ball"] = _shown("MIRROR_BALL", messages)
    stage.sky()
    own = scene.world.lancer
    own.use_cube = True
    for side in CUBE_SIDES:
        setattr(own, side, _picture(side, width=4))
    images = Images()
    world = _exported(messages, images)
    node = next(node for node in world.nodes if int(node.kind) == 3)
    result["cube"] = [int(node.kind), int(node.option), int(node.image_count)]
    result["cube images"] = [image.name for image in images.list]
    result["messages"] = messages.lines()
    own.cube_positive_z = None
    lost = Messages()
    _exported(lost)
    result["cube without a picture"] = sum("+Z" in line for line in lost.lines())
    return result


def _numbered(folder, side, number, red):
    """Write an image file whose name ends in a number; return its path."""
    image = bpy.data.images.new(side, 4, 4)
    image.generated_color = (red, 0.0, 0.0, 1.0)
    image.filepath_raw, image.file_format = os.path.join(folder, f"{side}{number:04}.png"), "PNG"
    image.save()
    return image.filepath_raw


def sequence():
    """A cube of six files that are numbered like frames; one of them has a file for the scene's frame, too."""
    stage.empty()
    stage.sky()
    folder = tempfile.mkdtemp()
    own = bpy.context.scene.world.lancer
    own.use_cube = True
    for number, side in enumerate(CUBE_SIDES):
        shown = bpy.data.images.load(_numbered(folder, side, 7, 0.1 * (number + 1)))
        shown.source = "SEQUENCE"
        setattr(own, side, shown)
    _numbered(folder, side, 12, 1.0)
    messages, images = Messages(), Images()
    images.frame = 12
    _exported(messages, images)
    return {"red": [int(picture.texels[0, 0, 0]) for picture in images.list], "messages": messages.lines()}
