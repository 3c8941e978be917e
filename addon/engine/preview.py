"""Previews of materials, worlds and lamps for Blender's preview panels and icons.

Blender renders them from temporary scenes in threads of its own, in parallel with other renders: they report no messages.
"""

import contextlib
import dataclasses
import logging
import threading
import time

from ..bindings.abi import LancerError
from ..bindings.enums import Pass
from ..bindings.session import Cancelled, Session
from ..export.scene import ExportOptions, export_scene
from ..host import main_thread
from ..host.priority import lowered
from ..measure.schedule import Schedule
from . import passes

_SAMPLES = 64
_STEP = 0.02
_PATIENCE = 0.02  # seconds between checks whether all previews have ended
_WANTED = (passes.RenderPass("Combined", "RGBA", "COLOR", Pass.COMBINED),)

_ending = threading.Event()
_running = set()


def render(engine, depsgraph):
    """Render a preview's depsgraph progressively, instead of engine.render()."""
    with _counted():
        try:
            _render(engine, depsgraph, lambda: _ending.is_set() or engine.test_break())
        except Cancelled:
            pass
        except LancerError as error:
            engine.error_set(f"Lancer: {error}")
        except Exception as error:
            logging.getLogger(__name__).exception("a preview failed")
            engine.error_set(f"Lancer: {type(error).__name__}: {error}")


def _render(engine, depsgraph, is_over):
    snapshot, _ = export_scene(depsgraph, ExportOptions(engine.camera_override, is_preview=True), is_over)
    settings = dataclasses.replace(snapshot.settings, samples=_SAMPLES, target_error=0.0, time_limit=0.0)
    snapshot.set("settings", settings)
    with lowered(lambda: Session.upload(snapshot, poll=is_over, release=True)) as session:
        result = engine.begin_result(0, 0, session.camera.region_width, session.camera.region_height)
        try:
            schedule = Schedule(session)
            while schedule.start():
                while not schedule.wait(_STEP).finished:
                    if is_over():
                        schedule.cancel()
                if not is_over():
                    passes.fill(result.layers[0], session.read, _WANTED)
                    engine.update_result(result)
        finally:
            engine.end_result(result)


@contextlib.contextmanager
def _counted():
    this = object()
    _running.add(this)
    try:
        yield
    finally:
        _running.discard(this)


def register():
    _ending.clear()


def unregister():
    """End running previews, which use the engine's class, and wait for them."""
    _ending.set()
    while _running:
        main_thread.serve()
        time.sleep(_PATIENCE)
