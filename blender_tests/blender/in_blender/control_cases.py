"""Change every setting of a small scene one by one: which of them change the snapshot, and which do panels show?

The snapshot is a function of the data alone, so that a setting is read if and only if changing it changes the snapshot.
Some settings act in some states only, such as the angles of a panorama: hence the states.
"""

import bpy
import recording
import stage

from addon.bindings.abi import LancerError
from addon.denoise import view_layer as denoise
from addon.engine.passes import render_passes, sources
from addon.export.culling import EVERY_RAY
from addon.export.moving_scene import export_picture
from addon.export.scene import ExportOptions
from addon.export.shutter import shutter_of

# Properties that select which data-block is shown, and properties that are the data itself. Blender 3 crashes where a slot for
# painting is chosen that is not there.
_LEFT_OUT = {
    "rna_type",
    "engine",
    "name",
    "type",
    "mode",
    "use_fake_user",
    "animation_data",
    "preview",
    "preview_pause",
    "paint_active_slot",
    "paint_clone_slot",
}
_OWNERS_OF_NOTHING = (bpy.types.ID, bpy.types.AnimData)


def exported(scene, view_layer):
    """Return ((snapshot, passes), messages)."""
    view_layer.update()
    wanted = tuple(render_passes(scene, view_layer))
    options = ExportOptions(passes=sources(wanted), shutter=shutter_of(scene, view_layer, sources(wanted)))
    depsgraph = bpy.context.evaluated_depsgraph_get()
    try:
        snapshot, messages = export_picture(depsgraph, options, lambda *time: _set_frame(scene, *time))
    except LancerError as error:
        return str(error), []
    return (snapshot, wanted, denoise.wanted(scene, view_layer)), sorted(messages)


def _set_frame(scene, frame, subframe):
    scene.frame_set(frame, subframe=subframe)


def settings_of(owner, depth):
    """Yield (struct, property) of each writable property of a struct and, at a depth of 2, of the structs in it."""
    for field in owner.bl_rna.properties:
        if field.identifier in _LEFT_OUT or owner.is_property_readonly(field.identifier) and field.type != "POINTER":
            continue
        if field.type == "POINTER" and not isinstance(getattr(owner, field.identifier), bpy.types.ID):
            held = getattr(owner, field.identifier)
            is_id = issubclass(getattr(bpy.types, field.fixed_type.identifier, object), _OWNERS_OF_NOTHING)
            if held is not None and depth > 1 and not is_id:
                yield from settings_of(held, depth - 1)
            elif is_id and not field.is_readonly:
                yield owner, field
        elif field.type not in ("COLLECTION", "STRING") and not field.is_readonly:
            yield owner, field


def other_values(owner, field):
    """Return some values other than the setting's own."""
    now = getattr(owner, field.identifier)
    if field.type == "BOOLEAN":
        values = [tuple(not x for x in now) if field.is_array else not now]
    elif field.type == "ENUM" and not field.is_enum_flag and now:
        values = [item.identifier for item in field.enum_items]
    elif field.type == "INT":
        values = [now + 1, now - 1] if not field.is_array else []
    elif field.type == "FLOAT":
        # One of the two is within the limits. Matrices are results, not settings.
        is_matrix = field.is_array and field.array_dimensions[1] > 0
        values = [] if is_matrix else [_scaled(now, 0.7), _scaled(now, 1.3)]
    elif field.type == "POINTER":
        kind = field.fixed_type.identifier
        values = [None, *next((every for every in _collections() if every and every[0].bl_rna.identifier == kind), [])]
    else:
        values = []
    return [value for value in values if value != now]


def _scaled(value, factor):
    return value * factor + 0.1 if isinstance(value, float) else tuple(x * factor + 0.1 for x in value)


def _collections():
    data = bpy.data
    return [list(every) for every in (data.worlds, data.materials, data.objects, data.images, data.collections)]


