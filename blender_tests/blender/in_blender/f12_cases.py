"""F12 as users press it: each function renders and returns the numbers that its test compares."""

import hashlib
import struct

import bpy
import numpy as np
import stage


def means(pixels):
    return [float(x) for x in pixels.mean(axis=(0, 1))]


def startup():
    """The scene that Blender starts with, of which only the engine is changed."""
    bpy.ops.wm.read_factory_settings(use_empty=False)
    scene = bpy.context.scene
    scene.render.engine = "LANCER"
    scene.render.resolution_x, scene.render.resolution_y = 48, 27
    scene.lancer.samples = 4
    pixels = stage.picture(scene)
    return {"size": pixels.shape[:2], "mean": means(pixels), "deviation": float(pixels[..., :3].std())}


def room():
    pixels = stage.picture(stage.room())
    return {"size": pixels.shape[:2], "mean": means(pixels), "finite": bool(np.isfinite(pixels).all())}


def point_light():
    """An albedo-1 plane under a lamp of 4 pi^2 watts, 1 m above: E = pi, so the middle of the plane shows 1."""
    scene = stage.empty(9, 9, 16)
    stage.plane(100.0, stage.shader(Color=(1.0, 1.0, 1.0)))
    stage.light("POINT", 4 * np.pi**2, (0, 0, 1), shadow_soft_size=0.0)
    stage.camera((0, 0, 0.5), (0, 0, 0), type="ORTHO", ortho_scale=1e-3)
    scene.lancer.max_bounces = 0
    return means(stage.picture(scene))


def fingerprint():
    """Return a hash of the file's whole content, down to every number of every mesh and every node."""
    digest = hashlib.sha256()

    def feed(*values):
        for value in values:
            if isinstance(value, float):
                digest.update(struct.pack("d", value))
            else:
                digest.update(repr(value).encode())

    def properties(item, depth=0):
        for prop in item.bl_rna.properties:
            name = prop.identifier
            if name in ("rna_type", "bl_rna", "original", "users", "session_uid", "filepath", "is_evaluated", "tag"):
                continue
            value = getattr(item, name, None)
            if prop.type in ("BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"):
                feed(name, list(value) if getattr(prop, "is_array", False) else value)
            elif prop.type == "POINTER" and value is not None and not isinstance(value, bpy.types.ID) and depth < 2:
                properties(value, depth + 1)

    for kind in ("objects", "meshes", "materials", "lights", "cameras", "worlds", "scenes", "collections", "node_groups"):
        for item in getattr(bpy.data, kind):
            feed(kind, item.name, item.users)
            properties(item)
            tree = getattr(item, "node_tree", None)
            for node in tree.nodes if tree else ():
                feed(node.name, node.type, [repr(getattr(s, "default_value", None)) for s in node.inputs])
            if kind == "meshes":
                numbers = np.empty(len(item.vertices) * 3, np.float32)
                item.vertices.foreach_get("co", numbers)
                digest.update(numbers.tobytes())
                feed([list(p.vertices) for p in item.polygons])
            if kind == "objects":
                feed([tuple(row) for row in item.matrix_world], [m.name if m else None for m in item.material_slots])
    feed({k: len(getattr(bpy.data, k)) for k in ("textures", "texts", "actions", "curves", "particles", "brushes")})
    return digest.hexdigest()


def untouched():
    scene = stage.room()
    stage.write_exr(scene)  # creates the Render Result and sets the output format
    bpy.context.view_layer.update()
    before = fingerprint()
    bpy.ops.render.render()
    bpy.context.view_layer.update()
    after = fingerprint()
    bpy.data.objects["Cube"].location.x += 1e-6
    bpy.context.view_layer.update()
    return {"before": before, "after": after, "changed": fingerprint()}


def sizes():
    """Return the sizes of pictures for border, crop and percentage, and the content inside and outside of a border."""
    scene = stage.room(width=40, height=30)
    result = {"plain": stage.picture(scene).shape[:2]}
    whole = stage.picture(scene)
    scene.render.resolution_percentage = 50
    result["percentage"] = stage.picture(scene).shape[:2]
    scene.render.resolution_percentage = 100
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.2, 0.6
    border = stage.picture(scene)
    result["border"] = border.shape[:2]
    result["border same"] = bool(np.array_equal(border[6:18, 10:30], whole[6:18, 10:30]))
    result["border outside"] = float(np.abs(border[20:]).max())
    scene.render.use_crop_to_border = True
    crop = stage.picture(scene)
    result["crop"] = crop.shape[:2]
    result["crop same"] = bool(crop.shape[:2] == (12, 20) and np.array_equal(crop, whole[6:18, 10:30]))
    return result


