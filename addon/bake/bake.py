"""One bake of one object into one image: renders the texels range by range, and hands their picture to Blender."""

import dataclasses
import math

import bpy
import numpy as np

from ..bindings import snapshot
from ..bindings.abi import LancerError
from ..bindings.enums import BakeView
from ..bindings.session import Session
from ..bindings.texels import EMPTY, Texels
from ..export.camera import camera_fields
from ..host.priority import lowered
from ..measure import render_report
from ..measure.schedule import Schedule
from ..messages.messages import Messages
from .pixels import read_texels, write_picture
from .wanted import wanted

_STEP = 0.05  # seconds between polls
_LIT = frozenset({"COMBINED", "AO", "DIFFUSE", "GLOSSY", "TRANSMISSION", "SHADOW"})
# Samples of passes without light: a texel's mean over its own area.
_DATA_SAMPLES = 64
# The roughness of a surface without a lobe that has one.
_BARE_ROUGHNESS = 1.0 if bpy.app.version >= (4, 2) else 0.0


class Bake:
    """The job of engine.bake().

    baked: the BakedScene of the object; tell(messages): reports Messages; is_over(): whether the user has cancelled.
    """

    def __init__(self, engine, depsgraph, thing, baked, tell, is_over):
        self._engine, self._depsgraph, self._thing, self._baked = engine, depsgraph, thing, baked
        self._tell, self._is_over = tell, is_over
        self._shown = 0.0  # share of the texels that show the surface

    def run(self, kind, pass_filter, width, height):
        """Bake a type with Blender's bits of a pass filter into an image of this size."""
        asked = wanted(kind, pass_filter)
        if asked is None:
            raise LancerError(f"baking of type {kind.title()} is not supported: choose another type, or bake with Cycles")
        # Blender finds the image of a result by the layer's name.
        result = self._engine.begin_result(0, 0, width, height, layer=f"bake {self._baked.next_image()}")
        try:
            rows = read_texels(result.layers[0], width, height)
            self._shown = float(np.mean(rows["triangle"] != EMPTY))
            if self._shown > 0.0:
                self._bake(asked, rows, result.layers[0])
        finally:
            self._engine.end_result(result)

    def _bake(self, asked, rows, layer):
        height, width = rows.shape
        camera = _camera(self._depsgraph, width, height)
        self._baked.make(self._engine, self._depsgraph, self._thing, asked, camera, self._tell, self._is_over)
        view = _view(self._depsgraph.scene, asked.kind)
        texels = Texels(rows, self._baked.row, view, asked.lacks, _BARE_ROUGHNESS)
        with lowered(lambda: Session.bake(self._baked.scene, camera, self._settings(asked), texels)) as session:
            self._tell(Messages.of_library(session.messages()))
            schedule = self._render(session)
            write_picture(layer, asked.picture(session.read))
            place = f"texel of '{self._thing.original.name}'"
            self._tell(render_report.left_out(dataclasses.asdict(session.statistics()), place))
            if asked.kind in _LIT and not self._is_over():
                self._tell_error(session, schedule)

    def _settings(self, asked):
        """Return the snapshot.Settings of this image."""
        settings = self._baked.settings
        if asked.kind in _LIT:
            # Empty texels have no error, and lower the mean of squares over all.
            return settings.replaced(target_error=settings.target_error * math.sqrt(self._shown))
        return settings.replaced(target_error=0.0, samples=min(settings.samples, _DATA_SAMPLES))

    def _render(self, session):
        schedule = Schedule(session)
        while schedule.start():
            while not schedule.wait(_STEP).finished:
                if self._is_over():
                    schedule.cancel()
                self._engine.update_progress(schedule.fraction)
            if self._is_over():
                break
        return schedule

    def _tell_error(self, session, schedule):
        """Report the error of all light that the texels with a surface show, whatever part of it is baked."""
        numbers = render_report.account(session, schedule)
        for name in ("error", "error_low", "error_high", "error_cannot_exclude"):
            numbers[name] /= math.sqrt(self._shown)
        settings = session.settings.replaced(target_error=session.settings.target_error / math.sqrt(self._shown))
        for line in render_report.lines(numbers, settings):
            self._engine.report({"INFO"}, f"Lancer: bake of '{self._thing.original.name}': {line}")


def _view(scene, kind):
    if kind == "ENVIRONMENT":
        return BakeView.SKY
    return BakeView.CAMERA if getattr(scene.render.bake, "view_from", "") == "ACTIVE_CAMERA" else BakeView.ABOVE


def _camera(depsgraph, width, height):
    """Return the snapshot.Camera of the scene, for nodes that read it, with the size of the image."""
    thing = depsgraph.scene.camera
    if thing is None or thing.type != "CAMERA":
        return snapshot.Camera(width=width, height=height)
    fields = camera_fields(thing.evaluated_get(depsgraph), depsgraph, Messages())
    return snapshot.Camera(width=width, height=height, **{**fields, "lens_radius": 0.0})