def acting(scene, view_layer, owners, depth):
    """Return (settings that act, settings that change messages alone, all settings) of the owners, as (type, property)."""
    acts, tells, known = set(), set(), set()
    for root in owners:
        # Blender does not tag the data-block when an add-on's setting changes.
        root.id_data.update_tag()
    before = exported(scene, view_layer)
    for owner, field in (setting for root in owners for setting in settings_of(root, depth)):
        key = _type_of(owner), field.identifier
        known.add(key)
        values = other_values(owner, field)
        if not values:
            continue
        kept, was_set = getattr(owner, field.identifier), owner.is_property_set(field.identifier)
        kept = tuple(kept) if getattr(field, "is_array", False) else kept
        for value in values:
            try:
                setattr(owner, field.identifier, value)
            except (TypeError, ValueError, AttributeError):
                continue  # not among the current choices
            owner.id_data.update_tag()
            after = exported(scene, view_layer)
            if after[0] != before[0]:
                acts.add(key)
                break
            if after[1] != before[1]:
                tells.add(key)
        setattr(owner, field.identifier, kept)
        if not was_set:
            # Cycles' setting of a transparent film holds as long as Lancer's own is not set.
            owner.property_unset(field.identifier)
        owner.id_data.update_tag()
        if key in acts:
            # A rounded value, such as a focal length set by its angle, does not return to the same bits.
            before = exported(scene, view_layer)
    return acts, tells, known


def _type_of(owner):
    """Return the name of a struct's type; lamps, which have a type for each kind, count as one."""
    return "Light" if isinstance(owner, bpy.types.Light) else owner.bl_rna.identifier


def _textured():
    """Return a material with emission, transparency and displacement, so that all its settings act."""
    material = stage.shader(name="Textured")
    tree = material.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    checker, moved = tree.nodes.new("ShaderNodeTexChecker"), tree.nodes.new("ShaderNodeDisplacement")
    tree.links.new(checker.outputs["Fac"], moved.inputs["Height"])
    tree.links.new(moved.outputs[0], output.inputs["Displacement"])
    glow, veil = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeBsdfTransparent")
    glow.inputs["Strength"].default_value = 10.0
    large = tree.nodes.new("ShaderNodeTexImage")
    large.image = bpy.data.images.new("Large", 256, 2)
    tree.links.new(large.outputs["Color"], glow.inputs["Color"])
    bodies = [next(node for node in tree.nodes if node.type == "BSDF_DIFFUSE"), veil]
    for body in bodies:
        added = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(glow.outputs[0], added.inputs[0])
        tree.links.new(body.outputs[0], added.inputs[1])
        glow = added
    tree.links.new(glow.outputs[0], output.inputs["Surface"])
    return material


