"""The settings of a scene and of its view layer, compared as a whole: Blender reports only that any of them has changed."""

import functools

_NUMBERS = frozenset({"BOOLEAN", "INT", "FLOAT"})
_SIMPLE = _NUMBERS | {"ENUM", "STRING"}
# Properties that no export reads, and that scripts set for each picture.
_UNREAD = {"filepath", "name"}
_OF_COLLECTIONS = ("exclude", "hide_viewport", "holdout", "indirect_only")


def scene_state(depsgraph):
    """Return a value that differs if a setting does that objects, lamps and materials depend on, the camera apart."""
    scene, layer = depsgraph.scene, depsgraph.view_layer
    # Blender writes a warning to the console if Cycles' choice of a device or a denoiser is not available.
    of_cycles = [_values(getattr(owner, "cycles", None), _NUMBERS) for owner in (scene, layer)]
    world = getattr(layer, "world_override", None) or scene.world
    dicing = getattr(getattr(scene, "cycles", None), "dicing_camera", None)
    blocks = tuple(None if block is None else block.as_pointer() for block in (world, layer.material_override, dicing))
    names = tuple(group.name for group in layer.lightgroups), tuple((aov.name, aov.type) for aov in layer.aovs)
    simple = map(_values, (scene.render, scene.lancer, layer))
    return *simple, of_cycles, blocks, names, tuple(_collections(layer.layer_collection))


def _values(owner, types=_SIMPLE):
    return None if owner is None else [getattr(owner, name) for name in _names(type(owner), types)]


@functools.cache
def _names(kind, types):
    """Return the names of the properties of a class that hold a single value of these types."""
    return tuple(
        name
        for name, found in kind.bl_rna.properties.items()
        if found.type in types and not getattr(found, "is_array", False) and name not in _UNREAD
    )


def _collections(collection):
    yield tuple(getattr(collection, name) for name in _OF_COLLECTIONS)
    for child in collection.children:
        yield from _collections(child)
