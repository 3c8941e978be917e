"""What a render tells: how often, of which render, and of which settings."""

import os
import tempfile

import bpy
import stage


def _told():
    """Renders; what the panel says then."""
    from addon import engine

    bpy.ops.render.render()
    return list(engine.last_messages[bpy.context.scene.name])


def _faulty(count):
    """Cubes with an empty material slot each, and one whose picture is missing in both of its uses."""
    scene = stage.empty()
    for i in range(count):
        stage.cube(location=(i, 0, 0)).data.materials.append(None)
    material = stage.shader(name="Painted")
    tree = material.node_tree
    matt = next(node for node in tree.nodes if node.type == "BSDF_DIFFUSE")
    picture = tree.nodes.new("ShaderNodeTexImage")
    tree.links.new(picture.outputs["Color"], matt.inputs["Color"])
    tree.links.new(picture.outputs["Alpha"], matt.inputs["Roughness"])
    stage.cube(location=(0, 2, 0), material=material)
    stage.camera()
    return scene


def persistent():
    """The same render three times with Persistent Data, one cube fewer in the last; then two frames."""
    from addon import engine

    scene = _faulty(2)
    scene.render.use_persistent_data = True
    result = {"first": _told()}
    samples = [engine.last_statistics[scene.name]["pixel_samples"]]
    result["second"] = _told()
    bpy.data.objects.remove(bpy.data.objects["Cube.001"])
    result["fewer"] = _told()
    samples.append(engine.last_statistics[scene.name]["pixel_samples"])
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = os.path.join(tempfile.mkdtemp(), "frame")
    bpy.ops.render.render(animation=True)
    result["animation"] = list(engine.last_messages[scene.name])
    result["samples"] = samples
    return result


def layers():
    """Two view layers, whose messages are of one picture; then the second of them alone."""
    result = {}
    for persistent_data in (False, True):
        scene = _faulty(2)
        scene.render.use_persistent_data = persistent_data
        scene.view_layers.new("Second")
        result[f"both {persistent_data}"] = _told()
        scene.view_layers[0].use = False
        result[f"second {persistent_data}"] = _told()
    return result


# Each of these differs from what Blender starts with, and says so by a word.
_SETTINGS = {
    "film_exposure": (2.0, "exposure"),
    "use_fast_gi": (True, "Fast GI"),
    "sample_clamp_direct": (1.0, "Clamp Direct"),
    "caustics_reflective": (False, "reflective caustics"),
    "caustics_refractive": (False, "refractive caustics"),
    "blur_glossy": (2.0, "Filter Glossy"),
    "diffuse_bounces": (0, "diffuse bounces"),
    "glossy_bounces": (1, "glossy bounces"),
    "transmission_bounces": (2, "transmission bounces"),
}
# And these change noise or time alone, are Lancer's own, or mean the same here.
_NEUTRAL = {
    "samples": 7, "seed": 5, "max_bounces": 3, "transparent_max_bounces": 3, "sample_clamp_indirect": 0.0, "blur_glossy": 0.0,
    "diffuse_bounces": 64, "pixel_filter_type": "BOX", "use_adaptive_sampling": False, "light_sampling_threshold": 0.1,
    "min_light_bounces": 3, "use_camera_cull": True, "texture_limit_render": "128", "ao_bounces_render": 3,
}  # fmt: skip


