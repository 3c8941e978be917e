"""The export of what F12 would render, without a render.

Only a render's depsgraph has what is hidden in viewports and not what is hidden in renders, and modifiers and particles in
their numbers for renders. Blender gives it to engines that render and to nobody else. So it renders a copy of the scene here,
of which the engine takes the export and no picture. The artist's scene, its last picture and its handlers are not part of that.
"""

import contextlib
import time

import bpy

from ..bindings.abi import LancerError
from ..export.camera import NO_CAMERA
from ..export.checks import check_view_layer
from ..export.scene import ExportOptions, export_scene
from ..host.scene_copy import copied
from ..messages.messages import Messages
from .passes import render_passes

_NAME = "Lancer looks at a scene"
_RENDER = ("init", "pre", "post", "write", "stats", "complete", "cancel")
_HANDLERS = (*(f"render_{name}" for name in _RENDER), "depsgraph_update_pre", "depsgraph_update_post")

_asked = None  # the Export that is wanted of the render that Blender is about to begin


class Export:
    """snapshot, messages and the seconds that the export took, without Blender's own evaluation."""

    def __init__(self):
        self.snapshot = self.messages = self.error = None
        self.seconds = 0.0


def is_wanted():
    """For the engine: whether Blender's call is for an export alone."""
    return _asked is not None


def take(engine, depsgraph):
    """In the place of the engine's own work: what is wanted of this depsgraph."""
    started = time.monotonic()
    wanted = tuple(item.source for item in render_passes(depsgraph.scene, depsgraph.view_layer_eval))
    try:
        _asked.snapshot, _asked.messages = export_scene(depsgraph, ExportOptions(engine.camera_override, wanted))
    except Exception as error:
        _asked.error = error
    _asked.seconds = time.monotonic() - started


def export(context):
    """The Export of the context's scene and view layer. Raises LancerError."""
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
    # Freestyle, which would draw its lines, is off in the copy.
    missed, known = Messages(), {message.text for message in asked.messages.told()}
    check_view_layer(scene, layer, missed)
    for message in missed.told():
        if message.text not in known:
            asked.messages.add(message.text, message.key, message.severity)
    return asked


@contextlib.contextmanager
def _prepared(scene, layer):
    """A copy of the scene by which one view layer alone is rendered and nothing but that is done."""
    try:
        with copied(scene, _NAME) as copy:
            for other in copy.view_layers:
                other.use = other.name == layer.name
            render = copy.render
            render.use_compositing = render.use_sequencer = render.use_freestyle = False
            render.use_persistent_data = render.use_single_layer = False
            yield copy
    finally:
        # Blender now evaluates all that both have had, which is no change of the artist's.
        layer.update()


@contextlib.contextmanager
def _without_handlers():
    """What other add-ons do when a render begins or ends is not called: some tell of its end, some switch the machine off."""
    kept = {name: list(getattr(bpy.app.handlers, name)) for name in _HANDLERS}
    for name in kept:
        getattr(bpy.app.handlers, name).clear()
    try:
        yield
    finally:
        for name, handlers in kept.items():
            getattr(bpy.app.handlers, name)[:] = handlers
