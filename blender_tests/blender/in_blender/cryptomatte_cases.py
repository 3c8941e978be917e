"""Cryptomatte in files: passes and metadata of both engines for one scene, decoded by the names of the manifest."""

import json
import os
import tempfile

import bpy
import exr
import numpy as np
import stage
from decoded_mattes import fields, mattes

_KINDS = ("Object", "Material", "Asset")
_SIZE, _SAMPLES = 32, 512


def _scene():
    """Build objects in relations that names depend on: children, instances, slots, a veil, a hole, a lamp."""
    scene = stage.empty(_SIZE, _SIZE, _SAMPLES)
    _even(scene)
    stage.plane(8.0, stage.shader(name="Stone"), rotation=(0.3, 0.2, 0.1)).name = "Boden / ground"
    top, middle = stage.link("Top", None), stage.link("Middle", None)
    middle.parent = top
    child = stage.cube(1.0, stage.shader(name="Rot"), location=(-1.5, 0.0, 0.7), rotation=(0.4, 0.3, 0.2))
    child.name, child.parent = "Würfel", middle
    child.data.materials.append(stage.shader(name="Blau"))
    child.data.polygons.foreach_set("material_index", [0, 1, 0, 1, 0, 1])
    bare = stage.cube(0.8, None, location=(1.4, 0.5, 0.6), rotation=(0.2, 0.1, 0.5))
    bare.name = "Bare"
    veil = stage.plane(1.5, _veil(0.4), location=(0.3, -1.0, 1.0), rotation=(1.2, 0.1, 0.2))
    veil.name = "Veil"
    hole = stage.cube(0.6, stage.shader(name="Hole"), location=(1.6, -1.4, 0.8), rotation=(0.5, 0.2, 0.1))
    hole.name, hole.is_holdout = "Hole", True
    inner = bpy.data.objects.new("Inner", child.data)
    collection = bpy.data.collections.new("Things")
    collection.objects.link(inner)
    placed = stage.link("Placed", None, location=(-0.2, 1.8, 0.6))
    placed.instance_type, placed.instance_collection, placed.parent = "COLLECTION", collection, top
    stage.light()
    stage.sky()
    stage.camera((0.0, -6.0, 4.0), (0.0, 0.0, 0.5))
    layer = scene.view_layers[0]
    for kind in _KINDS:
        setattr(layer, f"use_pass_cryptomatte_{kind.lower()}", True)
    layer.pass_cryptomatte_depth = 6
    return scene


def _even(scene):
    """Let both engines take every sample of every pixel, in a box."""
    cycles = scene.cycles
    cycles.device, cycles.samples = "CPU", _SAMPLES
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    scene.lancer.max_bounces = cycles.max_bounces = 1


