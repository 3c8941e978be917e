"""start.py bench.bake_worker TASK JSON: one bake inside Blender's Python module; the answer is JSON."""

import time

import bpy
import numpy as np

from tools.harness import workers
from tools.harness.f12 import registered

from .worker import set_samples, set_up

# Parts of the light of a bake of one component.
_LIGHT = {"DIRECT", "INDIRECT", "COLOR"}


# Faces of one material in one plane shadow each other in Cycles alone. The object hovers above its ground, so far that light
# reaches its lower side, too.
_LIFT = 0.1


def _unwrapped(thing):
    """Select the object alone, with a mesh and faces of its own in the square of textures."""
    thing.data = thing.data.copy()
    thing.location.z += _LIFT
    bpy.ops.object.select_all(action="DESELECT")
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(island_margin=0.01)
    bpy.ops.object.mode_set(mode="OBJECT")


def _image(material, side):
    picture = bpy.data.images.new("Baked", side, side, float_buffer=True)
    picture.colorspace_settings.name = "Non-Color"
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, tree.nodes.active = picture, node
    return picture


def _pressed(kind, picture):
    """Bake, and return the seconds by the wall's clock and of all processors."""
    picture.pixels.foreach_set(np.zeros(len(picture.pixels), np.float32))
    options = {} if kind == "COMBINED" else {"pass_filter": _LIGHT}
    start = np.array([time.perf_counter(), time.process_time()])
    bpy.ops.object.bake(type=kind, margin=0, **options)
    return np.array([time.perf_counter(), time.process_time()]) - start


def bake(engine, name, thing, kind, side, threads, samples, seed, path):
    """Bake with one sample, then with all; write the colours of the texels with a surface, (texels, 3).

    seconds: of all samples without what one sample takes, which is the export and the tree; that is setup_seconds. cpu_seconds:
    the same of all processors, on which other programs have little influence.
    """
    scene = set_up(name, threads, bounces=4)
    _unwrapped(bpy.data.objects[thing])
    picture = _image(bpy.data.objects[thing].active_material, side)
    scene.render.engine = engine
    set_samples(scene, 1, 0)
    _pressed(kind, picture)
    one = _pressed(kind, picture)
    set_samples(scene, samples, seed)
    whole = _pressed(kind, picture)
    values = np.empty(len(picture.pixels), np.float32)
    picture.pixels.foreach_get(values)
    np.save(path, values.reshape(-1, 4)[:, :3])
    seconds, cpu = (whole - one).tolist()
    return {"seconds": seconds, "cpu_seconds": cpu, "setup_seconds": float(one[0])}


if __name__ == "__main__":
    registered(lambda: workers.answer(bake))
