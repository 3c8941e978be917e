"""The exports of a 3D view, each after one edit: what is read, and whether the snapshot equals that of a full export."""

import dataclasses
import os
import tempfile
from collections import Counter

import bpy
import numpy as np
import stage

from addon.bindings import snapshot
from addon.bindings.session import Scene
from addon.bindings.stock import Stock
from addon.export.parts import Parts
from addon.export.scene import ExportOptions, export_scene

KINDS = ("objects", "meshes", "shaders", "images")


def _picture(name, value):
    path = os.path.join(tempfile.mkdtemp(), f"{name}.png")
    image = bpy.data.images.new(name, 8, 8)
    image.pixels.foreach_set(np.tile(np.array([value, 0.5, 0.25, 1.0], np.float32), 64))
    image.filepath_raw, image.file_format = path, "PNG"
    image.save()
    bpy.data.images.remove(image)
    return bpy.data.images.load(path)


def _fed(name, kind, output, make):
    """Return a material whose colour comes from a node of this kind; make(node) sets the node's properties."""
    material = stage.shader(name=name)
    tree = material.node_tree
    node = tree.nodes.new(kind)
    make(node)
    tree.links.new(node.outputs[output], next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE").inputs["Color"])
    return material


def _pictured(name, image):
    return _fed(name, "ShaderNodeTexImage", "Color", lambda node: setattr(node, "image", image))


def _grouped(name, group):
    return _fed(name, "ShaderNodeGroup", 0, lambda node: setattr(node, "node_tree", group))


def _placed(name, thing):
    """Return a material coloured by the coordinates of another object."""
    return _fed(name, "ShaderNodeTexCoord", "Object", lambda node: setattr(node, "object", thing))


def _group():
    group = bpy.data.node_groups.new("Colours", "ShaderNodeTree")
    if hasattr(group, "interface"):
        group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    else:
        group.outputs.new("NodeSocketColor", "Color")
    color, out = group.nodes.new("ShaderNodeRGB"), group.nodes.new("NodeGroupOutput")
    group.links.new(color.outputs[0], out.inputs[0])
    return group


def _box(number, name, material, data=None):
    if data is not None:
        item = stage.link(name, data, (number, 0, 0))
    else:
        item = stage.cube(0.8, material, location=(number, 0, 0))
        item.data.uv_layers.new()
        item.name = item.data.name = name
    return item


def build():
    """Build seven objects with five meshes, six materials, a world, and two images."""
    scene = stage.empty()
    # One of Cycles' settings that the export warns of.
    scene.cycles.diffuse_bounces = 2
    first, second = _picture("first", 0.25), _picture("second", 0.75)
    plain = _box(0, "Plain", stage.shader(name="Plain", Color=(0.8, 0.4, 0.2)))
    _box(1, "Twin", None, plain.data)
    _box(2, "Pictured", _pictured("First", first))
    _box(3, "Other", _pictured("Second", second))
    empty = bpy.data.objects.new("Place", None)
    scene.collection.objects.link(empty)
    _box(4, "Placed", _placed("Placed", empty))
    keyed = _box(5, "Keyed", _grouped("Grouped", _group()))
    keyed.shape_key_add(name="Basis")
    keyed.shape_key_add(name="Wide").data[0].co.z += 0.8
    key = keyed.data.shape_keys.key_blocks["Wide"]
    for frame, value in ((1, 0.0), (3, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    _box(6, "Lone", bpy.data.materials["Plain"], plain.data.copy())
    stage.light("POINT", 100.0, (0, -3, 5))
    stage.sky()
    stage.camera()
    scene.frame_set(1)
    return scene


def edit_mesh():
    mesh = bpy.data.objects["Plain"].data
    mesh.vertices[0].co.x += 0.25
    mesh.update()


def _node(material, kind):
    return next(node for node in bpy.data.materials[material].node_tree.nodes if node.type == kind)


def edit_material():
    _node("Plain", "BSDF_DIFFUSE").inputs["Color"].default_value = (0.1, 0.9, 0.3, 1.0)


def _edit_group():
    next(n for n in bpy.data.node_groups["Colours"].nodes if n.type == "RGB").outputs[0].default_value = (0.9, 0.1, 0.3, 1.0)


def _paint():
    image = bpy.data.images[next(image.name for image in bpy.data.images if image.name.startswith("first"))]
    image.pixels.foreach_set(np.full(256, 0.5, np.float32))
    image.update()
    image.update_tag()


def _swap_pictures():
    _node("First", "TEX_IMAGE").image = _node("Second", "TEX_IMAGE").image


def _bend():
    bpy.data.objects["Twin"].modifiers.new("Bend", "SIMPLE_DEFORM").angle = 1.0


def set_to(path, value):
    """Return an edit that sets a property; path: an expression of bpy, objects and scene."""

    def edit():
        owner, name = path.rsplit(".", 1)
        target = eval(owner, {"bpy": bpy, "objects": bpy.data.objects, "scene": bpy.context.scene})
        setattr(target, name, value)

    return edit


def _swap_hidden():
    for name, hidden in (("Plain", True), ("Other", False)):
        bpy.data.objects[name].hide_set(hidden)


EDITS = {
    "nothing": set_to("scene.cursor.location", (1, 2, 3)),
    "moved object": set_to("objects['Lone'].location", (6, 1, 0)),
    "moved twice": set_to("objects['Lone'].rotation_euler", (0, 0, 1)),
    "moved camera": set_to("objects['Camera'].location", (1, -6, 3)),
    "moved lamp": set_to("objects['Light'].location", (1, -3, 5)),
    "moved place": set_to("objects['Place'].location", (1, 1, 1)),
    "edited material": edit_material,
    "edited group": _edit_group,
    "edited mesh": edit_mesh,
    "edited world": set_to("scene.world.node_tree.nodes['Background'].inputs['Strength'].default_value", 2.0),
    "edited lamp": set_to("bpy.data.lights[0].energy", 50.0),
    "animated frame": lambda: bpy.context.scene.frame_set(2),
    "still frame": lambda: bpy.context.scene.frame_set(5) or bpy.context.scene.frame_set(6),
    "hidden object": set_to("objects['Other'].hide_viewport", True),
    "shown object": set_to("objects['Other'].hide_viewport", False),
    "painted picture": _paint,
    "other picture": _swap_pictures,
    "modifier": _bend,
    "hidden in the view": lambda: bpy.data.objects["Other"].hide_set(True),
    "others hidden in the view": _swap_hidden,
}


class Window:
    """Exports, uploads and commits at each update of the depsgraph, as a 3D view does."""

    def __init__(self):
        self.parts, self.stock, self.scene = Parts(), Stock(), None
        self.camera = snapshot.Camera()
        self.exports = []
        self.uploads, self.made = Counter(), Counter()

    def export(self, _scene, depsgraph):
        options = ExportOptions(view=self.camera, parts=self.parts)
        got, messages = export_scene(depsgraph, options)
        whole, others = export_scene(depsgraph, dataclasses.replace(options, parts=None))
        self.images = len(got.images)
        self.exports.append((dict(self.parts.counts), plain(got) == plain(whole), messages.lines() == others.lines()))
        self._commit(got)

    def _commit(self, got):
        before = set() if self.scene is None else {part.handle for part in self.scene._parts}
        scene = Scene(before=self.scene, stock=self.stock)
        scene.fill(got)
        scene.commit()
        for part in scene._parts:
            if part.handle not in before:
                self.uploads[type(part.record).__name__] += 1
                before.add(part.handle)
        self.made.update(scene.made())
        if self.scene is not None:
            self.scene.close()
        self.scene = scene

    def take_work(self):
        """Return what was uploaded and made since the last call, by kind."""
        done = [{name: count for name, count in counts.items() if count} for counts in (self.uploads, self.made)]
        self.uploads.clear(), self.made.clear()
        return done


def plain(given):
    """Return the snapshot with images, materials and meshes in place of their indices, which may differ."""
    table = given.instances
    columns = [table.kinds, table.object_indices, table.shadings, table.hidden_from, table.flags, table.terminators]
    values = [column.tolist() for column in (*columns, *(() if table.infos is None else [table.infos]))]
    rows = [
        (given.meshes[mesh], tuple(_material(given, table.slots[first + i]) for i in range(count)), matrix.tolist())
        for mesh, first, count, matrix in zip(table.meshes, table.first_slots, table.slot_counts, table.matrices, strict=True)
    ]
    lights = [_with_pictures(given, light) for light in given.lights]
    return rows, values, table.attributes, lights, _with_pictures(given, given.world), given.settings


def _material(given, number):
    return _with_pictures(given, given.materials[number])


def _with_pictures(given, shader):
    nodes = [dataclasses.replace(node, image=0) for node in shader.nodes]
    images = [given.images[node.image + i] for node in shader.nodes for i in range(node.image_count)]
    return dataclasses.replace(shader, nodes=tuple(nodes)), tuple(images)


def edits():
    """Return {edit: counts of all exports that it caused, same snapshot, same messages}, and whether strokes are shown."""
    build()
    return {**results(EDITS), "strokes": bpy.app.version >= (5, 2)}


def results(edits):
    window = Window()
    results = {}
    bpy.context.view_layer.update()
    window.export(None, bpy.context.evaluated_depsgraph_get())
    results["first"] = (*window.exports.pop(), 1, *window.take_work())
    handlers = bpy.app.handlers
    handlers.depsgraph_update_post.append(window.export)
    handlers.frame_change_post.append(window.export)
    try:
        for name, edit in edits.items():
            edit()
            bpy.context.view_layer.update()
            counts = {kind: sum(export[0][kind] for export in window.exports) for kind in KINDS}
            alike = [all(export[i] for export in window.exports) for i in (1, 2)]
            results[name] = (counts, *alike, len(window.exports), *window.take_work())
            window.exports.clear()
    finally:
        handlers.depsgraph_update_post.remove(window.export)
        handlers.frame_change_post.remove(window.export)
    return results


def _named(kind, name):
    """Return a material coloured by a property."""

    def make(node):
        node.attribute_type, node.attribute_name = kind, name

    return _fed(f"{kind} {name}", "ShaderNodeAttribute", "Color", make)


def _give(block, value):
    def edit():
        owner = eval(block)
        owner["heat"] = value
        owner.id_data.update_tag()

    return edit


_EDITS_OF_OBJECTS = {
    "object": _give("bpy.data.objects['Heated']", 0.5),
    "moved object": set_to("objects['Placed'].location", (1, 2, 3)),
}
_EDITS_OF_THE_LAYER = {
    "view layer": _give("bpy.context.view_layer", 0.6),
    "scene": _give("bpy.context.scene", 0.7),
    "world": _give("bpy.context.scene.world", 0.8),
}


def property_edits():
    """As edits, where materials read properties of objects, and then of the view layer too."""
    stage.empty()
    bpy.context.scene["heat"] = 0.1
    _box(0, "Heated", _named("OBJECT", "heat"))["heat"] = 0.2
    _box(1, "Placed", _named("OBJECT", "location"))
    stage.sky()
    stage.camera()
    of_objects = results(_EDITS_OF_OBJECTS)
    _box(2, "Layered", _named("VIEW_LAYER", "heat"))
    return {**results(_EDITS_OF_THE_LAYER), **of_objects}
