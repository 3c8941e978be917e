"""Pictures that Blender joins from several scenes, strips, composites and sets, and of scenes of thousands of objects."""

import os

import bpy
import flat_stage
import numpy as np
import stage

# Pixels of the picture of a crowd, across and up.
CROWD = 64, 48


@flat_stage.by_both
def sequenced(engine):
    """Four frames of a scene of strips: a still scene, and from the third frame on another one that moves."""
    scene = flat_stage.begin(engine)
    item = flat_stage.patch(flat_stage.RED, 0, 0)
    for frame in range(1, 6):
        item.location.x = frame - 1.0
        item.keyframe_insert("location", frame=frame)
    other = added(engine, "Lower", flat_stage.BLUE)
    flat_stage.patch(flat_stage.GREEN, 8, 4)
    cut = added(engine, "Cut")
    tracks = strips(cut)
    lower = tracks.new_scene("Lower", other, 1, 1)
    upper = tracks.new_scene("Upper", scene, 2, 3)
    for strip, last in ((lower, 4), (upper, 4)):
        strip.frame_final_end = last + 1
    upper.frame_offset_start = 0
    upper.blend_type = "REPLACE"
    upper.use_float = lower.use_float = True
    cut.frame_start, cut.frame_end = 1, 4
    cut.sequencer_colorspace_settings.name = "Linear Rec.709" if bpy.app.version >= (4, 0) else "Linear"
    folder = os.path.abspath(f"strips {engine}")
    flat_stage.as_file(cut)
    cut.render.filepath = os.path.join(folder, "")
    bpy.ops.render.render(animation=True, scene=cut.name)
    # Blender keeps the camera of a strip for the next composite that renders a scene of this name or address, also in another
    # file, and crashes: a render without strips forgets it.
    for shown in (scene, other):
        bpy.ops.render.render(scene=shown.name)
    pictures = [stage.pixels(os.path.join(folder, f"000{frame}.exr")) for frame in (1, 2, 3, 4)]
    return {"frames": [flat_stage.colors(picture) for picture in pictures], "places": list(map(flat_stage.first_red, pictures))}


def added(engine, name, sky=flat_stage.GREY):
    """Return a new furnished scene."""
    scene = bpy.data.scenes.new(name)
    flat_stage.furnish(scene, engine, sky)
    return scene


def strips(scene):
    editor = scene.sequence_editor_create()
    return editor.strips if hasattr(editor, "strips") else editor.sequences


@flat_stage.by_both
def composed(engine):
    """A composite of two view layers and another scene, with a pass of the first."""
    scene = flat_stage.begin(engine)
    only = flat_stage.second_layer(scene)
    flat_stage.patch(flat_stage.RED, 0, 0, collection=only)
    for layer in scene.view_layers:
        layer.use_pass_object_index = True
    bpy.data.objects["Patch"].pass_index = 3
    other = added(engine, "Composed", flat_stage.BLUE)
    flat_stage.patch(flat_stage.GREEN, 8, 4)
    bpy.context.window.scene = scene
    tree = compositor(scene)
    nodes, links = tree.nodes, tree.links

    def layer_of(scene, name):
        node = nodes.new("CompositorNodeRLayers")
        node.scene, node.layer = scene, name
        return node

    def sum_of(first, second):
        kind = "ShaderNodeMix" if bpy.app.version >= (5, 0) else "CompositorNodeMixRGB"
        node = nodes.new(kind)
        if kind == "ShaderNodeMix":
            node.data_type, node.blend_type = "RGBA", "ADD"
            factor, a, b = (next(s for s in node.inputs if s.identifier == n) for n in ("Factor_Float", "A_Color", "B_Color"))
            out = next(s for s in node.outputs if s.identifier == "Result_Color")
        else:
            node.blend_type = "ADD"
            (factor, a, b), out = node.inputs, node.outputs[0]
        factor.default_value = 1.0
        links.new(first, a)
        links.new(second, b)
        return out

    first, second = layer_of(scene, scene.view_layers[0].name), layer_of(scene, "Second")
    third = layer_of(other, other.view_layers[0].name)
    index = next(s for s in first.outputs if s.name in ("IndexOB", "Object Index"))
    total = sum_of(sum_of(sum_of(first.outputs["Image"], second.outputs["Image"]), third.outputs["Image"]), index)
    links.new(total, composite_input(tree))
    path = os.path.abspath(f"composite {engine}.exr")
    result = {"on": flat_stage.colors(stage.pixels(stage.write_exr(scene, path)))}
    scene.render.use_compositing = False
    result["off"] = flat_stage.colors(stage.pixels(stage.write_exr(scene, path)))
    return result


