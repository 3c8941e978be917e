"""The features that a scene uses, as a render reports and the operator measures them; its own kernel and the general one."""

import dataclasses

import bpy
import numpy as np
import stage

import scenes
from addon.bindings.enums import Features, Integrator
from addon.bindings.session import Session
from addon.export.scene import export_scene


def _glassy(samples=4):
    scene = stage.room(width=32, height=18, samples=samples)
    glass = stage.shader("ShaderNodeBsdfGlass", "Glass", Color=(1.0, 1.0, 1.0))
    for i in range(12):
        stage.ball(0.9 - 0.05 * i, glass, segments=32, location=(0, -2, 1))
    return scene


def statistics():
    from addon import engine
    from addon.engine.account import MEMORY

    scene = _glassy()
    image = bpy.data.images.new("Checks", 16, 16)
    material = stage.shader(name="Pictured")
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    tree.links.new(node.outputs["Color"], next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE").inputs["Color"])
    bpy.data.objects["Cube"].data.materials[0] = material
    bpy.ops.render.render()
    numbers = engine.last_statistics[scene.name]
    return {
        "uses": numbers["uses"],
        "memory": {name: numbers[name] for name in MEMORY},
        "costs": numbers.get("feature_costs"),
    }


def plain_data():
    """Return every plain value in scenes, objects, materials, cameras, lamps and meshes: a measurement must not change them."""
    found = {}
    for group in (bpy.data.scenes, bpy.data.objects, bpy.data.materials, bpy.data.cameras, bpy.data.lights, bpy.data.meshes):
        for item in group:
            for owner in (item, getattr(item, "lancer", None), getattr(item, "render", None)):
                for name, prop in owner.bl_rna.properties.items() if owner is not None else ():
                    if prop.type in ("BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"):
                        value = getattr(owner, name)
                        found[f"{item.name_full} {owner.bl_rna.identifier} {name}"] = repr(
                            value[:] if hasattr(value, "__getitem__") and not isinstance(value, str) else value
                        )
    return found


def measured():
    """Run the operator without a window. Return its results, the kept results, and whether the file is unchanged."""
    from addon import engine
    from addon.operators import measure_features

    scene = _glassy()
    bpy.ops.render.render()
    before = plain_data()
    result = bpy.ops.lancer.measure_features(seconds=1.0)
    after = plain_data()
    costs = engine.last_costs[scene.name]
    kept = engine.last_statistics[scene.name]["feature_costs"]
    bpy.ops.render.render()
    old = [measure_features.is_old(scene)]
    bpy.data.objects["Cube"].location.x += 0.5
    bpy.context.view_layer.update()
    old.append(measure_features.is_old(scene))
    return {
        "result": sorted(result),
        "changed": [key for key in after if after[key] != before.get(key)],
        "compared": len(before),
        "costs": {cost.name: [cost.share, cost.uncertainty, cost.text] for cost in costs.measured},
        "hints": [cost.name for cost in costs.hints],
        "kept": sorted(kept),
        "old": old,
        "kept after a render": sorted(engine.last_statistics[scene.name]["feature_costs"]),
    }


def without_camera():
    """Without a camera the button is grey, and a script gets an error."""
    scene = stage.empty()
    stage.cube()
    try:
        bpy.ops.lancer.measure_features()
    except RuntimeError as error:
        return {"error": str(error), "camera": scene.camera is not None}
    return {"error": ""}


def both_kernels(name):
    """Return (kernels, largest difference) of both pictures of a scene, for each integrator."""
    scene = scenes.load(name)
    scene.render.engine = "LANCER"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 48, 27, 100
    scene.lancer.quality, scene.lancer.samples = "CUSTOM", 2
    snapshot, _ = export_scene(bpy.context.evaluated_depsgraph_get())
    result = {}
    for integrator in (Integrator.PATH, Integrator.CLASSIC):
        pictures, kernels = [], []
        for features in (Features.SCENE, Features.ALL):
            settings = dataclasses.replace(snapshot.settings, features=features, integrator=integrator)
            with Session.upload(dataclasses.replace(snapshot, settings=settings)) as session:
                session.render_all(2)
                pictures.append(session.read(0))
                kernels.append(session.statistics().kernel)
        result[integrator.name] = [kernels, float(np.abs(pictures[0] - pictures[1]).max()), float(pictures[0].mean())]
    return result
