"""One bake of one object: exports the scene, renders the texels range by range, and hands their picture to Blender."""

import dataclasses
import math

import numpy as np

from ..bindings import snapshot
from ..bindings.abi import LancerError
from ..bindings.enums import BakeView, Catchers, InstanceFlag, InstanceKind, Integrator
from ..bindings.session import Scene, Session
from ..bindings.texels import EMPTY, Texels
from ..export.camera import camera_fields
from ..export.scene import ExportOptions, export_scene
from ..export.shutter import shutter_of
from ..host import shared_scenes
from ..host.priority import lowered
from ..measure import render_report
from ..measure.schedule import Schedule
from ..messages.messages import Messages
from ..messages.severity import Severity
from .pixels import read_texels, write_picture
from .wanted import wanted

_STEP = 0.05  # seconds between polls
_LIT = frozenset({"COMBINED", "AO", "DIFFUSE", "GLOSSY", "TRANSMISSION", "SHADOW"})
# Cycles bakes these of clear surfaces, too.
_PLACES = frozenset({"POSITION", "NORMAL"})
# Samples of passes without light: a texel's mean over its own area.
_DATA_SAMPLES = 64


class Bake:
    """The job of engine.bake().

    number: of the image among those of the object; tell(messages): reports Messages; is_over(): whether the user has cancelled.
    """

    def __init__(self, engine, depsgraph, thing, number, tell, is_over):
        self._engine, self._depsgraph, self._thing, self._number = engine, depsgraph, thing, number
        self._tell, self._is_over = tell, is_over
        self._shown = 0.0  # share of the texels that show the surface

    def run(self, kind, pass_filter, width, height):
        """Bake a type with Blender's bits of a pass filter into an image of this size."""
        asked = wanted(kind, pass_filter)
        if asked is None:
            raise LancerError(f"baking of type {kind.title()} is not supported: choose another type, or bake with Cycles")
        self._engine.update_stats("", "Exporting")
        # Blender finds the image of a result by the layer's name.
        result = self._engine.begin_result(0, 0, width, height, layer=f"bake {self._number}")
        try:
            rows = read_texels(result.layers[0], width, height)
            self._shown = float(np.mean(rows["triangle"] != EMPTY))
            if self._shown == 0.0:
                return
            shot = self._export(asked, width, height)
            baked = self._instance(shot.instances)
            if kind == "SHADOW":
                # As in Cycles, the baked object is one more shadow catcher.
                flags = shot.instances.flags.copy()
                flags[baked] |= np.uint32(InstanceFlag.CATCHER)
                shot.set("instances", shot.instances.replaced(flags=flags))
            texels = Texels(rows, baked, _view(self._depsgraph.scene, kind), asked.lacks)
            self._engine.update_stats("", "Building the scene")
            with lowered(lambda: self._session(shot, texels)) as session:
                self._tell(Messages.of_library(session.messages()))
                schedule = self._render(session)
                write_picture(result.layers[0], asked.picture(session.read))
                place = f"texel of '{self._thing.original.name}'"
                self._tell(render_report.left_out(dataclasses.asdict(session.statistics()), place))
                if kind in _LIT and not self._is_over():
                    self._tell_error(session, schedule)
        finally:
            self._engine.end_result(result)

    def _export(self, asked, width, height):
        camera = _camera(self._depsgraph, width, height)
        options = ExportOptions(passes=asked.passes, picture=camera)
        shot, messages = export_scene(self._depsgraph, options, self._is_over)
        scene = self._depsgraph.scene
        if shot.settings.integrator != Integrator.PATH:
            raise LancerError(f"scene '{scene.name}': only the integrator Path bakes, choose it in the render properties")
        if asked.kind == "COMBINED" and scene.lancer.use_denoising:
            messages.add(f"scene '{scene.name}': a bake is not denoised", severity=Severity.HINT)
        shutter, now = shutter_of(scene, self._depsgraph.view_layer, ()), scene.frame_current + scene.frame_subframe
        if shutter is not None and shutter.middle != now:
            theirs = f"that of Cycles the middle of the shutter, {shutter.middle:g}"
            messages.add(f"scene '{scene.name}': a bake shows the frame {now:g}, {theirs}")
        # The roughness of the first surface alone.
        changes = {"film_transparent": True, "blended_features": True}
        changes["catchers"] = Catchers.APART if asked.kind == "SHADOW" else Catchers.OBJECTS
        if asked.bounces is not None:
            changes["max_bounces"] = asked.bounces
        if asked.kind in _PLACES:
            changes["alpha_threshold"] = 0.0
        if asked.kind in _LIT:
            # Empty texels have no error, and lower the mean of squares over all.
            changes["target_error"] = shot.settings.target_error * math.sqrt(self._shown)
        else:
            changes |= {"target_error": 0.0, "samples": min(shot.settings.samples, _DATA_SAMPLES)}
        shot.set("settings", dataclasses.replace(shot.settings, **changes))
        self._tell(messages)
        return shot

    def _instance(self, table):
        """Return the row of the baked object itself, not of its instances."""
        name = self._thing.original.name
        if name in table.names:
            rows = np.flatnonzero((table.name_indices == table.names.index(name)) & (table.kinds == InstanceKind.MESH))
            if len(rows):
                return int(rows[0])
        if self._thing.lancer.shape != "MESH":
            raise LancerError(f"object '{name}' is shown as an exact shape: set its Shape to Mesh to bake it")
        raise LancerError(f"object '{name}' shows no mesh in the render: enable it for renders, and give it faces")

    def _session(self, shot, texels):
        before = shared_scenes.nearest(shot)
        scene = Scene.upload(shot, poll=self._is_over, before=before, stock=shared_scenes.stock)
        shared_scenes.remember(scene)
        return Session.bake(scene, shot.camera, shot.settings, texels)

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
