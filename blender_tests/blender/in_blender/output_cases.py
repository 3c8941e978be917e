"""What artists do with finished renders: files, metadata, slots and frames."""

import os
import struct

import bpy
import exr
import flat_stage
import stage


@flat_stage.by_both
def layered(engine):
    """Files of two view layers with passes, of half floats, full floats, and half floats of a part of the picture."""
    scene = flat_stage.begin(engine)
    only = flat_stage.second_layer(scene)
    flat_stage.patch(flat_stage.RED, 0, 0, collection=only)
    flat_stage.patch(flat_stage.GREEN, 8, 4)
    for layer in scene.view_layers:
        layer.use_pass_z = layer.use_pass_emit = layer.use_pass_object_index = True
    render = scene.render
    whole = {depth: layers(scene, engine, depth) for depth in ("16", "32")}
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.0, 0.75, 0.25, 1.0
    return {**whole, "part": layers(scene, engine, "16")}


def layers(scene, engine, depth):
    """Return the type, shape and colours of each pass of each layer in a file."""
    path = os.path.abspath(f"layers {engine}.exr")
    exr.write_settings(scene, path)
    scene.render.image_settings.color_depth = depth
    bpy.ops.render.render(write_still=True)
    files = {layer.name: exr.read(path, layer.name) for layer in scene.view_layers}
    return {
        layer: {name: [str(planes.dtype), list(planes.shape), flat_stage.colors(planes)] for name, planes in passes.items()}
        for layer, passes in files.items()
    }


def header(path):
    """Return the text attributes of an EXR file's first header."""
    with open(path, "rb") as file:
        data = file.read(1 << 16)
    at, found = 8, {}
    while data[at]:
        name, kind, size_at = exr_text(data, at)
        (size,) = struct.unpack_from("<i", data, size_at)
        if kind == "string":
            found[name] = data[size_at + 4 : size_at + 4 + size].decode()
        at = size_at + 4 + size
    return found


def exr_text(data, at):
    middle = data.index(b"\0", at)
    end = data.index(b"\0", middle + 1)
    return data[at:middle].decode(), data[middle + 1 : end].decode(), end + 1


def stamps(names):
    """Return the names of metadata, those of an engine by their view layer alone."""
    names = list(names)
    own = {name.split(".")[1] for name in names if name.startswith(("cycles.", "lancer."))}
    return {"own": sorted(own), "others": sorted(name for name in names if "." not in name)}


@flat_stage.by_both
def stamped(engine):
    """Metadata of a PNG and an EXR file of two layers, and whether text is burned in only where asked."""
    scene = flat_stage.begin(engine)
    flat_stage.patch(flat_stage.RED, 0, 0, collection=flat_stage.second_layer(scene))
    render = scene.render
    path = os.path.abspath(f"stamp {engine}.exr")
    render.use_stamp_note, render.stamp_note_text = True, "a note"
    plain = stage.picture(scene)
    result = {"exr": stamps(header(stage.write_exr(scene, path)))}
    flat_stage.as_file(scene, "PNG")
    render.filepath = os.path.abspath(f"stamp {engine}.png")
    bpy.ops.render.render(write_still=True)
    with open(render.filepath, "rb") as file:
        data = file.read()
    result["png"] = stamps(png_texts(data))
    render.use_stamp = True
    result["burned"] = bool((stage.picture(scene) != plain).any())
    return result


def png_texts(data):
    at = 8
    while at < len(data):
        (size,) = struct.unpack_from(">I", data, at)
        if data[at + 4 : at + 8] == b"tEXt":
            yield data[at + 8 : at + 8 + size].split(b"\0")[0].decode()
        at += size + 12


