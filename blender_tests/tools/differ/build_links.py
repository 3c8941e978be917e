"""Records of light and shadow linking as collections of emitters, since Blender 4.0."""

import bpy


def build_linking(name, fields, find):
    emitters = [thing for thing in map(find, fields.get("emitters", ())) if thing is not None]
    if bpy.app.version < (4, 0) or not emitters:
        return
    collection = bpy.data.collections.new(name)
    states = [
        (thing, state) for thing, state in ((find(key), state) for key, state in fields.get("objects", {}).items()) if thing
    ]
    for thing, _ in states:
        collection.objects.link(thing)
    for (_, state), link in zip(states, collection.collection_objects, strict=True):
        link.light_linking.link_state = state
    below = fields.get("child")
    if below is not None:
        child = bpy.data.collections.new(f"{name} child")
        for thing in filter(None, map(find, below.get("objects", ()))):
            child.objects.link(thing)
        collection.children.link(child)
        collection.collection_children[0].light_linking.link_state = below.get("state", "INCLUDE")
    for emitter in emitters:
        setattr(emitter.light_linking, fields.get("member", "receiver_collection"), collection)
