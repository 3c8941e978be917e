"""Images of materials, exported in a render: their pixels in the snapshot, and the state of Blender's images afterwards."""

import os
import tempfile

import bpy
import numpy as np
import stage
from export_cases import export_told

from addon.bindings import snapshot
from addon.bindings.enums import AlphaMode, NodeKind, Transfer
from addon.export.frames import file_of_frame
from addon.export.kept import Kept
from addon.export.parts import Parts
from addon.export.scene import ExportOptions, export_scene
from scenes.parity import avi, image_files

SIZE = 8


def ramp(channels=4):
    """Return (8, 8, channels) bytes that differ from texel to texel."""
    return (np.arange(SIZE * SIZE * channels) * 37 % 256).reshape(SIZE, SIZE, channels)


def image(name, values, space=None, is_float=False, **fields):
    """Return an image in memory. values: bytes, or floating point."""
    values = np.asarray(values, float)
    alpha = values.shape[2] == 4
    item = bpy.data.images.new(name, values.shape[1], values.shape[0], alpha=True, float_buffer=is_float)
    full = np.ones((*values.shape[:2], 4), np.float32)
    full[:, :, : values.shape[2]] = values if is_float else values / 255.0
    if not alpha:
        full[:, :, 3] = 1.0
    item.colorspace_settings.name = space or item.colorspace_settings.name
    item.pixels.foreach_set(full.ravel())
    for field, value in fields.items():
        setattr(item, field, value)
    return item


def write(path, values, space="sRGB", file_format="PNG", depth="8"):
    """Write the values to an image file."""
    item = image("written", values, space, is_float=depth != "8")
    scene = bpy.context.scene
    settings = scene.render.image_settings
    item.filepath_raw, item.file_format = path, file_format
    if depth == "8":
        item.save()
    else:
        settings.file_format, settings.color_mode, settings.color_depth = file_format, "RGBA", depth
        scene.view_settings.view_transform = "Raw" if bpy.app.version < (4, 0) else "Standard"
        item.save_render(path, scene=scene)
    bpy.data.images.remove(item)
    return path


