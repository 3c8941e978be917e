"""Draw Lancer's panels, and Blender's panels that it supports, without a window."""

from dataclasses import replace

import bpy
import recording
import stage


def _variants(context):
    """Yield the name of each state that the context and the scene are put into."""
    from addon import engine
    from addon.measure.costs import Cost, Costs
    from addon.operators import measuring
    from addon.viewport import viewport

    yield "plain"
    bpy.ops.render.render()
    viewport.last_messages[context.scene] = engine.last_messages[context.scene]
    yield "rendered"
    bpy.ops.lancer.check_scene()
    yield "checked"
    name = context.scene.name
    text = "3 materials use refraction; without it this frame would take 22 % less time for the same samples"
    cost = Cost("glass", 3, 0.22, 0.02, 1.5, text, "they are opaque, in the same colour")
    engine.last_costs[name] = Costs((cost, replace(cost, share=0.01)), ("metal",), 6.8)
    yield "measured"
    engine.last_costs[name] = Costs()
    yield "measured, nothing found"
    measuring.running[name] = ("lancer.measure_features", 0.5, "3 materials use refraction")
    yield "measuring"
    del measuring.running[name]
    measuring.running[name] = ("lancer.measure_quality", 0.25, "Equal samples for all pixels")
    yield "measuring quality"
    del measuring.running[name]
    bpy.ops.lancer.measure_quality(seconds=0.1)
    yield "quality"
    context.scene.lancer.max_bounces += 1
    yield "quality of other settings"
    context.scene.lancer.max_bounces -= 1
    own = context.scene.lancer
    for integrator in own.bl_rna.properties["integrator"].enum_items.keys():
        own.integrator = integrator
        yield integrator
    for model in ("KD_KS", "PHONG", "BLINN_PHONG", "MINNAERT", "NODES"):
        context.material.lancer.model = model
        yield model
    context.camera.type = "PANO"
    panorama = context.camera if hasattr(context.camera, "panorama_type") else context.camera.cycles
    for projection in panorama.bl_rna.properties["panorama_type"].enum_items.keys():
        panorama.panorama_type = projection
        yield projection
    context.material.node_tree.nodes.clear()
    yield "material without output"
    context.world.node_tree.nodes.clear()
    yield "world without output"
    context.light.lancer.use_separate_colors = True
    if "use_temperature" in context.light.bl_rna.properties:
        context.light.use_temperature = True
    lamp = next(item for item in bpy.data.objects if item.type == "LIGHT")
    for kind in ("SUN", "SPOT", "AREA", "POINT"):
        lamp.data.type = kind
        # Only a newly fetched Python object has the type of the lamp's new kind.
        context.light = lamp.data
        yield kind
        if kind == "AREA":
            for shape in ("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"):
                lamp.data.shape = shape
                yield shape


def panels():
    """Draw every panel in many states. Return the words that they show, and the errors."""
    from addon import ui

    scene = stage.room(width=16, height=16, samples=1)
    cube = bpy.data.objects["Cube"]
    context = recording.Context(
        engine="LANCER",
        scene=scene,
        view_layer=scene.view_layers[0],
        object=cube,
        material=cube.data.materials[0],
        light=next(item.data for item in bpy.data.objects if item.type == "LIGHT"),
        camera=scene.camera.data,
        world=scene.world,
    )
    # Older Blenders have no texture cache.
    later = {"LANCER_RENDER_PT_texture_cache"} if bpy.app.version < (5, 2) else set()
    classes = [cls for cls in ui.CLASSES if cls.__name__ not in later]
    shown, errors = {cls.__name__: {} for cls in classes}, []
    context.light.use_nodes = True
    cube.modifiers.new("Subdivision", "SUBSURF")
    for variant in _variants(context):
        for cls in classes:
            try:
                if cls.poll(context):
                    shown[cls.__name__][variant] = recording.draw(cls, context).words
            except Exception as error:
                errors.append(f"{cls.__name__}, {variant}: {type(error).__name__}: {error}")
    things = dict.fromkeys(("object", "material", "light", "camera", "world"))
    nothing = recording.Context(engine="LANCER", scene=scene, **things)
    hidden = [cls.__name__ for cls in classes if not cls.poll(nothing)]
    context.engine = "CYCLES"
    foreign = [cls.__name__ for cls in ui.CLASSES if cls.poll(context)]
    return {"shown": shown, "errors": errors, "hidden": hidden, "foreign": foreign}


def tabs():
    """Return {tab and thing: the names of the panels that it shows; Lancer's own in their order}."""
    scene = stage.room()
    context = recording.Context(engine="LANCER", scene=scene, view_layer=scene.view_layers[0], world=scene.world)
    shown = {tab: _names(context, tab) for tab in ("render", "output", "view_layer", "scene", "world")}
    for thing in scene.objects:
        kind = thing.type.lower()
        of = recording.Context(
            **{"engine": "LANCER", "scene": scene, "view_layer": context.view_layer, "object": thing, "active_object": thing},
            **{kind: thing.data, "material": thing.active_material},
        )
        for tab in ("object", "data", "material"):
            shown[f"{tab} of a {kind}"] = _names(of, tab)
    context = recording.Context(engine="CYCLES", scene=scene, view_layer=scene.view_layers[0], world=scene.world)
    shown["other engine"] = [name for tab in ("render", "view_layer", "world") for name in _names(context, tab)]
    return shown


def _names(context, tab):
    from addon import ui

    shown = list(recording.shown_panels(context, tab))
    own = [cls for cls in ui.CLASSES if cls in shown]
    return [cls.__name__ for cls in shown if cls not in own] + [cls.__name__ for cls in own]


def cached():
    """Return how often a material's nodes are read while it is drawn, changed and drawn again, and the handlers that stay."""
    from addon import ui
    from addon.ui import described

    scene = stage.room()
    material = bpy.data.objects["Cube"].active_material
    context = recording.Context(engine="LANCER", scene=scene, material=material)
    reads, describe = [], described.describe_material
    described.describe_material = lambda read: reads.append(read.name) or describe(read)
    handlers = bpy.app.handlers.depsgraph_update_post
    before = list(handlers)

    def draw():
        return recording.draw(ui.material.LANCER_MATERIAL_PT_rendered, context).words

    try:
        first, again = draw(), draw()
        kept = len(reads)
        node = next(item for item in material.node_tree.nodes if item.type == "BSDF_DIFFUSE")
        unknown = stage.unknown(material.node_tree)
        material.node_tree.links.new(unknown.outputs["Color"], node.inputs["Color"])
        bpy.context.view_layer.update()
        lossy = draw()
        read_again = len(reads)
        material.node_tree.links.clear()
        bpy.context.view_layer.update()
        described._leave()
        return {
            "first": first,
            "again": again,
            "lossy": lossy,
            "reads": [kept, read_again],
            "left": handlers[:] == before,
        }
    finally:
        described.describe_material = describe
