"""Images that Cycles reads from the texture cache of Blender 5.2, exported in any Blender."""

import os
import shutil
import tempfile

import bpy
import numpy as np
import stage
from export_cases import ExportProbe, export_told
from image_cases import image, show, write

from addon.bindings.blocks import Blocks
from addon.bindings.enums import NODE_STEADY, NodeKind, Pass
from addon.bindings.session import Session
from addon.export import scene as scene_export
from addon.export import scratch
from addon.export.parts import Parts
from addon.export.scene import ExportOptions, export_scene
from addon.export.texture_cache import TextureCache, is_cached, texture_cache

WIDTH, HEIGHT = 700, 530
CACHE = TextureCache(True, "")


def _build(folder, source="file", is_turned=True):
    """Show a large image, whose coordinates are scaled, and may be rotated."""
    scene = stage.empty(48, 32, 4)
    texels = np.random.default_rng(1).integers(0, 256, (HEIGHT, WIDTH, 4))
    if source == "memory":
        picture = image("picture", texels)
    else:
        picture = bpy.data.images.load(write(os.path.join(folder, "picture.png"), texels))
    if source == "packed":
        picture.pack()
    show(picture)
    stage.sky()
    (cube,) = (thing for thing in bpy.data.objects if thing.type == "MESH")
    cube.data.uv_layers.new()
    tree = cube.data.materials[0].node_tree
    node = next(node for node in tree.nodes if node.type == "TEX_IMAGE")
    scaled, turned = tree.nodes.new("ShaderNodeVectorMath"), tree.nodes.new("ShaderNodeVectorRotate")
    scaled.operation, scaled.inputs[1].default_value = "MULTIPLY", (3.0, 2.0, 1.0)
    turned.inputs["Angle"].default_value = 0.3
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Object"], scaled.inputs[0])
    tree.links.new(scaled.outputs["Vector"], turned.inputs["Vector"])
    tree.links.new((turned if is_turned else scaled).outputs["Vector"], node.inputs["Vector"])
    return scene


def _exported(cache):
    real, scene_export.texture_cache = scene_export.texture_cache, lambda scene: cache
    try:
        told = export_told()
    finally:
        scene_export.texture_cache = real
    ExportProbe.caught = None
    return told


def _picture(snapshot):
    with Session.upload(snapshot) as session:
        assert session.render_all(4)
        return session.read(Pass.COMBINED).tobytes()


def asked():
    """Export with and without the cache, by where the image is."""
    answer = {}
    for source in ("file", "packed", "memory"):
        with tempfile.TemporaryDirectory() as folder:
            _build(folder, source)
            snapshots = [_exported(cache)[0] for cache in (None, CACHE)]
            answer[source] = [[picture.mipmaps for picture in snapshot.images] for snapshot in snapshots]
    nodes = [snapshot.materials[0].nodes for snapshot in snapshots]
    answer["steady"] = [[NodeKind(node.kind).name for node in of if node.flags & NODE_STEADY] for of in nodes]
    return answer


def unfollowed():
    """The messages of an operation whose change is not followed, with and without the cache."""
    with tempfile.TemporaryDirectory() as folder:
        _build(folder, is_turned=False)
        tree = next(thing for thing in bpy.data.objects if thing.type == "MESH").data.materials[0].node_tree
        next(node for node in tree.nodes if node.type == "VECT_MATH").operation = "POWER"
        return {"lines": [_exported(cache)[1].lines() for cache in (None, CACHE)]}


def bits():
    """Render with the levels in memory and in a file."""
    with tempfile.TemporaryDirectory() as folder:
        _build(folder, is_turned=False)
        plain, whole = _exported(CACHE)[0], _exported(None)[0]
        scratch.image_memory = 1
        moved = _exported(CACHE)[0]
        scratch.image_memory = 0
    return {
        "moved": [isinstance(picture.texels, Blocks) for picture in moved.images],
        "equal": _picture(plain) == _picture(moved),
        "differs": _picture(plain) != _picture(whole),
    }


def files():
    """Which files tell that Cycles has an image in its cache."""
    with tempfile.TemporaryDirectory() as folder:
        path = write(os.path.join(folder, "a.png"), np.zeros((4, 4, 4)))
        places = {"beside": os.path.join(folder, "blender_tx"), "given": os.path.join(folder, "given")}
        reads = TextureCache(False, "given")
        answer = {"none": is_cached(reads, path), "makes": is_cached(CACHE, path), "lost": is_cached(CACHE, path + "x")}
        for name, place in places.items():
            os.mkdir(place)
            made = os.path.join(place, f"a.png.0-{'0123456789ABCDEF' * 2}.tx")
            with open(made, "wb"):
                pass
            os.utime(made, (0, 0))
            answer[f"{name} outdated"] = is_cached(reads, path)
            shutil.copystat(path, made)
            answer[name] = is_cached(reads, path)
            os.rename(made, os.path.join(place, f"ab.png.0-{'0' * 32}.tx"))
        answer["other"] = is_cached(reads, path)
    return answer


def settings():
    """The settings of a scene, as the running Blender has them."""
    scene = bpy.context.scene
    render, found = scene.render, []
    for used, makes in ((True, False), (True, True), (False, True)):
        if hasattr(render, "use_texture_cache"):
            render.use_texture_cache, render.use_auto_generate_texture_cache = used, makes
        cache = texture_cache(scene)
        found.append(None if cache is None else cache.makes)
    return {"found": found, "has": hasattr(render, "use_texture_cache")}


def changed():
    """Export for a window, before and after the scene asks for the cache."""
    with tempfile.TemporaryDirectory() as folder:
        _build(folder)
        stage.camera()
        parts, found = Parts(), []
        real = scene_export.texture_cache
        for cache in (None, None, CACHE):
            scene_export.texture_cache = lambda scene, cache=cache: cache
            snapshot, _ = export_scene(bpy.context.evaluated_depsgraph_get(), ExportOptions(parts=parts))
            found.append([picture.mipmaps for picture in snapshot.images])
        scene_export.texture_cache = real
    return {"found": found}
