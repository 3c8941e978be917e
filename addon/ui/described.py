"""Cache of material descriptions for the Material tab, computed at the first draw after a change.

Blender redraws a panel many times between two changes. A handler, registered only while the cache has entries, clears the
cache after a change.
"""

from typing import NamedTuple

import bpy

from ..export.describe import Description, describe_material
from .node_use import NodeUse, use_of

_kept = {}  # Described by the state that they depend on


class Described(NamedTuple):
    description: Description
    use: NodeUse


def described(material, frame):
    """Return the Described of a material at a frame."""
    handlers = bpy.app.handlers.depsgraph_update_post
    if _changed not in handlers:
        # Loading a file removes the handler: entries are of the old file.
        _kept.clear()
        handlers.append(_changed)
    # Changes of add-ons' properties do not call the handler: include them in the key.
    method = getattr(getattr(material, "cycles", None), "displacement_method", "")
    key = material.as_pointer(), material.name, frame, material.lancer.model, method
    if key not in _kept:
        description = describe_material(material)
        _kept[key] = Described(description, use_of(material.node_tree, description.exported))
    return _kept[key]


def _changed(*_):
    _kept.clear()
    # Remove the handler later: a handler that removes itself makes Blender skip the next one.
    if not bpy.app.timers.is_registered(_leave):
        bpy.app.timers.register(_leave)


def _leave():
    if not _kept and _changed in bpy.app.handlers.depsgraph_update_post:
        bpy.app.handlers.depsgraph_update_post.remove(_changed)


def forget():
    """Clear the cache and remove handler and timer."""
    _kept.clear()
    _leave()
    if bpy.app.timers.is_registered(_leave):
        bpy.app.timers.unregister(_leave)
