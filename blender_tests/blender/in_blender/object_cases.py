"""The switches of objects in the snapshot: the rays that they are hidden from, and holdouts."""

import bpy
import stage
from export_cases import export_told, row_of_cubes

from addon.bindings.enums import InstanceFlag, Ray
from addon.engine import last_messages


def _rows(snapshot):
    """Return {name: [(ray types that it is hidden from, its flags), ...]}, one for each instance, sorted by height."""
    table, rows = snapshot.instances, {}
    for i in sorted(range(len(table)), key=lambda i: table.matrices[i, 2, 3]):
        hidden = [ray.name for ray in Ray if table.hidden_from[i] & ray]
        flags = [flag.name for flag in InstanceFlag if table.flags[i] & flag]
        rows.setdefault(table.names[table.name_indices[i]], []).append([hidden, flags])
    return rows


def _named(name, **fields):
    item = stage.cube()
    item.name = name
    for field, value in fields.items():
        setattr(item, field, value)
    return item


def _collected(name, item, parent=None):
    """Move the item into a new collection. Return the layer collection."""
    collection = bpy.data.collections.new(name)
    (parent or bpy.context.scene.collection).children.link(collection)
    bpy.context.scene.collection.objects.unlink(item)
    collection.objects.link(item)
    return bpy.context.view_layer.layer_collection.children[name]


def switches():
    stage.empty()
    _named("plain")
    for ray in ("camera", "diffuse", "glossy", "transmission", "volume_scatter", "shadow"):
        _named(ray, **{"visible_" + ray: False})
    _named("two", visible_camera=False, visible_shadow=False)
    _named("hole", is_holdout=True)
    _named("gone", hide_render=True)
    _collected("Holes", _named("hole of a collection")).holdout = True
    _collected("Indirect", _named("indirect")).indirect_only = True
    both = _collected("Both", _named("hole, not indirect"))
    both.holdout = both.indirect_only = True
    _named("catcher", is_shadow_catcher=True)
    snapshot, messages = export_told()
    return {"rows": _rows(snapshot), "messages": messages.lines()}


def caught_aovs():
    """Messages of renders with an AOV, without a shadow catcher and with one."""
    scene = stage.empty(8, 8, 1)
    stage.camera()
    thing = stage.cube(material=stage.shader())
    scene.view_layers[0].aovs.add().name = "Tint"
    scene.render.engine, told = "LANCER", []
    for thing.is_shadow_catcher in (False, True):
        bpy.ops.render.render()
        told.append([line for line in last_messages[scene.name] if "AOV" in line])
    return told


def flat():
    """Messages for objects that a scale of 0 flattens, by name."""
    stage.empty()
    sheet = [(0, 0, 0), (1, 0, 0.2), (0, 1, 0), (1, 1, 0.5)], [(0, 1, 3, 2)]
    stage.mesh("plain", *sheet).scale = (1, 1, 0)
    # The sum of the cofactors' diagonal is below 0 where one axis is mirrored.
    for name, x in (("smooth", 1), ("turned", -1)):
        item = stage.mesh(name, *sheet)
        item.scale = (x, 1, 0)
        item.data.polygons.foreach_set("use_smooth", [True])
    _named("closed", scale=(1, 1, 0))
    first = _named("shared", scale=(1, 0, 1))
    stage.link("other", first.data)
    _named("line", scale=(1, 0, 0))
    _, messages = export_told()
    return messages.lines()


def instancers():
    """Instance a collection with a holdout three times: plainly, by a hidden empty, and by one that is a holdout."""
    stage.empty()
    collection = bpy.data.collections.new("Set")
    item = _named("piece", visible_glossy=False, is_holdout=True)
    bpy.context.scene.collection.objects.unlink(item)
    collection.objects.link(item)
    for height, fields in enumerate(({}, {"visible_camera": False}, {"is_holdout": True})):
        empty = stage.link(f"Empty {height}", None, (0, 0, float(height)))
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        for field, value in fields.items():
            setattr(empty, field, value)
    snapshot, _ = export_told()
    return {"rows": _rows(snapshot), "meshes": len(snapshot.meshes)}


def freed():
    """Render instances of every kind, of objects that nothing else shows. Blender reports memory leaks at its exit."""
    scene = stage.room()
    row_of_cubes()
    for name, thing in (("Boxes", stage.cube(0.3)), ("Lamps", stage.light())):
        collection = bpy.data.collections.new(name)
        scene.collection.objects.unlink(thing)
        collection.objects.link(thing)
        empty = stage.link(name, None, (0, 1, 1))
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
    ground = stage.plane(2.0)
    ground.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = ground.particle_systems[0].settings
    settings.type, settings.count, settings.render_type = "HAIR", 5, "OBJECT"
    settings.instance_object = bpy.data.objects["Cube"]
    bpy.ops.render.render()
    return {"instances": len(export_told()[0].instances)}


def freed_text():
    """The same with a text that is the first of all objects."""
    scene = stage.room()
    others = list(scene.collection.objects)
    for thing in others:
        scene.collection.objects.unlink(thing)
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.extrude = "text", 0.1
    for thing in (stage.link("Text", text), *others):
        if thing.name not in scene.collection.objects:
            scene.collection.objects.link(thing)
    bpy.ops.render.render()
    return {"instances": len(export_told()[0].instances)}