def shape_of_a_square():
    """Return width and height in pixels of a white square that faces the camera: for pixel aspect, portrait and shift."""
    scene = stage.empty(64, 64, 16)
    stage.plane(1.0, stage.shader("ShaderNodeEmission", Strength=1.0))
    eye = stage.camera((0, 0, 4), (0, 0, 0))
    result = {}

    def measure(name):
        lit = stage.picture(scene)[..., 0]
        rows, columns = np.nonzero(lit > 0.5)
        result[name] = [float(lit.sum(axis=1).max()), float(lit.sum(axis=0).max()), float(columns.mean()), float(rows.mean())]

    measure("square")
    scene.render.pixel_aspect_x = 2.0
    measure("wide pixels")
    scene.render.pixel_aspect_x = 1.0
    scene.render.resolution_x, scene.render.resolution_y = 32, 64
    measure("portrait")
    scene.render.resolution_x, scene.render.resolution_y = 64, 32
    measure("landscape")
    scene.render.resolution_y = 64
    eye.data.shift_x = 0.25
    measure("shift")
    eye.data.shift_x = 0.0
    eye.scale = (3.0, 3.0, 3.0)
    measure("scaled camera")
    return result


def filter_reach(width):
    """Return the means of the columns beside an edge between black and white, with the Blackman-Harris filter."""
    scene = stage.empty(32, 64, 256)
    scene.lancer.pixel_filter, scene.lancer.filter_width = "BLACKMAN_HARRIS", float(width)
    corners = [(0, -99, 0), (99, -99, 0), (99, 99, 0), (0, 99, 0)]
    stage.mesh("Half", corners, [(0, 1, 2, 3)], stage.shader("ShaderNodeEmission", Strength=1.0))
    # The wider side of the picture is 64 m: pixels of 1 m.
    stage.camera((0, 0, 5), (0, 0, 0), type="ORTHO", ortho_scale=64.0)
    return stage.picture(scene)[..., 0].astype(np.float64).mean(axis=0)[12:16].tolist()


def film_transparent():
    scene = stage.room()
    scene.render.film_transparent = True
    stage.bpy.data.objects["Plane"].hide_render = True
    pixels = stage.picture(scene)
    return {"corner": pixels[-1, 0].tolist(), "middle": pixels[16, 16].tolist()}


def view_layers():
    """Two view layers, one without the cube: the file has both, each with its own picture."""
    scene = stage.room()
    cube = stage.bpy.data.objects["Cube"]
    only = bpy.data.collections.new("Only here")
    scene.collection.children.link(only)
    scene.collection.objects.unlink(cube)
    only.objects.link(cube)
    second = scene.view_layers.new("Without")
    second.layer_collection.children["Only here"].exclude = True
    for layer in scene.view_layers:
        for name in ("z", "normal", "position", "object_index", "material_index"):
            setattr(layer, "use_pass_" + name, True)
    scene.lancer.use_pass_albedo = True
    path = stage.write_exr(scene, layers=True)
    image = bpy.data.images.load(path)
    result = {"channels": stage.channels(path), "layers": [layer.name for layer in scene.view_layers], "type": image.type}
    result["version"] = list(bpy.app.version[:2])
    scene.view_layers[0].use = False
    single = stage.picture(scene)
    scene.view_layers[0].use, second.use = True, False
    other = stage.picture(scene)
    result["difference"] = float(np.abs(single - other).max())
    return result


def engine_statistics():
    from addon.engine import render_engine as engine

    scene = stage.room()
    bpy.ops.render.render()
    return {key: value for key, value in engine.last_statistics[scene.name].items() if isinstance(value, (int, float, str))}


def progress():
    """Return the texts of the status line while rendering."""
    texts = []
    stage.room(width=128, height=128, samples=256)

    def note(*arguments):
        texts.append(str(arguments[0]))

    bpy.app.handlers.render_stats.append(note)
    bpy.ops.render.render()
    # As a module Blender 4.5 never exits while a handler is registered.
    bpy.app.handlers.render_stats.remove(note)
    return {"texts": texts}


def first_picture():
    """Return how many colours the first two pictures have, whether the first has large pixels, and the number of pictures."""
    from addon.bindings.enums import Pass
    from addon.engine import passes

    stage.room(width=640, height=360, samples=2)
    pictures = []
    fill = passes.fill

    def note(layer, read, wanted):
        pictures.append(read(Pass.COMBINED).copy() if len(pictures) < 2 else None)
        fill(layer, read, wanted)

    passes.fill = note
    try:
        bpy.ops.render.render()
    finally:
        passes.fill = fill
    colors = [len(np.unique(picture.reshape(-1, 4), axis=0)) for picture in pictures[:2]]
    coarse, covered = pictures[0], [bool((picture[..., 3] == 1.0).all()) for picture in pictures[:2]]
    large = bool((coarse[:, 0::8] == coarse[:, 7::8]).all() and (coarse[0::8] == coarse[7::8]).all())
    return {"colors": colors, "large": large, "covered": covered, "shown": len(pictures)}
