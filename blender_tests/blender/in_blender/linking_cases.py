"""Light linking in the snapshot: the sets of objects and lamps."""

import bpy
import stage
from export_cases import export_told


def _told():
    """Return the links of each instance by name, the lamps' sets, and the messages."""
    snapshot, messages = export_told()
    table, links = snapshot.instances, {}
    for i in range(len(table)):
        row = [0, 0, 0, 0] if table.links is None else table.links[i].tolist()
        links.setdefault(table.names[table.name_indices[i]], []).append(row)
    lamps = {light.name: [light.unlit_sets, light.clear_sets] for light in snapshot.lights}
    return {"links": links, "lamps": lamps, "kept": table.links is not None, "messages": messages.lines()}


def _cubes(*names):
    things = []
    for name in names:
        thing = stage.cube()
        thing.name = name
        things.append(thing)
    return things


def _collection(name, state, *things):
    collection = bpy.data.collections.new(name)
    for thing in things:
        collection.objects.link(thing)
    for link in collection.collection_objects:
        link.light_linking.link_state = state
    return collection


def sets():
    """Two lamps share a collection that includes a cube, a glowing cube excludes another; a third cube is in no collection."""
    stage.empty()
    included, excluded, glowing, other = _cubes("included", "excluded", "glowing", "other")
    chosen = _collection("Chosen", "INCLUDE", included)
    for name in ("first", "second"):
        lamp = stage.light()
        lamp.name = name
        lamp.light_linking.receiver_collection = chosen
    lamp = stage.light()
    lamp.name = "shadowed"
    lamp.light_linking.blocker_collection = _collection("Blockers", "EXCLUDE", included, other)
    glowing.light_linking.receiver_collection = _collection("Left out", "EXCLUDE", excluded)
    bpy.context.view_layer.update()
    return _told()


def unlinked():
    """An empty collection links nothing."""
    stage.empty()
    _cubes("cube")
    lamp = stage.light()
    if hasattr(lamp, "light_linking"):
        lamp.light_linking.receiver_collection = bpy.data.collections.new("Empty")
    bpy.context.view_layer.update()
    return _told()


def instances():
    """The set of an instancer goes before that of the object that it shows."""
    stage.empty()
    (shown,) = _cubes("shown")
    hidden = bpy.data.collections.new("Hidden")
    hidden.objects.link(shown)
    bpy.context.scene.collection.objects.unlink(shown)
    for name in ("plain", "chosen"):
        instancer = bpy.data.objects.new(name, None)
        instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
        bpy.context.scene.collection.objects.link(instancer)
    lamp = stage.light()
    collection = _collection("Chosen", "INCLUDE", shown, instancer)
    collection.collection_objects[1].light_linking.link_state = "EXCLUDE"
    lamp.light_linking.receiver_collection = collection
    bpy.context.view_layer.update()
    return _told()


def too_many():
    """Of 70 collections, 64 count, of their 64 sets 63."""
    stage.empty()
    for number, cube in enumerate(_cubes(*(f"cube {i}" for i in range(70)))):
        lamp = stage.light()
        lamp.light_linking.receiver_collection = _collection(f"Chosen {number}", "INCLUDE", cube)
    bpy.context.view_layer.update()
    return _told()
