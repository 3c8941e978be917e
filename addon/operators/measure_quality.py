"""Measure Speed and Accuracy: forecasts of time and error for each preset of quality.

The measurement is kept until Blender quits; panels mark it as old after a change of the scene.
"""

import dataclasses
import functools
from dataclasses import dataclass

import bpy

from ..denoise import view_layer as denoise
from ..host.by_scene import ByScene
from ..measure import render_report
from ..measure.forecast import classic_seconds, forecast
from ..measure.trial_renders import measure
from ..settings.scene_settings import QUALITIES
from . import measuring

# An interval of time wider than this factor is not shown, unless its upper end is short (in seconds).
_TELLING = 20.0
_SHORT = 20.0

# Kept records by scene.
measured = ByScene()


@dataclass
class Kept:
    points: object  # forecast.Measured
    pixels: int  # of the picture at the measurement
    size: float  # _size() at the measurement, for scaling to a later resolution
    state: tuple  # measuring.state() at the measurement


def is_old(scene):
    return measured[scene].state != measuring.state(scene)


def _size(scene):
    render = scene.render
    return render.resolution_x * render.resolution_y * render.resolution_percentage**2


def _pixels(scene):
    """Return the number of pixels at the current resolution."""
    kept = measured[scene]
    return kept.pixels * _size(scene) / kept.size


def forecasts(scene):
    """Yield (name, Forecast) of each preset and of the current settings."""
    own, pixels, points = scene.lancer, _pixels(scene), _points(scene)
    for name, (error, samples) in QUALITIES.items():
        yield name.capitalize(), forecast(points, pixels, error, samples)
    yield "As set", forecast(points, pixels, own.target_error, own.samples, own.time_limit)


def _points(scene):
    """Return the Measured of the picture that the target error is about."""
    points, own = measured[scene].points, scene.lancer
    denoised = points.of_denoised() if own.use_denoising and own.use_denoised_target else None
    return denoised or points


def lines(scene):
    """Yield the lines of the panel."""
    for name, told in forecasts(scene):
        error, _ = QUALITIES.get(name.upper(), (scene.lancer.target_error, 0))
        short = (
            f"; {told.samples.value:.0f} samples end it above its {render_report.percent(error)}" if told.misses(error) else ""
        )
        yield f"{name}: {seconds(told.seconds)}; error {share(told.error)}{short}"
    samples = scene.lancer.samples
    classic = classic_seconds(measured[scene].points, _pixels(scene), samples)
    if classic is not None:
        yield f"Classic, {samples} sample{'s' if samples > 1 else ''}: about {render_report.duration(classic)}"


def seconds(told):
    value, low, high = (render_report.duration(item) for item in (told.value, told.low, told.high))
    if low == high:
        return f"about {value}"
    if told.high > _TELLING * told.low:
        return f"at most {high}" if told.high < _SHORT else "the time is unknown"
    # Panels are narrow: show a common unit once.
    number, _, unit = low.partition(" ")
    return f"about {value}, {number if high.endswith(f' {unit}') else low} to {high}"


def share(told):
    return f"{render_report.percent(told.value)}, {render_report.percent(told.low)} to {render_report.percent(told.high)}"


class LANCER_OT_measure_quality(measuring.Measuring, bpy.types.Operator):
    bl_idname = "lancer.measure_quality"
    bl_label = "Measure Speed and Accuracy"
    figures = measured
    bl_description = (
        "Render small pictures of the scene for some seconds, and predict the time and the error of each quality at the full "
        "size. The scene is not changed. Esc stops it"
    )

    seconds: bpy.props.FloatProperty(
        name="Seconds", description="Time of the measurement; more seconds give narrower intervals", min=0.1, default=10.0
    )

    def work(self):
        context = bpy.context
        denoised = denoise if denoise.ready(context.scene, context.view_layer) else None
        return functools.partial(measure, seconds=self.seconds, denoised=denoised)

    def begun(self, context, snapshot):
        camera = snapshot.camera
        pixels = camera.region_width * camera.region_height
        self._kept = Kept(None, pixels, _size(context.scene), measuring.state(context.scene))

    def keep(self, scene, measurement):
        found = measurement.found
        # A render includes the export: add its time.
        self._kept.points = dataclasses.replace(found, before=found.before + measurement.exporting)
        measured[scene] = self._kept
        for line in lines(scene):
            self.report({"INFO"}, f"Lancer: {line}")


def register():
    bpy.utils.register_class(LANCER_OT_measure_quality)


def unregister():
    bpy.utils.unregister_class(LANCER_OT_measure_quality)
