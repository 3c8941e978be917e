"""A lamp that nearly touches the floor, so that its irradiance overflows single precision."""

import bpy
import numpy as np
import stage

from addon.engine import render_engine as engine


def _scene():
    scene = stage.empty(16, 16, samples=2)
    floor = stage.plane(material=stage.shader(Color=(0.5, 0.5, 0.5)))
    stage.light(energy=3e38, location=(0, 0, 1e-6), shadow_soft_size=0.0)
    stage.camera(location=(0, 0, 2), target=(0, 0, 0), type="ORTHO", ortho_scale=2e-4)
    return scene, floor


def not_told():
    scene, _ = _scene()
    try:
        picture, error = stage.picture(scene), ""
    except RuntimeError as failure:
        picture, error = np.zeros(1), str(failure)
    return {
        "error": error,
        "finite": bool(np.isfinite(picture).all()),
        "statistics": {k: v for k, v in engine.last_statistics.get(scene.name, {}).items() if k.startswith("invalid")},
        "messages": list(engine.last_messages.get(scene.name, ())),
    }


def told():
    return not_told()


told.overflows = True


def baked():
    """Bake a floor of few texels, so that those in the middle are as near to the lamp as pixels are."""
    scene, floor = _scene()
    floor.name, floor.scale = "Floor", (1e-5, 1e-5, 1.0)
    floor.data.uv_layers.new(name="UVMap")
    for corner, place in zip(floor.data.uv_layers[0].data, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
        corner.uv = place
    tree = floor.data.materials[0].node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("Baked", 16, 16, float_buffer=True)
    tree.nodes.active = node
    scene.render.engine = "LANCER"
    bpy.context.view_layer.update()
    floor.select_set(True)
    bpy.context.view_layer.objects.active = floor
    bpy.ops.object.bake(type="DIFFUSE")
    return {
        "finite": bool(np.isfinite(np.array(node.image.pixels[:])).all()),
        "messages": list(engine.last_messages.get(scene.name, ())),
    }


baked.overflows = True