def settings():
    """Messages of the settings that Blender starts with, of neutral changes, and of each other change by itself."""
    from addon.export.checks import check_scene
    from addon.export.messages import Messages

    def told():
        messages = Messages()
        check_scene(bpy.context.scene, messages)
        return messages.lines()

    bpy.ops.wm.read_factory_settings(use_empty=False)
    result = {"start": told(), "words": {}}
    for name, value in _NEUTRAL.items():
        setattr(bpy.context.scene.cycles, name, value)
    result["neutral"] = told()
    bpy.ops.wm.read_factory_settings(use_empty=False)
    cycles = bpy.context.scene.cycles
    for name, (value, word) in _SETTINGS.items():
        start = getattr(cycles, name)
        setattr(cycles, name, value)
        result["words"][word] = told()
        setattr(cycles, name, start)
    render, cube = bpy.context.scene.render, bpy.data.objects["Cube"]
    render.use_simplify = True
    result["simplify"] = told()
    for switch in ("use_camera_cull", "use_distance_cull"):
        setattr(cycles, switch, True)
        result["nobody culled"] = told()
        setattr(cube.cycles, switch, True)
        result["words"][switch.split("_")[1] + " culling"] = told()
        setattr(cycles, switch, False)
    bpy.context.scene.camera.data.type = "PANO"
    cycles.use_camera_cull = True
    result["panorama"] = told()
    cycles.use_camera_cull = False
    cycles.texture_limit_render = "256"
    result["words"]["Texture Limit"] = told()
    return result


def objects():
    """Messages of single objects: plain, then with each setting that is not supported."""
    from addon.export.checks import check_object
    from addon.export.messages import Messages

    def told(thing):
        messages = Messages()
        check_object(thing, scene, messages)
        return messages.lines()

    scene = stage.empty()
    cube = stage.cube()
    result = {"plain": told(cube)}
    new = hasattr(cube, "shadow_terminator_shading_offset")
    owner, name = (cube, "shadow_terminator_shading_offset") if new else (cube.cycles, "shadow_terminator_offset")
    setattr(owner, name, 0.2)
    result["terminator"] = told(cube)
    setattr(owner, name, 0.0)
    cube.cycles.is_caustics_receiver = True
    result["caustics"] = told(cube)
    cube.cycles.is_caustics_receiver = False
    modifier = cube.modifiers.new("Round", "SUBSURF")
    result["divided"] = told(cube)
    if hasattr(modifier, "use_adaptive_subdivision"):
        modifier.use_adaptive_subdivision = True
    else:
        cube.cycles.use_adaptive_subdivision = True
        result["supported features"] = told(cube)
        scene.cycles.feature_set = "EXPERIMENTAL"
    result["adaptive"] = told(cube)
    modifier.show_render = False
    result["not rendered"] = told(cube)
    modifier.show_render = True
    cube.modifiers.new("Last", "SMOOTH")
    result["not last"] = told(cube)
    return result


def custom_group():
    """A node of an add-on's that holds a tree: Cycles goes into it as into a group."""
    from export_cases import export_told

    class Wrapper(bpy.types.ShaderNodeCustomGroup):
        bl_name = bl_idname = "LancerTestWrapper"
        bl_label = "Wrapper"

    stage.empty()
    group = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
    if hasattr(group, "interface"):
        group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    else:
        group.outputs.new("NodeSocketShader", "Shader")
    glow, end = group.nodes.new("ShaderNodeEmission"), group.nodes.new("NodeGroupOutput")
    glow.inputs["Color"].default_value = (0.25, 0.5, 0.75, 1.0)
    group.links.new(glow.outputs[0], end.inputs[0])
    material = stage.shader(name="Wrapped")
    tree = material.node_tree
    bpy.utils.register_class(Wrapper)
    node = tree.nodes.new("LancerTestWrapper")
    node.node_tree = group
    output = next(item for item in tree.nodes if item.type == "OUTPUT_MATERIAL")
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    stage.cube(material=material)
    snapshot, messages = export_told()
    return {"emission": list(snapshot.materials[0].emission), "messages": messages.lines()}


def empty_passes():
    """By integrator: which of all passes show nothing at all, and what is told."""
    import pass_cases

    result = {}
    for integrator in ("PATH", "CLASSIC", "NORMALS"):
        scene = pass_cases._gallery()
        pass_cases._ask(scene.view_layers[0], *pass_cases._SWITCHES)
        scene.view_layers[0].cycles.denoising_store_passes = True
        scene.lancer.integrator = integrator
        pictures, messages = pass_cases._read(scene)
        result[integrator] = {
            "black": sorted(name for name, picture in pictures.items() if not picture.any()),
            "told": [line for line in messages if "stay empty" in line],
        }
    return result
