"""What the Material tab tells of a material: read from its nodes when it is first drawn, and again after a change.

Blender draws a panel many times between two changes. It tells of a change through a handler, which is there only while
something is kept.
"""

import bpy

from ..export.describe import describe_material

_kept = {}  # Descriptions by what they hang on


def described(material, frame):
    """The export.describe.Description of a material at a frame."""
    handlers = bpy.app.handlers.depsgraph_update_post
    if _changed not in handlers:
        # Another file takes handlers away, and what is kept is of its predecessor.
        _kept.clear()
        handlers.append(_changed)
    # Blender tells of all changes but those of add-ons' properties.
    method = getattr(getattr(material, "cycles", None), "displacement_method", "")
    key = material.as_pointer(), material.name, frame, material.lancer.model, method
    if key not in _kept:
        _kept[key] = describe_material(material)
    return _kept[key]


def _changed(*_):
    _kept.clear()
    # A handler that leaves while handlers are called would make Blender pass over the one after it.
    if not bpy.app.timers.is_registered(_leave):
        bpy.app.timers.register(_leave)


def _leave():
    if not _kept and _changed in bpy.app.handlers.depsgraph_update_post:
        bpy.app.handlers.depsgraph_update_post.remove(_changed)


def forget():
    """Keeps nothing, and takes the handler away."""
    _kept.clear()
    _leave()
    if bpy.app.timers.is_registered(_leave):
        bpy.app.timers.unregister(_leave)