def _veil(opacity):
    material = stage.shader(name="Veil")
    tree = material.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
    mix.inputs["Fac"].default_value = opacity
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(output.inputs["Surface"].links[0].from_socket, mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    return material


def _rendered(scene, engine):
    """Return the passes and the metadata of a file."""
    scene.render.engine = engine
    path = os.path.join(tempfile.mkdtemp(), f"{engine}.exr")
    exr.write_settings(scene, path)
    bpy.ops.render.render(write_still=True)
    return exr.read(path), exr.attributes(path)


def both():
    """Return for each kind the mattes' differences between the engines, and the metadata."""
    scene = _scene()
    files = {engine: _rendered(scene, engine) for engine in ("CYCLES", "LANCER")}
    result = {"passes": sorted(name for name in files["LANCER"][0] if name.startswith("Crypto"))}
    result["passes of cycles"] = sorted(name for name in files["CYCLES"][0] if name.startswith("Crypto"))
    for kind in _KINDS:
        title, decoded, told = f"Crypto{kind}", {}, {}
        for engine, (pictures, attributes) in files.items():
            told[engine] = fields(attributes, f"ViewLayer.{title}")
            names = json.loads(told[engine]["manifest"])
            decoded[engine] = mattes(pictures, title, names)
        ours, theirs = decoded["LANCER"], decoded["CYCLES"]
        result[kind] = {
            "fields": {
                engine: {name: found[name] for name in ("name", "hash", "conversion")} for engine, found in told.items()
            },
            "means": {name: [float(matte.mean()), float(theirs[name].mean())] for name, matte in ours.items()},
            "largest": {name: float(np.abs(matte - theirs[name]).max()) for name, matte in ours.items()},
            # Names that Cycles' picture shows and Lancer's manifest lacks.
            "missing": [name for name, matte in theirs.items() if matte.any() and name not in ours],
            "edges": {name: float((matte * (1.0 - matte)).sum()) for name, matte in ours.items()},
        }
    return result


def several():
    """Return what stays the same: with denoising, in a border, in a second view layer that hides an object."""
    scene = _scene()
    scene.lancer.samples = 16
    pictures, _ = _rendered(scene, "LANCER")
    plain = pictures["CryptoObject00"]
    scene.lancer.use_denoising = True
    denoised = _rendered(scene, "LANCER")[0]["CryptoObject00"]
    scene.lancer.use_denoising = False
    render = scene.render
    render.use_border, render.use_crop_to_border = True, True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.5, 1.0
    cropped = _rendered(scene, "LANCER")[0]["CryptoObject00"]
    render.use_border = False
    other = scene.view_layers.new("Other")
    other.use_pass_cryptomatte_object = True
    other.material_override = bpy.data.materials["Rot"]
    other.use_pass_cryptomatte_material = True
    path = os.path.join(tempfile.mkdtemp(), "layers.exr")
    exr.write_settings(scene, path)
    bpy.ops.render.render(write_still=True)
    attributes = exr.attributes(path)
    half = _SIZE // 2
    return {
        "denoised": bool(np.array_equal(plain, denoised)),
        "cropped": bool(np.array_equal(plain[:half, half // 2 : half // 2 + half], cropped)),
        "layers": sorted(
            value for key, value in attributes.items() if key.startswith("cryptomatte/") and key.endswith("/name")
        ),
        "overridden": json.loads(fields(attributes, "Other.CryptoMaterial")["manifest"]),
        "first": bool(np.array_equal(plain, exr.read(path, "ViewLayer")["CryptoObject00"])),
    }


def by_the_node():
    """Return the matte that Blender's own Cryptomatte node makes of Lancer's passes for one object, and the decoded one."""
    scene = _scene()
    scene.lancer.samples = 64
    name = "Boden / ground"
    folder = tempfile.mkdtemp()
    if hasattr(scene, "compositing_node_group"):
        tree = scene.compositing_node_group = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        result = tree.nodes.new("NodeGroupOutput")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        result = tree.nodes.new("CompositorNodeComposite")
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    node.source, node.scene = "RENDER", scene
    layers = tree.nodes.new("CompositorNodeRLayers")
    node.layer_name = "ViewLayer.CryptoObject"
    tree.links.new(layers.outputs["Image"], node.inputs["Image"])
    tree.links.new(node.outputs["Matte"], result.inputs[0])
    # The entries are there once a render has told the manifest.
    bpy.ops.render.render()
    node.matte_id = name
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "IMAGE"
    image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"
    scene.render.filepath = os.path.join(folder, "matte.exr")
    bpy.ops.render.render(write_still=True)
    made = stage.pixels(scene.render.filepath)[..., 0]
    if hasattr(scene, "compositing_node_group"):
        scene.compositing_node_group = None
    scene.use_nodes = False
    pictures, attributes = _rendered(scene, "LANCER")
    manifest = json.loads(fields(attributes, "ViewLayer.CryptoObject")["manifest"])
    decoded = mattes(pictures, "CryptoObject", manifest)[name][::-1]
    return {"difference": float(np.abs(made - decoded).max()), "mean": float(made.mean())}


def many_names(count):
    """Return the seconds of an F12 without and with mattes of as many objects, and the length of the manifest."""
    import time

    scene = stage.empty(64, 64, 4)
    mesh = stage.plane(0.01).data
    for number in range(int(count)):
        item = bpy.data.objects.new(f"object with a name {number}", mesh)
        item.location = number % 300 * 0.02 - 3.0, number // 300 * 0.02 - 3.0, 0.0
        scene.collection.objects.link(item)
    stage.sky()
    stage.camera((0, 0, 8), (0, 0, 0))
    layer, seconds = scene.view_layers[0], []
    for asked in (False, True):
        layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_asset = asked
        started = time.monotonic()
        _, attributes = _rendered(scene, "LANCER")
        seconds.append(time.monotonic() - started)
    manifest = fields(attributes, "ViewLayer.CryptoObject")["manifest"]
    return {"seconds": seconds, "names": len(json.loads(manifest)), "bytes": len(manifest)}
