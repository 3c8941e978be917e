"""A temporary copy of a scene."""

import contextlib

import bpy

# Before 4.2 Scene.copy() leaves one user too many on the objects of the scene's own collection.
_CAN_COPY = bpy.app.version >= (4, 2)
# Properties of the scene itself, besides its groups of settings.
_OF_SCENE = ("world", "camera", "background_set", "frame_start", "frame_end", "frame_current", "gravity", "use_gravity")
_OF_COLLECTION = ("exclude", "holdout", "indirect_only")


@contextlib.contextmanager
def copied(scene, name):
    """Yield a copy of the scene with that name. Before Blender 4.2 the copy has no rigid body world."""
    copy = scene.copy() if _CAN_COPY else bpy.data.scenes.new(name)
    try:
        copy.name = name
        if not _CAN_COPY:
            _fill(copy, scene)
        yield copy
    finally:
        bpy.data.scenes.remove(copy)


def _fill(copy, scene):
    for child in scene.collection.children:
        copy.collection.children.link(child)
    for thing in scene.collection.objects:
        copy.collection.objects.link(thing)
    for name in _OF_SCENE:
        setattr(copy, name, getattr(scene, name))
    _copy_groups(scene, copy)
    _copy_values(scene.render, copy.render)
    for number, layer in enumerate(scene.view_layers):
        other = copy.view_layers[0] if number == 0 else copy.view_layers.new(layer.name)
        _copy_values(layer, other)
        _copy_groups(layer, other)
        _copy_collections(layer.layer_collection, other.layer_collection)


def _copy_groups(source, target):
    """Copy the groups of settings that add-ons have registered."""
    for prop in source.bl_rna.properties:
        value = getattr(source, prop.identifier) if prop.type == "POINTER" else None
        if isinstance(value, bpy.types.PropertyGroup) and prop.identifier != "rna_type":
            _copy_values(value, getattr(target, prop.identifier))
            _copy_groups(value, getattr(target, prop.identifier))


def _copy_values(source, target):
    for prop in source.bl_rna.properties:
        if not prop.is_readonly and prop.type != "COLLECTION" and source.is_property_set(prop.identifier):
            # The value of an enum may be missing on this machine, and some properties cannot be set.
            with contextlib.suppress(TypeError, AttributeError):
                setattr(target, prop.identifier, getattr(source, prop.identifier))


def _copy_collections(source, target):
    for name in _OF_COLLECTION:
        setattr(target, name, getattr(source, name))
    for child in source.children:
        _copy_collections(child, target.children[child.name])
