"""Pictures with Persistent Data, each after one edit: what is read, and whether the snapshot equals that of a full export."""

import dataclasses
import os
import tempfile

import bpy
from parts_cases import build, edit_material, edit_mesh, plain, set_to

from addon.export.images import Images
from addon.export.scene import export_scene


def _animate(name, path, first, last):
    thing = bpy.data.objects[name]
    for frame, value in ((1, first), (3, last)):
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)


def _later():
    bpy.context.scene.frame_set(bpy.context.scene.frame_current % 3 + 1)


def _add():
    twin = bpy.data.objects["Other"].copy()
    twin.location.x = 8.0
    bpy.context.scene.collection.objects.link(twin)


def _collect():
    collection = bpy.data.collections.new("Lone")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(bpy.data.objects["Lone"])
    bpy.context.scene.collection.objects.unlink(bpy.data.objects["Lone"])


def _shape():
    """Blender does not report a script's change of an add-on's property, but that the object moves."""
    bpy.data.objects["Twin"].lancer.shape = "SPHERE"
    bpy.data.objects["Twin"].location.y = 0.5


def _parent():
    """Blender then evaluates the objects in another order."""
    bpy.data.objects["Plain"].parent = bpy.data.objects["Lone"]


def _link():
    bpy.data.objects["Other"].material_slots[0].link = "OBJECT"


def _drive():
    """Hide two objects by drivers, the one before the third frame and the other from it on."""
    bpy.context.scene.frame_set(2)
    for name, expression in (("Twin", "frame < 3"), ("Keyed", "frame >= 3")):
        bpy.data.objects[name].driver_add("hide_render").driver.expression = expression


def _pack(value):
    """Pack an image of another colour, whose file always has the same size."""

    def edit():
        folder = tempfile.mkdtemp()
        made = bpy.data.images.new("made", 8, 8)
        made.pixels.foreach_set([value, 0.5, 0.25, 1.0] * 64)
        made.filepath_raw, made.file_format = os.path.join(folder, "made.bmp"), "BMP"
        made.save()
        bpy.data.images.remove(made)
        with open(os.path.join(folder, "made.bmp"), "rb") as file:
            data = file.read()
        next(image for image in bpy.data.images if image.name.startswith("first")).pack(data=data, data_len=len(data))

    return edit


def _both_at_once():
    _later()
    bpy.data.objects["Pictured"].visible_camera = False


# The counts of objects, meshes and shaders that a picture with Persistent Data reads after each edit.
_EDITS_OF_PICTURES = {
    "nothing": lambda: None,
    "output path": set_to("scene.render.filepath", "//other"),
    "moved object": set_to("objects['Lone'].location", (6, 1, 0)),
    "stretched object": set_to("objects['Lone'].scale", (1, 1, 3)),
    "moved camera": set_to("objects['Camera'].location", (1, -6, 3)),
    "edited material": edit_material,
    "edited mesh": edit_mesh,
    "edited lamp": set_to("bpy.data.lights[0].energy", 50.0),
    "hidden object": set_to("objects['Other'].hide_render", True),
    "shown object": set_to("objects['Other'].hide_render", False),
    "object index": set_to("objects['Twin'].pass_index", 3),
    "shape": _shape,
    "parent": _parent,
    "moved parent": set_to("objects['Lone'].location", (6, 2, 0)),
    "link of a slot": _link,
    "packed picture": _pack(0.25),
    "packed anew": _pack(0.75),
    "another world": lambda: setattr(bpy.context.scene, "world", bpy.data.worlds.new("Another")),
    "no surfaces": set_to("bpy.context.view_layer.use_solid", False),
    "collection": _collect,
    "surfaces": set_to("bpy.context.view_layer.use_solid", True),
    "holdout": set_to("bpy.context.view_layer.layer_collection.children[0].holdout", True),
    "excluded": set_to("bpy.context.view_layer.layer_collection.children[0].exclude", True),
    "removed object": lambda: bpy.data.objects.remove(bpy.data.objects["Placed"]),
    "added object": _add,
    "keyed": lambda: _animate("Pictured", "location", (2, 0, 0), (2, 2, 0)),
    "frame": _later,
    "frame again": _later,
    "frame and edit": _both_at_once,
    "keyed index": lambda: _animate("Pictured", "pass_index", 1, 5),
    "frame with index": _later,
    "moved for a while": set_to("objects['Pictured'].delta_location", (0, 0, 1)),
    "drivers": _drive,
    "driven": _later,
}


def pictures():
    """Press F12 with Persistent Data after each edit. Return {edit: (counts, same snapshot, same messages)}.

    Each export is compared with one of everything from the same depsgraph.
    """
    from addon.engine import render_engine

    scene = build()
    # The shape key would change a mesh in each frame.
    bpy.data.objects["Keyed"].shape_key_clear()
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.lancer.samples = 1
    scene.render.use_persistent_data = True
    compared, results = [], {}

    export_picture = render_engine.export_picture

    def export(depsgraph, options, frame_set, poll):
        got, messages = export_scene(depsgraph, options, poll)
        whole, others = export_scene(depsgraph, dataclasses.replace(options, parts=None, on_mesh=None), poll)
        same = messages.lines() == others.lines()
        compared.append((options.parts and dict(options.parts.counts), plain(got) == plain(whole), same))
        return got, messages

    render_engine.export_picture = export
    try:
        for name, edit in {"first": lambda: None, **_EDITS_OF_PICTURES}.items():
            edit()
            bpy.ops.render.render()
            (results[name],) = compared
            compared.clear()
    finally:
        render_engine.export_picture = export_picture
    return results


def packed():
    """Return how many packed files were read anew by an animation of four frames with Persistent Data, and by F12 after it."""
    scene = build()
    _pack(0.5)()
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.lancer.samples = 1
    scene.render.use_persistent_data = True
    scene.frame_start, scene.frame_end = 1, 4
    scene.render.filepath = os.path.join(tempfile.mkdtemp(), "frame")
    read, changed, counts = [], Images.changed, []

    def watched(images):
        before = len(images.digests)
        found = changed(images)
        read.append(len(images.digests) - before)
        return found

    Images.changed = watched
    try:
        for is_animation in (True, False):
            bpy.ops.render.render(animation=is_animation)
            counts.append(list(read))
            read.clear()
    finally:
        Images.changed = changed
    return counts
