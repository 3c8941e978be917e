"""Small files as artists save them, and the features that a render of them misses."""

import os

import bpy
import stage


def files(folder):
    """Write the files that test_corpus_files.py renders."""
    _alike()
    _save(folder, "alike.blend")
    _fog()
    _save(folder, os.path.join("deep", "fog.blend"))
    _without_camera()
    _save(folder, "nocamera.blend")
    return sorted(os.listdir(folder))


def _save(folder, name):
    path = os.path.join(folder, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=path, compress=True)


def _lit_cube(engine):
    scene = stage.empty(200, 100, engine=engine)
    stage.plane(material=stage.shader(Color=(0.6, 0.5, 0.4, 1.0)))
    stage.cube(material=stage.shader(Color=(0.2, 0.4, 0.8, 1.0)), location=(0, 0, 0.5))
    stage.light("AREA", 200.0, size=2.0)
    stage.sky()
    return scene


def _alike():
    """A file with every setting on that limits light, or that ends or denoises a render; it has two view layers."""
    scene = _lit_cube("CYCLES")
    stage.camera()
    scene.render.resolution_percentage = 50
    scene.render.use_stamp = True
    scene.view_layers.new("Second")
    cycles = scene.cycles
    cycles.samples, cycles.max_bounces, cycles.diffuse_bounces, cycles.glossy_bounces = 3, 6, 0, 1
    cycles.sample_clamp_direct, cycles.sample_clamp_indirect, cycles.blur_glossy = 0.2, 0.1, 1.0
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = True
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.film_exposure, cycles.pixel_filter_type, cycles.filter_width = 3.0, "GAUSSIAN", 2.5
    cycles.use_animated_seed = True
    scene.lancer.max_bounces, scene.lancer.clamp_indirect, scene.lancer.pixel_filter = 1, 0.1, "BOX"


def _fog():
    """A volume that only absorbs, in a cube without a surface shader."""
    scene = _lit_cube("CYCLES")
    stage.camera()
    material = bpy.data.materials.new("Fog")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output, fog = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeVolumeAbsorption")
    fog.inputs["Density"].default_value = 5.0
    fog.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    tree.links.new(fog.outputs["Volume"], output.inputs["Volume"])
    scene.objects["Cube"].data.materials[0] = material


def _without_camera():
    scene = _lit_cube("BLENDER_WORKBENCH")
    scene.camera = None


def missing():
    """Return {key: count} and the lines of a render that lacks a feature and, twice, a node, and of one without the feature."""
    from addon.engine import render_engine as engine

    scene = _lit_cube("LANCER")
    stage.camera()
    stage.light_paths_alike(scene)
    for number in (1, 2):
        material = stage.shader(name=f"Wax {number}")
        tree = material.node_tree
        tree.links.new(stage.unknown(tree).outputs["Color"], tree.nodes[0].inputs["Color"])
        stage.cube(material=material, location=(2 * number, 0, 0.5))
    # A warning does not count as a missing feature.
    scene.objects["Cube"].data.materials[0] = None
    scene.objects["Cube"].cycles.is_caustics_receiver = True
    result = {}
    for name in ("first", "second"):
        bpy.ops.render.render()
        result[name] = dict(engine.last_missing[scene.name])
        result[f"{name} lines"] = list(engine.last_messages[scene.name])
        scene.objects["Cube"].cycles.is_caustics_receiver = False
    return result
