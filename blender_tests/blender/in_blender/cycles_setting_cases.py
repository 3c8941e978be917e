"""Cycles' own settings: which there are, which of them an export reports, and how Lancer takes them over."""

import bpy
import stage

from addon.export.cycles_properties import PROPERTIES, Fate
from addon.export.scene import ExportOptions, export_scene


def _groups():
    """{name of a type that the Cycles add-on gives to Blender's data: names of its properties}"""
    types = (getattr(bpy.types, name) for name in dir(bpy.types))
    fields = (field for kind in types if hasattr(kind, "bl_rna") for field in kind.bl_rna.properties)
    held = {field.fixed_type.identifier: field.fixed_type for field in fields if field.type == "POINTER"}
    return {
        name: [field.identifier for field in kind.properties if field.identifier not in ("name", "rna_type")]
        for name, kind in held.items()
        if name.startswith("Cycles")
    }


def _stage():
    """(scene, {type: an owner}) of a scene in which every setting that is reported acts."""
    scene = stage.empty()
    scene.lancer.pixel_filter = scene.cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    cube = stage.cube(material=stage.shader())
    cube.modifiers.new("Round", "SUBSURF")
    lamp = stage.light("AREA")
    world = stage.sky()
    stage.camera()
    # A sky that varies is sampled.
    tree = world.node_tree
    gradient = tree.nodes.new("ShaderNodeTexGradient")
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    tree.links.new(gradient.outputs["Color"], background.inputs["Color"])
    scene.render.use_simplify = True
    layer = bpy.context.view_layer
    layer.cycles.denoising_store_passes = True
    if "feature_set" in scene.cycles.bl_rna.properties:
        scene.cycles.feature_set = "EXPERIMENTAL"
    owners = (scene.cycles, layer.cycles, cube.cycles, lamp.data.cycles, world.cycles)
    return scene, {owner.bl_rna.identifier: owner for owner in owners}


# A setting that needs another one to act: (type, that one).
_BESIDE = {
    ("CyclesRenderSettings", "use_camera_cull"): ("CyclesObjectSettings", "use_camera_cull"),
    ("CyclesRenderSettings", "use_distance_cull"): ("CyclesObjectSettings", "use_distance_cull"),
    ("CyclesObjectSettings", "use_camera_cull"): ("CyclesRenderSettings", "use_camera_cull"),
    ("CyclesObjectSettings", "use_distance_cull"): ("CyclesRenderSettings", "use_distance_cull"),
}


def _other(owner, name):
    """Another value than Blender starts with, and within the limits of any integer or share."""
    field = owner.bl_rna.properties[name]
    if field.type == "BOOLEAN":
        return not field.default
    if field.type == "ENUM":
        return next(item.identifier for item in field.enum_items if item.identifier != field.default)
    return 0 if field.type == "INT" else 0.5


def _told():
    """The groups of the running Blender, and the lines that each property which is TOLD here adds to an export's messages."""
    scene, owners = _stage()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    _, at_first = export_scene(depsgraph)
    # Textures are limited otherwise in a view.
    view = export_scene(depsgraph)[0].camera

    def lines(in_view):
        return set(export_scene(bpy.context.evaluated_depsgraph_get(), ExportOptions(view=view if in_view else None))[1])

    added, plain = {}, {in_view: lines(in_view) for in_view in (False, True)}
    for kind, listed in PROPERTIES.items():
        owner = owners.get(kind)
        for name, entry in listed.items():
            if entry.fate != Fate.TOLD or bpy.app.version >= entry.before or name not in owner.bl_rna.properties:
                continue
            in_view, value = name in ("texture_limit", "texture_resolution"), getattr(owner, name)
            beside = _BESIDE.get((kind, name))
            if beside:
                # By itself it adds no line.
                setattr(owners[beside[0]], beside[1], True)
                assert lines(in_view) == plain[in_view]
            setattr(owner, name, _other(owner, name))
            owner.id_data.update_tag()
            added[f"{kind}.{name}"] = sorted(lines(in_view) - plain[in_view])
            setattr(owner, name, value)
            if beside:
                setattr(owners[beside[0]], beside[1], False)
            owner.id_data.update_tag()
    return {"groups": _groups(), "added": added, "first": at_first.lines(), "version": bpy.app.version[:2]}


def _glass():
    """(transparent_glass, glass_roughness) of an export, with one setting after the other; and the panel's owner."""
    from addon.export.settings import glass_owner

    scene = stage.empty()
    stage.camera()

    def now():
        settings = export_scene(bpy.context.evaluated_depsgraph_get())[0].settings
        return [glass_owner(scene).bl_rna.identifier, bool(settings.transparent_glass), round(settings.glass_roughness, 6)]

    found = {"start": now()}
    scene.cycles.film_transparent_glass, scene.cycles.film_transparent_roughness = True, 0.5
    found["Cycles'"] = now()
    scene.lancer.film_transparent_glass = False
    found["own"] = now()
    return found