def compositor(scene):
    if bpy.app.version >= (5, 0):
        tree = bpy.data.node_groups.new("Composite", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        scene.compositing_node_group = tree
        return tree
    scene.use_nodes = True
    scene.node_tree.nodes.clear()
    return scene.node_tree


def composite_input(tree):
    if bpy.app.version >= (5, 0):
        return tree.nodes.new("NodeGroupOutput").inputs[0]
    return tree.nodes.new("CompositorNodeComposite").inputs[0]


@flat_stage.by_both
def with_set(engine):
    """A scene with a set that has a set: its objects, its world and camera unused, its hidden collections hidden."""
    scene = flat_stage.begin(engine)
    flat_stage.patch(flat_stage.RED, 0, 0)
    first = added(engine, "Set", flat_stage.BLUE)
    flat_stage.patch(flat_stage.GREEN, 4, 4)
    hidden = bpy.data.collections.new("Hidden")
    first.collection.children.link(hidden)
    hidden.hide_render = True
    flat_stage.patch(flat_stage.BLUE, 8, 0, collection=hidden)
    stage.light("SUN", 1.0)
    second = added(engine, "Set of the set", flat_stage.BLUE)
    item = flat_stage.patch(flat_stage.BLUE, 12, 4)
    for frame in (1, 2):
        item.location.y = 1.0 - frame
        item.keyframe_insert("location", frame=frame)
    first.background_set, scene.background_set = second, first
    bpy.context.window.scene = scene
    result = {}
    for frame in (1, 2):
        scene.frame_set(frame)
        picture = stage.picture(scene)
        result[str(frame)] = flat_stage.colors(picture)
        result[f"top {frame}"] = picture[-1, 14].round(3).tolist()
    return result


@flat_stage.by_both
def crowded(engine):
    """Three thousand objects in a hundred collections, one on each pixel: the level of each pixel's blue in rows.

    Objects of shared meshes and of meshes of their own, and instances of collections in collections above them.
    """
    scene = flat_stage.begin(engine)
    scene.render.resolution_x, scene.render.resolution_y = CROWD
    scene.camera.data.ortho_scale = float(CROWD[0])
    shades = [stage.shader("ShaderNodeEmission", Color=(0.0, 0.0, level / 8), Strength=1.0) for level in range(1, 9)]
    shared = [square(f"Shared {level}", shade) for level, shade in enumerate(shades)]
    # Blender walks through all objects of a scene for each new one: link the collections last.
    collections = [bpy.data.collections.new("All")]
    for number in range(1, 101):
        made = bpy.data.collections.new(f"{number}")
        collections[number // 2].children.link(made)
        collections.append(made)
    collections[9].hide_render = True
    for number in range(3000):
        level = number * 5 % 8
        data = shared[level] if number % 4 else square(f"Own {number}", shades[level])
        item = bpy.data.objects.new(f"{number}", data)
        item.location = place(number, 0.0)
        collections[1 + number % 100].objects.link(item)
    inner, outer = bpy.data.collections.new("Inner"), bpy.data.collections.new("Outer")
    for column in range(2):
        inner.objects.link(instance(shared[7], (column, 0.0, 0.0)))
    for row in range(2):
        outer.objects.link(instance(inner, (0.0, row, 0.0)))
    for number in (0, 20, 84):
        collections[0].objects.link(instance(outer, place(number, 0.5)))
    scene.collection.children.link(collections[0])
    layer = scene.view_layers[0].layer_collection
    for name in ("All", "1", "2", "4", "8", "17"):
        layer = layer.children[name]
    layer.exclude = True
    return np.round(stage.picture(scene)[..., 2].ravel() * 8, 3).tolist()


def square(name, shade):
    """Return a mesh that covers a pixel."""
    data = bpy.data.meshes.new(name)
    data.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    data.materials.append(shade)
    return data


def place(pixel, height):
    row, column = divmod(pixel, CROWD[0])
    return column - CROWD[0] / 2, row - CROWD[1] / 2, height


def instance(what, location):
    """Return an object of a mesh, or an instance of a collection."""
    item = bpy.data.objects.new("Instance", what if isinstance(what, bpy.types.Mesh) else None)
    if item.type == "EMPTY":
        item.instance_type, item.instance_collection = "COLLECTION", what
    item.location = location
    return item
