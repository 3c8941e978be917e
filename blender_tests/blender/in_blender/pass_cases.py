"""Passes as compositors read them: each pass that a view layer enables is in the file, with its name and its values."""

import os
import tempfile

import bpy
import exr
import numpy as np
import stage

_COMPONENTS = ("diffuse", "glossy", "transmission")
_SWITCHES = [f"{component}_{part}" for component in _COMPONENTS for part in ("direct", "indirect", "color")] + [
    "z", "mist", "position", "normal", "vector", "uv", "object_index", "material_index", "emit", "environment",
    "ambient_occlusion",
]  # fmt: skip


def _read(scene):
    """Return {pass: (height, width, channels)}, row 0 at the top, and the messages."""
    from addon.engine import render_engine as engine

    path = os.path.join(tempfile.mkdtemp(), "passes.exr")
    exr.write_settings(scene, path)
    bpy.ops.render.render(write_still=True)
    return exr.read(path), list(engine.last_messages[scene.name])


def _ask(layer, *switches, on=True):
    for switch in switches:
        setattr(layer, "use_pass_" + switch, on)


def _gallery():
    """Build something for each pass: diffuse, metal, glass and emissive objects under a lamp and a sky."""
    scene = stage.empty(48, 32, 16)
    floor = stage.plane(material=stage.shader(Color=(0.6, 0.5, 0.0)))
    layer = floor.data.uv_layers.new(name="Map")
    layer.data.foreach_set("uv", np.float32([0, 0, 1, 0, 1, 1, 0, 1]))
    stage.cube(material=stage.shader("ShaderNodeBsdfGlossy", Color=(0.9, 0.6, 0.3), Roughness=0.2), location=(-1.2, 0, 0.5))
    # One pane: emitters seen through it are its direct light, lit surfaces its indirect light.
    pane = stage.plane(1.2, stage.shader("ShaderNodeBsdfGlass", IOR=1.1), location=(1.0, -1, 0.7), rotation=(1.5, 0, 0))
    pane.pass_index = 7
    stage.cube(1.4, stage.shader("ShaderNodeEmission", Color=(1.0, 0.5, 0.2), Strength=3.0), location=(1.4, 1.5, 0.7))
    pane.data.materials[0].pass_index = 9
    stage.light(energy=300.0)
    stage.sky((0.3, 0.4, 0.6))
    eye = stage.camera((0, -5, 1.6), (0, 0, 0.9))
    for frame in (0, 2):
        eye.location.x = 0.2 * (frame - 1)
        eye.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    return scene


def _look(picture):
    return {
        "channels": picture.shape[2],
        "low": float(picture.min()),
        "high": float(picture.max()),
        "finite": bool(np.isfinite(picture).all()),
    }


def every_pass():
    scene = _gallery()
    layer = scene.view_layers[0]
    _ask(layer, *_SWITCHES)
    layer.cycles.denoising_store_passes = True
    pictures, messages = _read(scene)
    long_names = bpy.app.version >= (5, 0)
    short = {"diffuse": "Diff", "glossy": "Gloss", "transmission": "Trans", "direct": "Dir", "indirect": "Ind", "color": "Col"}

    def component(name, part):
        title = f"{name.capitalize()} {part.capitalize()}" if long_names else short[name] + short[part]
        return pictures[title].astype(np.float64)

    # The sum by which compositors rebuild the picture from its passes.
    total = pictures["Emission" if long_names else "Emit"] + pictures["Environment" if long_names else "Env"].astype(np.float64)
    for name in _COMPONENTS:
        total = total + component(name, "color") * (component(name, "direct") + component(name, "indirect"))
    combined = pictures["Combined"][..., :3]
    return {
        "version": list(bpy.app.version[:2]),
        "passes": {name: _look(picture) for name, picture in pictures.items()},
        "messages": messages,
        "difference": float(np.abs(total - combined).max() / combined.max()),
        "indices": sorted(set(pictures["Object Index" if long_names else "IndexOB"].ravel().tolist())),
        "materials": sorted(set(pictures["Material Index" if long_names else "IndexMA"].ravel().tolist())),
    }


def chosen_passes():
    """Return light groups, AOVs, sample counts and times of the gallery, with the names of the file."""
    scene = _gallery()
    layer = scene.view_layers[0]
    bpy.ops.scene.view_layer_add_lightgroup(name="lamps")
    bpy.ops.scene.view_layer_add_lightgroup(name="rest")
    scene.world.lightgroup = "rest"
    for thing in scene.objects:
        thing.lightgroup = "lamps" if thing.type == "LIGHT" else "rest"
    for name, kind in (("Tint", "COLOR"), ("Number", "VALUE"), ("Combined", "VALUE")):
        aov = layer.aovs.add()
        aov.name, aov.type = name, kind
    floor = bpy.data.objects["Plane"].data.materials[0]
    inner = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
    for tree, name, socket, value in (
        (floor.node_tree, "Tint", "Color", (0.25, 1.5, 2.0, 1.0)),
        # As in Cycles, also nodes inside groups write.
        (inner, "Number", "Value", 0.75),
        (floor.node_tree, "Nowhere", "Value", 5.0),
    ):
        node = tree.nodes.new("ShaderNodeOutputAOV")
        setattr(node, "aov_name" if hasattr(node, "aov_name") else "name", name)
        node.inputs[socket].default_value = value
    floor.node_tree.nodes.new("ShaderNodeGroup").node_tree = inner
    layer.cycles.pass_debug_sample_count = True
    if hasattr(layer.cycles, "pass_render_time"):
        layer.cycles.pass_render_time = True
    pictures, messages = _read(scene)
    combined = pictures["Combined"][..., :3].astype(np.float64)
    groups = [pictures[f"Combined_{name}"].astype(np.float64) for name in ("lamps", "rest")]
    return {
        "passes": {name: picture.shape[2] for name, picture in pictures.items()},
        "difference": float(np.abs(sum(groups) - combined).max() / combined.max()),
        "means": [float(group.mean()) for group in groups],
        "tints": np.unique(pictures["Tint"].reshape(-1, 4), axis=0)[[0, -1]].tolist(),
        "numbers": [float(pictures["Number"].min()), float(pictures["Number"].max())],
        "samples": np.unique(pictures["Debug Sample Count"]).tolist(),
        "time": float(pictures["Render Time"].min()) if "Render Time" in pictures else None,
        "messages": [line for line in messages if "pass" in line or "group" in line],
    }