# Other values than both engines start with.
_THEIRS = {
    "samples": 77, "adaptive_threshold": 0.02, "time_limit": 9.0, "seed": 5, "use_animated_seed": True, "max_bounces": 7,
    "diffuse_bounces": 2, "glossy_bounces": 9, "transmission_bounces": 3, "blur_glossy": 0.5,
    "transparent_max_bounces": 1024, "sample_clamp_indirect": 3.5, "pixel_filter_type": "GAUSSIAN", "filter_width": 2.0,
    "preview_samples": 33, "film_transparent_glass": True, "film_transparent_roughness": 0.25,
}  # fmt: skip
_OURS = (
    "samples", "target_error", "time_limit", "seed", "use_animated_seed", "max_bounces", "diffuse_bounces",
    "glossy_bounces", "transmission_bounces", "filter_glossy", "transparent_bounces", "clamp_indirect", "pixel_filter",
    "filter_width", "preview_samples", "use_denoising", "use_preview_denoising",
)  # fmt: skip


def _values(owner, names):
    values = {name: getattr(owner, name) for name in names}
    return {name: round(value, 6) if isinstance(value, float) else value for name, value in values.items()}


def _all_of(cycles):
    return {field.identifier: str(getattr(cycles, field.identifier)) for field in cycles.bl_rna.properties}


def _offered(scene):
    import recording

    record = recording.drawn(recording.Context(engine="LANCER", scene=scene), "render")["LANCER_RENDER_PT_sampling"]
    return [word for word in record.words if word == "lancer.take_over_cycles" or word.startswith("Changes ")]


def _take_over():
    """The settings before and after the operator, and the panel's offer before and after."""
    from addon.operators import take_over_cycles

    scene = stage.empty()
    own, cycles = scene.lancer, scene.cycles
    for name, value in _THEIRS.items():
        setattr(cycles, name, value)
    # One of the two agrees: both have to go, or Lancer's own roughness would hold.
    own.film_transparent_glass = True
    found = {"denoises": not take_over_cycles.denoise.missing(), "offered": _offered(scene)}
    found["start"], theirs = _values(own, _OURS), _all_of(cycles)
    found["result"] = sorted(bpy.ops.lancer.take_over_cycles())
    found["taken"] = _values(own, _OURS)
    found["glass"] = own.is_property_set("film_transparent_glass")
    found["kept"] = _all_of(cycles) == theirs
    found["left"] = take_over_cycles.differing(scene)
    found["again"] = take_over_cycles.take_over(scene)
    found["offered after"] = _offered(scene)
    found["poll"] = bpy.ops.lancer.take_over_cycles.poll()
    # A threshold of 0 is automatic, and without one all samples are taken.
    cycles.adaptive_threshold = 0.0
    found["automatic"] = round(take_over_cycles.take_over(scene)["target_error"], 6)
    cycles.use_adaptive_sampling = False
    found["all samples"] = take_over_cycles.take_over(scene)["target_error"]
    cycles.pixel_filter_type = "BOX"
    found["box"] = take_over_cycles.take_over(scene)
    return found


def _undo():
    """samples before, after, and after an undo of the operator."""
    bpy.ops.wm.read_factory_settings(use_empty=False)
    scene = bpy.context.scene
    scene.render.engine = "LANCER"
    scene.cycles.samples = 77
    bpy.ops.ed.undo_push(message="before")
    found = [scene.lancer.samples]
    bpy.ops.lancer.take_over_cycles()
    found.append(scene.lancer.samples)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    return [*found, bpy.context.scene.lancer.samples]


def _without_cycles():
    """With the Cycles add-on off: the error for scripts, whether the button acts, and whether the panel offers it."""
    import addon_utils

    from addon.bindings.abi import LancerError
    from addon.operators import take_over_cycles

    scene = stage.empty()
    stage.camera()
    addon_utils.disable("cycles")
    try:
        found = {"poll": bpy.ops.lancer.take_over_cycles.poll(), "offered": _offered(scene), "error": ""}
        try:
            take_over_cycles.take_over(scene)
        except LancerError as error:
            found["error"] = str(error)
        found["glass"] = bool(export_scene(bpy.context.evaluated_depsgraph_get())[0].settings.transparent_glass)
    finally:
        addon_utils.enable("cycles")
    return found


def settings():
    """All of the above, in one Blender."""
    return {case.__name__[1:]: case() for case in (_told, _glass, _take_over, _undo, _without_cycles)}
