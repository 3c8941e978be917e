"""Objects in every mode of Blender's 3D viewport, by both engines: boxes that fill whole pixels, seen from above.

Each box emits one colour, so that pixels have no noise and the engines differ only by the rounding of the film.
"""

import os
import tempfile

import bmesh
import bpy
import stage
from export_cases import export_told

SIZE = 16  # pixels, and metres


def _box(name, color, x, y):
    """Return a box over one pixel, whose corners have integer coordinates."""
    item = stage.cube(1.0, stage.shader("ShaderNodeEmission", name, Color=color), location=(x + 0.5, y + 0.5, 0.5))
    item.name = item.data.name = name
    return item


def _repeated(item, offset, count=2, **fields):
    """Repeat the item by an Array modifier."""
    modifier = item.modifiers.new("Array", "ARRAY")
    modifier.count, modifier.use_relative_offset, modifier.use_constant_offset = count, False, True
    modifier.constant_offset_displace = offset
    for field, value in fields.items():
        setattr(modifier, field, value)


def _instanced(tree_name, thing):
    """Return a node tree that instances an object."""
    tree = bpy.data.node_groups.new(tree_name, "GeometryNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    source, output = tree.nodes.new("GeometryNodeObjectInfo"), tree.nodes.new("NodeGroupOutput")
    source.inputs["Object"].default_value, source.inputs["As Instance"].default_value = thing, True
    tree.links.new(source.outputs["Geometry"], output.inputs[0])
    return tree


def build():
    """Build the objects of fill in an empty scene."""
    return fill(stage.empty(SIZE, SIZE, 1))


def fill(scene):
    """Add boxes with modifiers shown or hidden in Edit mode, a linked duplicate, and instances by collection and by nodes.

    Return the scene, a box that is never edited, and three boxes to edit at once.
    """
    camera = stage.camera((0, 0, 20), (0, 0, 0), type="ORTHO", ortho_scale=float(SIZE))
    camera.rotation_euler = (0, 0, 0)
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling, cycles.pixel_filter_type = 1, False, False, "BOX"
    plain, edited = _box("Plain", (0.2, 0.4, 0.8), -7, -7), _box("Edited", (0.8, 0.2, 0.1), -4, -7)
    _repeated(edited, (0.0, 2.0, 0.0), show_in_editmode=False)
    _repeated(edited, (2.0, 0.0, 0.0), show_in_editmode=True)
    double = stage.link("Double", edited.data, (-3.5, 3.5, 0.5))
    _repeated(double, (0.0, -2.0, 0.0), show_render=False)
    wrapped = _box("Wrapped", (0.3, 0.9, 0.2), 2, -7)
    uvs = wrapped.data.uv_layers.new()
    tree = wrapped.data.materials[0].node_tree
    coordinates, emission = tree.nodes.new("ShaderNodeUVMap"), next(n for n in tree.nodes if n.type == "EMISSION")
    tree.links.new(coordinates.outputs[0], emission.inputs["Color"])
    for corner in uvs.data:
        corner.uv = (0.25, 0.75)
    keyed = _box("Keyed", (0.9, 0.8, 0.1), 2, -4)
    keyed.shape_key_add(name="Basis")
    moved = keyed.shape_key_add(name="Moved")
    for point in moved.data:
        point.co.x += 1.0
    moved.value = 1.0
    collection = bpy.data.collections.new("Set")
    scene.collection.children.link(collection)
    collection.objects.link(edited)
    empty = stage.link("Instances", None, (7, 9, 0))
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    holder = stage.link("Holder", bpy.data.meshes.new("Holder"), (-5.5, 6.5, 0.5))
    holder.modifiers.new("Nodes", "NODES").node_group = _instanced("Wrapped again", wrapped)
    plain.modifiers.new("Hair", "PARTICLE_SYSTEM")
    hair = plain.particle_systems[0].settings
    hair.type, hair.render_type = "HAIR", "NONE"
    return scene, plain, edited, wrapped, keyed


def _move(item, offset):
    """Move all vertices of a mesh in Edit mode, without tagging it as changed."""
    for vertex in bmesh.from_edit_mesh(item.data).verts:
        vertex.co.x += offset


def edit(edited, wrapped, keyed):
    """Enter Edit mode with all three, and move the vertices of two of them."""
    for item in (edited, wrapped, keyed):
        item.select_set(True)
    bpy.context.view_layer.objects.active = edited
    bpy.ops.object.mode_set(mode="EDIT")
    _move(edited, 1.0)
    _move(wrapped, 3.0)


def _compare(scene):
    """Render by both engines. Return the result of told, and our messages."""
    pictures = []
    for engine in ("LANCER", "CYCLES"):
        scene.render.engine = engine
        pictures.append(stage.picture(scene))
    return {**told(*pictures), "messages": export_told()[1].lines()}


def told(ours, cycles):
    """Return the largest difference from Cycles' picture, and our lit pixels, counted from the middle: [[x, y], ...]."""
    rows, columns = (ours[:, :, :3].max(axis=2) > 0.0).nonzero()
    lit = sorted(zip((columns - SIZE // 2).tolist(), (rows - SIZE // 2).tolist(), strict=True))
    return {"difference": float(abs(ours - cycles)[:, :, :3].max()), "lit": lit}


def modes():
    """Compare both engines in each mode, and return the mode after the render."""
    result = {}
    for mode in ("OBJECT", "EDIT", "SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT", "PARTICLE_EDIT"):
        scene, plain, *boxes = build()
        active = plain if mode == "PARTICLE_EDIT" else boxes[0]
        bpy.context.view_layer.objects.active = active
        if mode == "EDIT":
            edit(*boxes)
        else:
            bpy.ops.object.mode_set(mode=mode)
        result[mode] = _compare(scene)
        result[mode]["mode"] = [item.mode for item in (active, *boxes[1:])]
        bpy.ops.object.mode_set(mode="OBJECT")
    return result


def saved():
    """Save a file in Edit mode and open it again."""
    edit(*build()[2:])
    path = os.path.join(tempfile.mkdtemp(), "edited.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    return _compare(bpy.context.scene)


def exact():
    """Return the place of an exact sphere whose mesh is in Edit mode."""
    stage.empty()
    item = stage.cube(2.0)
    item.lancer.shape = "SPHERE"
    item.select_set(True)
    bpy.context.view_layer.objects.active = item
    bpy.ops.object.mode_set(mode="EDIT")
    _move(item, 1.0)
    snapshot, messages = export_told()
    return {"place": snapshot.instances.matrices[0].tolist(), "messages": messages.lines()}