class _Stage:
    def __init__(self):
        self.twice = set()  # (type, property, panel) of settings that an earlier panel of the same tab shows, too
        self.scene = scene = stage.empty(width=16, height=12, samples=1)
        self.layer = scene.view_layers[0]
        self.material = _textured()
        stage.shader(name="Other")
        stage.plane(material=stage.shader(name="Floor"))
        self.cube = stage.cube(material=self.material, location=(0, 0, 0.5))
        self.cube.modifiers.new("Subdivision", "SUBSURF").levels = 2
        bpy.data.collections.new("Linked").objects.link(self.cube)
        self.lamp = stage.light()
        self.lamp.data.use_nodes = True
        glow = next(node for node in self.lamp.data.node_tree.nodes if node.type == "EMISSION")
        glow.inputs["Strength"].default_value = 2.0
        bpy.data.worlds.new("Other")
        self.world = stage.sky()
        self.camera = stage.camera()
        bpy.data.images.new("Picture", 2, 2)
        scene.render.use_simplify, scene.render.simplify_subdivision = True, 1
        scene.lancer.pixel_filter = "BLACKMAN_HARRIS"
        for name in ("use_pass_mist", "use_pass_ambient_occlusion"):
            setattr(self.layer, name, True)

    def shows(self, tab, thing, **fields):
        """Return the settings that the panels of a tab show."""
        context = recording.Context(
            engine="LANCER",
            scene=self.scene,
            view_layer=self.layer,
            object=thing,
            active_object=thing,
            world=self.world,
            **fields,
        )
        shown = set()
        for panel, record in recording.drawn(context, tab).items():
            here = {("Light" if kind.endswith("Light") else kind, name) for kind, name in record.properties}
            self.twice |= {(*setting, panel) for setting in shown & here}
            shown |= here
        return shown

    def states(self):
        """Yield (owners of the settings, depth, settings that the panels of their tabs show) of each state."""
        yield from self._of_scenes()
        yield from self._of_materials()
        yield from self._of_cameras()
        yield from self._of_lamps()

    def _of_scenes(self):
        scene, own, layer, world = self.scene, self.scene.lancer, self.layer, self.world

        def now(*owners, depth=1):
            tabs = ("render", "output", "view_layer", "scene", "world", "object")
            return owners, depth, set().union(*(self.shows(tab, self.cube) for tab in tabs))

        yield now(scene, layer, world, self.cube, depth=2)
        own.film_transparent_glass = scene.render.film_transparent = own.use_denoising = True
        scene.render.use_border, scene.render.border_max_x = True, 0.5
        yield now(scene.render, own, *filter(None, [getattr(layer, "cycles", None)]))
        own.integrator = "CLASSIC"
        yield now(own)
        if bpy.app.version < (5, 0):
            world.use_nodes = False
            yield now(world)
            world.use_nodes = True
        world.lancer.use_cube = world.lancer.use_ambient_color = True
        yield now(world.lancer)
        world.lancer.use_cube = False
        if hasattr(world, "cycles"):
            world.cycles.sampling_method = "MANUAL"
            yield now(world.cycles)
        yield from self._of_fast_gi_and_culling(now)
        yield from self._of_subdivision(now)
        self.cube.lancer.shape = "SPHERE"
        yield now(self.cube.lancer)
        self.cube.lancer.shape = "MESH"
        yield from self._of_motion(now)

    def _of_subdivision(self, now):
        """A cube that its levels limit, and one that a camera beside the scene's divides by its pixels."""
        cycles, modifier = self.scene.cycles, self.cube.modifiers[-1]
        modifier.subdivision_type = "SIMPLE"
        if hasattr(modifier, "use_adaptive_subdivision"):
            modifier.use_adaptive_subdivision = True
        else:
            # Before 4.5 Cycles divides what the levels leave: none, so that the other settings act.
            modifier.levels = modifier.render_levels = 0
            cycles.feature_set, self.cube.cycles.use_adaptive_subdivision = "EXPERIMENTAL", True
        # Small enough for more than the least number of segments in a small picture.
        cycles.dicing_rate = 0.5
        cycles.dicing_camera = stage.link("Beside", self.camera.data, (3.0, -6.0, 3.0))
        for cycles.max_subdivisions in (1, 12):
            yield now(cycles, self.cube.cycles)

    def _of_motion(self, now):
        """A cube that slides and changes its shape."""
        scene, cube = self.scene, self.cube
        cube.modifiers.clear()
        cube.shape_key_add(name="Basis")
        key = cube.shape_key_add(name="Bent")
        key.data[0].co.x += 1.0
        for frame in (0, 2):
            cube.location.x, key.value = frame, 0.5 * frame
            cube.keyframe_insert("location", frame=frame)
            key.keyframe_insert("value", frame=frame)
        scene.frame_set(1)
        scene.render.use_motion_blur = True
        scene.cycles.rolling_shutter_type = "TOP"
        yield now(scene.render, scene.cycles, cube.cycles, scene.view_layers[0])
        scene.render.use_motion_blur = False
        cube.shape_key_clear()
        cube.animation_data_clear()

    def _of_fast_gi_and_culling(self, now):
        cycles = getattr(self.scene, "cycles", None)
        if cycles is None:
            return
        cycles.use_fast_gi = True
        yield now(cycles, self.world.light_settings, self.cube.cycles)
        cycles.use_fast_gi = False
        # A cube just beside the picture, just beyond the distance.
        place = self.cube.location.copy()
        cycles.use_camera_cull = self.cube.cycles.use_camera_cull = True
        cycles.camera_cull_margin = 0.0
        self.cube.location.x = 1.5
        while not self._is_culled() and self.cube.location.x < 9.0:
            self.cube.location.x += 0.3
        yield now(cycles, self.cube.cycles)
        cycles.use_camera_cull, cycles.use_distance_cull, self.cube.cycles.use_distance_cull = False, True, True
        cycles.distance_cull_margin = 0.9 * ((self.cube.location - self.camera.location).length - 1.0)
        yield now(cycles, self.cube.cycles)
        cycles.use_distance_cull = False
        self.cube.location = place

    def _is_culled(self):
        (snapshot, _, _), _ = exported(self.scene, self.layer)
        return bool((snapshot.instances.hidden_from == EVERY_RAY).any())

    def _of_materials(self):
        material = self.material
        slot = self.cube.material_slots[0]

        def now(owner, depth=1):
            return (owner,), depth, self.shows("material", self.cube, material=material, material_slot=slot)

        yield now(material, depth=2)
        for model in material.lancer.bl_rna.properties["model"].enum_items.keys():
            if model != "NODES":
                material.lancer.model = model
                yield now(material.lancer)
        material.lancer.model = "NODES"
        if bpy.app.version < (5, 0):
            material.use_nodes = False
            yield now(material)
            material.use_nodes = True

    def _of_cameras(self):
        data = self.camera.data
        panorama = data if hasattr(data, "panorama_type") else data.cycles

        def now(*owners, depth=1):
            return owners, depth, self.shows("data", self.camera, camera=data)

        yield now(data, depth=2)
        for type_ in ("ORTHO", "PANO"):
            data.type = type_
            yield now(data)
        for projection in panorama.bl_rna.properties["panorama_type"].enum_items.keys():
            panorama.panorama_type = projection
            yield now(panorama)
        data.type = "PERSP"
        data.sensor_fit, data.lens_unit = "VERTICAL", "FOV"
        data.dof.use_dof, data.dof.aperture_blades = True, 5
        yield now(data, data.dof)

    def _of_lamps(self):
        lamp = self.lamp
        own = lamp.data.lancer
        own.falloff, own.use_separate_colors, own.diffuse_color = "LINEAR", True, (1.0, 0.5, 0.2)
        if "use_temperature" in lamp.data.bl_rna.properties:
            lamp.data.use_temperature = True

        def now(*owners, depth=1):
            # Only a newly fetched Python object has the type of the lamp's new kind.
            data = lamp.data
            return (data, *owners), depth, self.shows("data", lamp, light=data) | self.shows("object", lamp, light=data)

        yield now(lamp, depth=2)
        for kind in ("SUN", "SPOT"):
            lamp.data.type = kind
            yield now()
        if bpy.app.version < (5, 2):
            lamp.data.use_nodes = False
            yield now()
            lamp.data.use_nodes = True
        lamp.data.type = "AREA"
        for shape in ("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"):
            lamp.data.shape = shape
            yield now(lamp.data.cycles) if hasattr(lamp.data, "cycles") else now()


def controls():
    """Return {kind: ["Type.property", ...]}; "tell": settings that change messages alone, "twice": shown by two panels."""
    built = _Stage()
    acts, tells, known, shown = set(), set(), set(), set()
    for owners, depth, in_panels in built.states():
        shown |= in_panels
        for total, found in zip((acts, tells, known), acting(built.scene, built.layer, owners, depth), strict=True):
            total |= found
    found = {"act": acts, "tell": tells - acts, "known": known, "shown": shown, "twice": built.twice}
    return {what: sorted(map(".".join, settings)) for what, settings in found.items()} | {"version": bpy.app.version[:2]}