def _textured(name, uv_map):
    """Return a material that reads a UV map by its name."""
    material = stage.shader(name=name)
    tree = material.node_tree
    node = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE")
    coordinates = tree.nodes.new("ShaderNodeUVMap")
    coordinates.uv_map = uv_map
    tree.links.new(coordinates.outputs[0], node.inputs["Color"])
    return material


def attributes():
    """One mesh under three materials: it is exported twice only if a material reads an attribute that the first mesh lacks."""
    stage.empty()
    first = stage.plane(material=stage.shader(name="plain"))
    for name in ("One", "Two"):
        first.data.uv_layers.new(name=name)
    first.data.uv_layers["One"].active_render = True
    for number, material in enumerate((_textured("reader", "Two"), stage.shader(name="plain too"))):
        item = stage.link(f"Copy {number}", first.data, (0, 0, 1.0 + number))
        item.material_slots[0].link = "OBJECT"
        item.material_slots[0].material = material
    snapshot, _ = export_told()
    table = snapshot.instances
    names = [sorted(a.name for a in mesh.attributes) for mesh in snapshot.meshes]
    return {table.names[table.name_indices[i]]: names[table.meshes[i]] for i in range(len(table))}


def generated():
    """The lowest and the highest Generated coordinates of a plane, whose height is nothing."""
    stage.empty()
    material = stage.shader(name="reader")
    tree = material.node_tree
    node = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE")
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], node.inputs["Color"])
    stage.plane(material=material)
    (attribute,) = (a for mesh in export_told()[0].meshes for a in mesh.attributes)
    return [attribute.values.min(axis=0).tolist(), attribute.values.max(axis=0).tolist()]


def settings():
    """Return the exported settings of film and world."""
    scene = stage.empty()
    own = scene.lancer
    told = {"first": _facts(export_told()[0].settings)}
    scene.render.film_transparent = own.film_transparent_glass = True
    own.film_transparent_roughness, own.transparent_bounces = 0.5, 3
    bpy.context.view_layer.pass_alpha_threshold = 0.25
    stage.sky()
    mist, light = scene.world.mist_settings, scene.world.light_settings
    mist.start, mist.depth, mist.falloff, light.distance = 2.0, 30.0, "INVERSE_QUADRATIC", 4.0
    told["second"] = _facts(export_told()[0].settings)
    told["bounces"] = []
    for bounces in (0, 3):
        own.transparent_bounces = bounces
        told["bounces"].append(export_told()[0].settings.transparent_bounces)
    told["version"] = list(bpy.app.version)
    return told


def _facts(record):
    names = ("film_transparent", "transparent_glass", "glass_roughness", "transparent_shadows", "alpha_threshold")
    names += ("occlusion_distance", "mist_start", "mist_depth", "mist_falloff")
    return [getattr(record, name) for name in names]


def _add_mesh_nodes(material):
    """Add closures to a material that depend on edges and points of a mesh."""
    tree = material.node_tree
    surface = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL").inputs["Surface"]
    add = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(surface.links[0].from_socket, add.inputs[0])
    hair, mix = tree.nodes.new("ShaderNodeBsdfHair"), tree.nodes.new("ShaderNodeMath")
    tree.links.new(tree.nodes.new("ShaderNodeWireframe").outputs[0], mix.inputs[0])
    tree.links.new(tree.nodes.new("ShaderNodeNewGeometry").outputs["Pointiness"], mix.inputs[1])
    tree.links.new(mix.outputs[0], hair.inputs["RoughnessU"])
    tree.links.new(hair.outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], surface)


def told():
    """Return messages about empty slots without and with an override, strokes that Blender draws itself, and exact shapes."""
    result = {}
    for name in ("empty slot", "override"):
        stage.empty()
        stage.cube().data.materials.append(None)
        if name == "override":
            bpy.context.view_layer.material_override = stage.shader()
        result[name] = export_told()[1].lines()
    stage.empty()
    old = bpy.app.version < (4, 3)
    kind = "grease_pencils_v3" if hasattr(bpy.data, "grease_pencils_v3") else "grease_pencils"
    strokes = stage.link("Strokes", getattr(bpy.data, kind).new("Strokes"))
    result["strokes"] = [strokes.type == ("GPENCIL" if old else "GREASEPENCIL"), export_told()[1].lines()]
    stage.empty()
    material = _textured("reader", "Map")
    tree = material.node_tree
    owner = material if hasattr(material, "displacement_method") else material.cycles
    owner.displacement_method = "DISPLACEMENT"
    node = tree.nodes.new("ShaderNodeDisplacement")
    place = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(place.outputs["Generated"], node.inputs["Height"])
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    tree.links.new(node.outputs[0], output.inputs["Displacement"])
    _add_mesh_nodes(material)
    for shape in ("MESH", "SPHERE"):
        item = stage.cube(material=material)
        item.name, item.lancer.shape = shape, shape
    result["exact"] = export_told()[1].lines()
    return result