def show(item, name="Material", **fields):
    """Add a cube whose colour is the image."""
    material = stage.shader("ShaderNodeBsdfDiffuse", name)
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = item
    for field, value in fields.items():
        setattr(node, field, value)
    tree.links.new(node.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
    stage.cube(material=material)
    return material, node


def told(picture):
    return {
        "name": picture.name,
        "texels": picture.texels.tolist(),
        "type": str(picture.texels.dtype),
        "transfer": Transfer(picture.transfer).name,
        "alpha": AlphaMode(picture.alpha).name,
        "tile": picture.tile,
        "matrix": picture.matrix,
    }


def listed():
    """Return the user's images and their state, without the images that a render adds."""
    return [
        (item.name, item.users, item.is_dirty, item.source, item.filepath, item.colorspace_settings.name, item.alpha_mode)
        for item in bpy.data.images
        if item.type != "RENDER_RESULT"
    ]


def answer():
    before = listed()
    snapshot, messages = export_told()
    nodes = [node for material in snapshot.materials for node in material.nodes if node.kind == NodeKind.IMAGE]
    return {
        "images": [told(picture) for picture in snapshot.images],
        "ranges": [[node.image, node.image_count] for node in nodes],
        "flags": [node.flags for node in nodes],
        "messages": list(messages),
        "unchanged": before == listed(),
        "version": list(bpy.app.version),
    }


def depths():
    """An image of each kind: bytes with and without alpha, data, floating point, linear bytes; the first has two users."""
    stage.empty()
    opaque = image("opaque", ramp(3))
    show(opaque)
    show(opaque, "Second")
    show(image("seen through", ramp()))
    show(image("data", ramp(), "Non-Color"))
    show(image("packed", ramp(), alpha_mode="CHANNEL_PACKED"))
    show(image("ignored", ramp(), alpha_mode="NONE"))
    show(image("bright", 4.0 * ramp(3) / 255.0, is_float=True))
    show(image("linear", ramp(3), "Linear" if bpy.app.version < (4, 0) else "Linear Rec.709"))
    return answer()


def spaces():
    """A colour space that is a matrix, one that is not, and the same bytes converted by Blender."""
    stage.empty()
    old = bpy.app.version < (4, 0)
    names = ("Linear ACES", "Filmic sRGB") if old else ("ACEScg", "Filmic sRGB")
    result = {}
    for name in names:
        show(image(name, ramp(3), name))
        folder = tempfile.mkdtemp()
        path = os.path.join(folder, "same.exr")
        plain = image("plain", ramp(3) / 255.0, "Non-Color", is_float=True)
        plain.filepath_raw, plain.file_format = path, "OPEN_EXR"
        plain.save()
        loaded = bpy.data.images.load(path)
        loaded.colorspace_settings.name = name
        values = np.empty(SIZE * SIZE * 4, np.float32)
        loaded.pixels.foreach_get(values)
        result[name] = values.reshape(SIZE, SIZE, 4)[:, :, :3].tolist()
    return {**answer(), "wanted": result}


def files():
    """Tiles under both naming schemes, one missing; a frame of a sequence; 16 bits; a missing file; no image at all."""
    scene = stage.empty()
    folder = tempfile.mkdtemp()
    for number, shift in ((1001, 0), (1002, 50), (1011, 100)):
        write(os.path.join(folder, f"tile.{number}.png"), (ramp(3) + shift) % 256)
    tiled = bpy.data.images.load(os.path.join(folder, "tile.1001.png"))
    tiled.name, tiled.source, tiled.filepath = "tiles", "TILED", os.path.join(folder, "tile.<UDIM>.png")
    for number in (1002, 1011, 1012):
        if number not in [tile.number for tile in tiled.tiles]:
            tiled.tiles.new(number)
    show(tiled)
    for frame in (1, 2, 3):
        write(os.path.join(folder, f"frame_{frame:03d}.png"), (ramp(3) + 10 * frame) % 256)
    sequence = bpy.data.images.load(os.path.join(folder, "frame_001.png"))
    sequence.name, sequence.source = "sequence", "SEQUENCE"
    _, node = show(sequence)
    node.image_user.frame_duration, node.image_user.frame_start = 3, 10
    scene.frame_set(11)
    deep = bpy.data.images.load(write(os.path.join(folder, "deep.png"), ramp(3) * 257 / 65535, "Non-Color", depth="16"))
    deep.name, deep.colorspace_settings.name = "deep", "Non-Color"
    show(deep)
    lost = bpy.data.images.load(os.path.join(folder, "tile.1001.png"))
    lost.name, lost.filepath = "lost", os.path.join(folder, "nowhere.png")
    lost.reload()
    show(lost, "Lost")
    show(None, "Empty")
    packed = bpy.data.images.load(os.path.join(folder, "frame_003.png"))
    packed.name = "in the file"
    packed.pack()
    show(packed)
    os.remove(os.path.join(folder, "frame_003.png"))
    for number, (column, row) in enumerate(((1, 1), (2, 1), (1, 2))):
        write(os.path.join(folder, f"grid.u{column}_v{row}.png"), (ramp(3) + 60 + 10 * number) % 256)
    grid = bpy.data.images.load(os.path.join(folder, "grid.u1_v1.png"))
    grid.name, grid.source, grid.filepath = "grid", "TILED", os.path.join(folder, "grid.<UVTILE>.png")
    for number in (1002, 1011):
        if number not in [tile.number for tile in grid.tiles]:
            grid.tiles.new(number)
    show(grid)
    return answer()


def deep():
    """Files of 16 bits and of floats: plain, with each alpha mode, packed, painted over, in another colour space."""
    stage.empty()
    values = ramp() / 255.0
    for kind in ("PNG", "TIFF", "OPEN_EXR"):
        path = image_files.write(kind, os.path.join(tempfile.mkdtemp(), "file"), values)
        for mode in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"):
            item = image_files.load(path, "sRGB")
            item.name, item.alpha_mode = f"{kind} {mode}", mode
            show(item)
        packed, data, other = (image_files.load(path, space) for space in ("sRGB", "Non-Color", "Filmic sRGB"))
        packed.name, data.name, other.name = f"{kind} packed", f"{kind} data", f"{kind} other"
        packed.pack()
        for item in (packed, data, other):
            show(item)
    # Blender has decoded it already, and does not decode it again for other readers.
    held = image_files.load(path, "sRGB")
    held.name = "held"
    held.pixels[0]
    painted = image_files.load(path, "sRGB")
    painted.name = "painted"
    painted.pixels[0] = 0.25
    for item in (held, painted):
        show(item)
    got = answer()
    previewed = export_scene(bpy.context.evaluated_depsgraph_get(), ExportOptions(is_preview=True))[0]
    stroke = next(picture for picture in previewed.images if picture.name == "painted")
    return {**got, "previewed stroke": float(stroke.texels[0, 0, 0])}


def movie():
    """A movie and a sequence under several nodes, exported at two frames twice by an animation's cache and by a view's."""
    scene = stage.empty()
    path = os.path.join(tempfile.mkdtemp(), "movie.avi")
    with open(path, "wb") as file:
        file.write(avi.encode([np.full((4, 4, 3), 0.1 * number) for number in range(1, 6)]))
    item = bpy.data.images.load(path)
    users = []
    for name, start, refresh in (("First", 1, True), ("Later", -1, False)):
        user = show(item, name)[1].image_user
        user.frame_start, user.frame_duration, user.use_auto_refresh = start, 5, refresh
        users.append(user)
    stage.camera()
    before, kept, parts = (listed(), len(bpy.data.textures)), Kept(), Parts()
    exports, counts, viewed = [], [], []
    for frame in (2, 2, 3):
        scene.frame_set(frame)
        kept.next_picture()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        exports.append(_reds(export_scene(depsgraph, ExportOptions(kept=kept))[0]))
        counts.append([kept.counts["read_images"], kept.counts["kept_images"]])
        viewed.append(_reds(export_scene(depsgraph, ExportOptions(view=snapshot.Camera(), parts=parts))[0]))
    return {
        "exports": exports,
        "viewed": viewed,
        "counts": counts,
        "unchanged": before == (listed(), len(bpy.data.textures)),
    }


def _reds(given):
    """Return the first byte of the image of each material."""
    return [int(given.images[material.nodes[-1].image].texels[0, 0, 0]) for material in given.materials]


_CODECS = ("NONE", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24")


def layered():
    """Files of a render's layers under each compression, beside the plain picture."""
    scene = stage.room(width=24, height=40, samples=1)
    wanted = stage.picture(scene)
    scene.view_layers[0].use_pass_normal = scene.view_layers[0].use_pass_z = True
    paths = []
    for codec in _CODECS:
        scene.render.image_settings.exr_codec = codec
        paths.append(stage.write_exr(scene, layers=True))
    stage.empty()
    for codec, path in zip(_CODECS, paths, strict=True):
        item = bpy.data.images.load(path)
        item.name = codec
        show(item)
    return {**answer(), "codecs": _CODECS, "wanted": wanted[:, :, :3].tolist()}


def damaged_layers():
    """A file of layers whose pixels are missing behind the first rows."""
    stage.empty()
    planes = {f"{part}.Pass.{shade}": np.full((SIZE, SIZE), 0.5) for part in "AB" for shade in "RGB"}
    path = image_files.write_layers(os.path.join(tempfile.mkdtemp(), "layers"), planes)
    os.truncate(path, os.path.getsize(path) // 2)
    item = bpy.data.images.load(path)
    item.name = "layers"
    show(item)
    return answer()


def numbered():
    """Return the names of frame 7 of files whose names have digits of Latin and of Arabic script."""
    return [file_of_frame(f"frame{digits}.png", 7) for digits in ("003", "\u0663", "12\u0663")]
