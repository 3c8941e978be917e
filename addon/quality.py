"""What the presets of quality will cost and give on this scene: measured by an operator, told beside each of them.

The measurement is kept in this session, and is told to be old once what it depends on has changed.
"""

import dataclasses
import functools
import math
from dataclasses import dataclass

import bpy
from bpy.app.handlers import persistent

from . import stamp
from .bindings.forecast import classic_seconds, forecast
from .bindings.pilot import measure
from .measuring import Measuring
from .properties import QUALITIES

# Kept, by the scene's name.
measured = {}
# The same of measurements that may not have ended yet.
_begun = {}

# What the picture's noise and time hang on, apart from what a forecast is asked for and from the picture's size.
_OWN = (
    "integrator",
    "max_bounces",
    "contribution_threshold",
    "transparent_bounces",
    "environment_reflections",
    "clamp_indirect",
    "pixel_filter",
    "filter_width",
    "film_transparent_glass",
    "film_transparent_roughness",
    "accelerator",
    "features",
)
_RENDER = ("film_transparent", "use_border", "use_crop_to_border", "threads_mode", "threads", "use_simplify")


@dataclass
class Kept:
    points: object  # forecast.Measured
    pixels: int  # of the picture then
    size: float  # of the resolution then, by which a later one is scaled
    settings: tuple
    is_old: bool = False


def _settings(scene):
    own, render = scene.lancer, scene.render
    border = (render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y) if render.use_border else ()
    shape = render.resolution_x / render.resolution_y, render.pixel_aspect_x / render.pixel_aspect_y, *border
    values = [getattr(own, name) for name in _OWN] + [getattr(render, name) for name in _RENDER]
    return (*values, *shape, scene.camera.name if scene.camera else "", scene.frame_current)


def is_old(scene):
    kept = measured[scene.name]
    return kept.is_old or kept.settings != _settings(scene)


def _size(scene):
    render = scene.render
    return render.resolution_x * render.resolution_y * render.resolution_percentage**2


def _pixels(scene):
    """Of the picture as it would be rendered now."""
    kept = measured[scene.name]
    return kept.pixels * _size(scene) / kept.size


def forecasts(scene):
    """(name, Forecast) of each preset and of the numbers that are set now."""
    kept, own, pixels = measured[scene.name], scene.lancer, _pixels(scene)
    for name, (error, samples) in QUALITIES.items():
        yield name.capitalize(), forecast(kept.points, pixels, error, samples)
    yield "As set", forecast(kept.points, pixels, own.target_error, own.samples, own.time_limit)


def lines(scene):
    """What a panel shows, a line each."""
    for name, told in forecasts(scene):
        yield f"{name}: {seconds(told.seconds)}; error {share(told.error)}"
    samples = scene.lancer.samples
    classic = classic_seconds(measured[scene.name].points, _pixels(scene), samples)
    if classic is not None:
        yield f"Classic, {samples} sample{'s' if samples > 1 else ''}: about {clock(classic)}"


def seconds(told):
    value, low, high = clock(told.value), clock(told.low), clock(told.high)
    if low == high:
        return f"about {value}"
    # Panels are narrow: a unit that both have is told once.
    number, _, unit = low.partition(" ")
    return f"about {value}, {number if high.endswith(f' {unit}') else low} to {high}"


def share(told):
    return f"{stamp.percent(told.value)}, {stamp.percent(told.low)} to {stamp.percent(told.high)}"


def clock(value):
    """Two digits that mean something, in the unit that one would say."""
    if not math.isfinite(value):
        return "ever"
    for limit, unit, name in ((99.5, 1.0, "s"), (99.5 * 60.0, 60.0, "min"), (math.inf, 3600.0, "h")):
        if value < limit:
            return f"{_two_digits(value / unit)} {name}"


def _two_digits(value):
    if value >= 99.5:
        return f"{value:.0f}"
    return f"{value:.1f}" if value < 9.95 else f"{value:.0f}"


class LANCER_OT_measure_quality(Measuring, bpy.types.Operator):
    bl_idname = "lancer.measure_quality"
    bl_label = "Measure Speed and Accuracy"
    bl_description = (
        "Renders small pictures of the scene for some seconds, and tells how long each quality will take at the full size "
        "and how near it will come. Nothing in the scene is changed. Esc stops it"
    )

    seconds: bpy.props.FloatProperty(
        name="Seconds", description="How long to measure; more seconds give narrower figures", min=0.1, default=10.0
    )

    def work(self):
        return functools.partial(_measured, self.seconds)

    def begun(self, context, snapshot):
        camera = snapshot.camera
        pixels = camera.region_width * camera.region_height
        self._kept = _begun[context.scene.name] = Kept(None, pixels, _size(context.scene), _settings(context.scene))

    def keep(self, scene, measurement):
        found = measurement.found
        # F12 exports the scene, too.
        self._kept.points = dataclasses.replace(found, before=found.before + measurement.exporting)
        measured[scene.name] = self._kept
        for line in lines(scene):
            self.report({"INFO"}, f"Lancer: {line}")


def _measured(seconds, snapshot, poll, tell):
    return measure(snapshot, seconds, poll, tell)


@persistent
def _changed(scene, depsgraph):
    """Marks as old what was exported to be measured before an object, a material or a light changed."""
    current = [kept for kept in (measured.get(scene.name), _begun.get(scene.name)) if kept is not None and not kept.is_old]
    if current and any(u.is_updated_geometry or u.is_updated_transform or u.is_updated_shading for u in depsgraph.updates):
        for kept in current:
            kept.is_old = True


@persistent
def _forget(*_):
    measured.clear()
    _begun.clear()


_HANDLERS = (("depsgraph_update_post", _changed), ("load_pre", _forget))


def register():
    bpy.utils.register_class(LANCER_OT_measure_quality)
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    bpy.utils.unregister_class(LANCER_OT_measure_quality)
    _forget()
