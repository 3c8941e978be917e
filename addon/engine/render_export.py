"""Export of the scene as F12 would render it, without rendering.

Only a render's depsgraph has the objects visible in renders, and modifiers and particles with their render settings, and
Blender passes it only to a rendering engine. So start a render of a copy of the scene, during which the engine exports and
renders nothing. The artist's scene, its last picture and its handlers are not involved.
"""

import contextlib
import time

import bpy

from ..bindings.abi import LancerError
from ..export.camera import NO_CAMERA
from ..export.moving_scene import export_picture
from ..export.scene import ExportOptions
from ..export.shutter import shutter_of
from ..export.unsupported import check_view_layer
from ..host.scene_copy import copied
from ..messages.messages import Messages
from .passes import render_passes

_NAME = "Lancer looks at a scene"
_RENDER = ("init", "pre", "post", "write", "stats", "complete", "cancel")
_HANDLERS = (*(f"render_{name}" for name in _RENDER), "depsgraph_update_pre", "depsgraph_update_post")

_asked = None  # the Export to fill during the render that Blender is about to begin


class Export:
    """snapshot, messages, and the seconds of the export without Blender's evaluation."""

    def __init__(self):
        self.snapshot = self.messages = self.error = None
        self.seconds = 0.0


def is_wanted():
    """Whether the engine should only export and not render."""
    return _asked is not None


def take(engine, depsgraph):
    """Fill the requested Export from this depsgraph, instead of rendering."""
    started = time.monotonic()
    scene, layer = depsgraph.scene, depsgraph.view_layer_eval
    wanted = tuple(item.source for item in render_passes(scene, layer))
    try:
        shutter = shutter_of(scene, layer, wanted)
        options = ExportOptions(engine.camera_override, wanted, shutter=shutter)
        _asked.snapshot, _asked.messages = export_picture(depsgraph, options, engine.frame_set)
    except Exception as error:
        _asked.error = error
    _asked.seconds = time.monotonic() - started


def export(context):
    """Return the Export of the context's scene and view layer; raise LancerError if the scene cannot be rendered."""
    global _asked
    scene, layer = context.scene, context.view_layer
    if scene.camera is None:
        raise LancerError(NO_CAMERA.format(scene.name))
    asked = Export()
    with _without_handlers(), _prepared(scene, layer) as copy:
        name = copy.name
        _asked = asked
        try:
            bpy.ops.render.render(scene=name)
        except RuntimeError as error:
            raise LancerError(str(error).strip().removeprefix("Error: ")) from None
        finally:
            _asked = None
    if isinstance(asked.error, LancerError):
        raise LancerError(str(asked.error).replace(f"'{name}'", f"'{scene.name}'"))
    if asked.error is not None:
        raise asked.error
    if asked.snapshot is None:
        raise LancerError(f"Blender did not evaluate view layer '{layer.name}' for a render")
    asked.messages = asked.messages.replaced(f"'{name}'", f"'{scene.name}'")
    # Freestyle is off in the copy: repeat the check of the view layer with the original scene.
    missed, known = Messages(), {message.text for message in asked.messages.told()}
    check_view_layer(scene, layer, missed)
    for message in missed.told():
        if message.text not in known:
            asked.messages.add(message.text, message.key, message.severity)
    return asked


@contextlib.contextmanager
def _prepared(scene, layer):
    """Yield a copy of the scene that renders only one view layer, without compositing, sequencer and Freestyle."""
    try:
        with copied(scene, _NAME) as copy:
            for other in copy.view_layers:
                other.use = other.name == layer.name
            render = copy.render
            render.use_compositing = render.use_sequencer = render.use_freestyle = False
            render.use_persistent_data = render.use_single_layer = False
            yield copy
    finally:
        # Evaluate the shared data now, so that it does not count as a change by the artist later.
        layer.update()


@contextlib.contextmanager
def _without_handlers():
    """Remove all render handlers temporarily: other add-ons' handlers may announce the end of a render or shut down."""
    kept = {name: list(getattr(bpy.app.handlers, name)) for name in _HANDLERS}
    for name in kept:
        getattr(bpy.app.handlers, name).clear()
    try:
        yield
    finally:
        for name, handlers in kept.items():
            getattr(bpy.app.handlers, name)[:] = handlers