def catchers():
    """Return the looks of a floor that catches shadows: of its pass, and of Combined with and without it, denoised and not."""
    scene = _gallery()
    layer = scene.view_layers[0]
    bpy.data.objects["Plane"].is_shadow_catcher = True
    scene.render.film_transparent = True
    found = {}
    for has_pass in (False, True):
        layer.cycles.use_pass_shadow_catcher = has_pass
        for denoises in (False, True):
            scene.lancer.use_denoising = denoises
            pictures, messages = _read(scene)
            name = f"{'pass' if has_pass else 'shadows'}{' denoised' if denoises else ''}"
            found[name] = {part: _look(pictures[part]) for part in ("Combined", "Shadow Catcher") if part in pictures}
            found[name]["alpha"] = _look(pictures["Combined"][..., 3:])
            found[name]["messages"] = [line for line in messages if "catcher" in line]
    return {"looks": found}


def no_pass():
    scene = _gallery()
    _ask(scene.view_layers[0], "z", on=False)
    pictures, messages = _read(scene)
    return {"passes": sorted(pictures), "messages": messages}


def missing_passes():
    """Return the messages about passes that are not supported."""
    scene = _gallery()
    _ask(scene.view_layers[0], "subsurface_direct", "cryptomatte_object")
    return _read(scene)[1]


def albedo_alone():
    scene = _gallery()
    _ask(scene.view_layers[0], "z", on=False)
    scene.lancer.use_pass_albedo = True
    return sorted(_read(scene)[0])


def known_numbers():
    """Return the passes' middle pixel, of a plane 4 m below a camera that looks straight down, under several settings."""
    scene = stage.empty(9, 9, 4)
    floor = stage.plane(2.0, stage.shader(Color=(0.8, 0.4, 0.2)))
    floor.pass_index = 3
    layer = floor.data.uv_layers.new(name="Map")
    layer.data.foreach_set("uv", np.float32([0, 0, 1, 0, 1, 1, 0, 1]))
    stage.sky()
    stage.camera((0, 0, 4), (0, 0, 0), type="ORTHO", ortho_scale=6.0)
    layer = scene.view_layers[0]
    _ask(layer, *_SWITCHES)
    layer.cycles.denoising_store_passes = True
    mist = scene.world.mist_settings
    mist.start, mist.depth = 1.0, 12.0
    result = {"mist": {}}
    for falloff in ("QUADRATIC", "LINEAR", "INVERSE_QUADRATIC"):
        mist.falloff = falloff
        pictures, _ = _read(scene)
        # In the middle, and two thirds of a metre beside it: the plane ends at 1 m.
        result["mist"][falloff] = [float(pictures["Mist"][4, column, 0]) for column in (4, 5)]
    result["sky mist"] = float(pictures["Mist"][0, 0, 0])
    for name in ("Depth", "Position", "Normal", "UV", "Denoising Normal", "Denoising Albedo", "Denoising Depth"):
        result[name] = [pictures[name][4, 4].tolist(), pictures[name][0, 0].tolist()]
    occlusion = "Ambient Occlusion" if bpy.app.version >= (5, 0) else "AO"
    result["open"] = pictures[occlusion][4, 4].tolist()
    # A lid 1 m above, hidden from camera rays: it occludes the whole sky near the middle.
    lid = stage.plane(200.0, location=(0, 0, 1))
    lid.visible_camera = False
    for distance in (0.5, 1e6):
        scene.world.light_settings.distance = distance
        result[f"under a lid, {distance:g}"] = _read(scene)[0][occlusion][4, 4].tolist()
    # A veil of opacity 0.3 above: the threshold decides which of the two is the first surface.
    lid.visible_camera = True
    lid.data.materials.append(_veil(0.3))
    for threshold in (0.2, 0.4):
        layer.pass_alpha_threshold = threshold
        result[f"veil, {threshold:g}"] = float(_read(scene)[0]["Depth"][4, 4, 0])
    return result


def _veil(opacity):
    material = stage.shader(Color=(0.5, 0.5, 0.5))
    tree = material.node_tree
    matt = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE")
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
    mix.inputs[0].default_value = opacity
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(matt.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    return material


def sockets():
    """Return the sockets of the compositor's Render Layers node, before any render, for Lancer's own switches."""
    scene = stage.room(width=16, height=16, samples=1)
    if bpy.app.version >= (5, 0):
        tree = scene.compositing_node_group = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
    node = tree.nodes.new("CompositorNodeRLayers")
    node.scene = scene

    def shown():
        return [output.name for output in node.outputs if output.enabled and output.name not in ("Image", "Alpha")]

    result = {"nothing": shown()}
    for name in ("use_pass_error", "use_pass_albedo", "use_denoising"):
        setattr(scene.lancer, name, True)
        result[name] = shown()
    scene.lancer.integrator = "NORMALS"
    result["integrator"] = shown()
    scene.lancer.use_pass_error = scene.lancer.use_pass_albedo = False
    result["off"] = shown()
    return result