@flat_stage.by_both
def slots(engine):
    """Two slots keep their own pictures, and a third stays empty."""
    scene = flat_stage.begin(engine)
    item = flat_stage.patch(flat_stage.RED, 0, 0)
    result = {}
    bpy.ops.render.render()
    image = bpy.data.images["Render Result"]
    image.render_slots.new(name="Mine")
    image.render_slots.active_index = 1
    item.material_slots[0].material = stage.shader("ShaderNodeEmission", Color=flat_stage.BLUE, Strength=1.0)
    bpy.ops.render.render()
    flat_stage.as_file(scene)
    for index in (0, 1):
        image.render_slots.active_index = index
        path = os.path.abspath(f"slot {engine} {index}.exr")
        image.save_render(path, scene=scene)
        result[str(index)] = flat_stage.colors(stage.pixels(path))
    image.render_slots.active_index = 2
    path = os.path.abspath(f"slot {engine} 2.exr")
    try:
        image.save_render(path, scene=scene)
    except RuntimeError:
        pass
    result["2"] = os.path.exists(path)
    return result


@flat_stage.by_both
def written(engine):
    """Names of files after renders with and without write_still, with and without extension."""
    scene = flat_stage.begin(engine)
    folder = os.path.abspath(f"written {engine}")
    render = scene.render
    flat_stage.as_file(scene, "PNG")
    render.filepath = os.path.join(folder, "new", "still_##")
    bpy.ops.render.render()
    result = {"none": os.path.exists(folder)}
    bpy.ops.render.render(write_still=True)
    render.use_file_extension = False
    render.filepath = os.path.join(folder, "bare")
    bpy.ops.render.render(write_still=True)
    result["files"] = sorted(
        os.path.join(os.path.relpath(at, folder), name) for at, _, names in os.walk(folder) for name in names
    )
    # A patch of one view layer alone.
    flat_stage.patch(flat_stage.RED, 0, 0, collection=flat_stage.second_layer(scene))
    flat_stage.as_file(scene)
    render.filepath = os.path.join(folder, "layer.exr")
    bpy.ops.render.render(write_still=True, layer="Second", scene=scene.name)
    result["layer"] = flat_stage.colors(stage.pixels(render.filepath))
    return result


@flat_stage.by_both
def animated(engine):
    """Frames 1, 3, 5, 7 with placeholders, of which 3 is there and may not be replaced; then all of them once more, twice."""
    scene = flat_stage.begin(engine)
    item = flat_stage.patch(flat_stage.RED, 0, 0)
    for frame in range(1, 8):
        item.location.x = frame - 1.0
        item.keyframe_insert("location", frame=frame)
    folder = os.path.abspath(f"frames {engine}")
    os.makedirs(folder)
    render = scene.render
    flat_stage.as_file(scene)
    render.filepath = os.path.join(folder, "")
    scene.frame_start, scene.frame_end, scene.frame_step = 1, 7, 2
    render.use_overwrite, render.use_placeholder = False, True
    with open(os.path.join(folder, "0003.exr"), "wb") as file:
        file.write(b"mine")
    seen = []

    def note(*_):
        seen.append({name[:4]: os.path.getsize(os.path.join(folder, name)) > 4 for name in sorted(os.listdir(folder))})

    def write(*_):
        saved.append(scene.frame_current)

    saved = []
    bpy.app.handlers.render_pre.append(note)
    bpy.app.handlers.render_write.append(write)
    bpy.ops.render.render(animation=True)
    bpy.app.handlers.render_pre.remove(note)
    result = {"seen": seen, "written": list(saved)}
    result["kept"] = os.path.getsize(os.path.join(folder, "0003.exr"))
    names = ("0001", "0005", "0007")
    result["frames"] = {name: flat_stage.first_red(stage.pixels(os.path.join(folder, f"{name}.exr"))) for name in names}
    # All are there.
    saved.clear()
    bpy.ops.render.render(animation=True)
    bpy.app.handlers.render_write.remove(write)
    result["again"] = list(saved)
    render.use_overwrite, render.use_placeholder = True, False
    bpy.ops.render.render(animation=True)
    result["replaced"] = flat_stage.first_red(stage.pixels(os.path.join(folder, "0003.exr")))
    return result
