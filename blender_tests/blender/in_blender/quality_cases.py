"""Speed and accuracy of the presets, measured by the operator."""

import bpy
import stage
from uses_cases import plain_data


def _values(told):
    return [told.seconds.low, told.seconds.value, told.seconds.high, told.error.low, told.error.value, told.error.high]


def measured():
    """Run the operator without a window. Return its forecasts and lines, whether the file is unchanged, and a render's time."""
    from addon.engine import render_engine as engine
    from addon.operators import measure_quality

    scene = stage.room(width=64, height=36, samples=64)
    # The first update computes the matrices of new objects.
    bpy.context.view_layer.update()
    before = plain_data()
    result = bpy.ops.lancer.measure_quality(seconds=1.0)
    after = plain_data()
    told = {name: _values(forecast) for name, forecast in measure_quality.forecasts(scene)}
    lines = list(measure_quality.lines(scene))
    bpy.ops.render.render()
    numbers = engine.last_statistics[scene.name]
    old = {"rendered": measure_quality.is_old(scene)}
    scene.lancer.samples = 128
    more = dict(measure_quality.forecasts(scene))["As set"]
    scene.render.resolution_percentage = 200
    larger = dict(measure_quality.forecasts(scene))["As set"]
    old["other samples and size"] = measure_quality.is_old(scene)
    scene.render.resolution_percentage = 100
    scene.lancer.max_bounces = 2
    old["other bounces"] = measure_quality.is_old(scene)
    scene.lancer.max_bounces = 12
    old["bounces again"] = measure_quality.is_old(scene)
    scene.lancer.clamp_indirect = 10.0
    old["other clamp"] = measure_quality.is_old(scene)
    scene.lancer.clamp_indirect = 0.0
    bpy.data.objects["Cube"].location.x += 0.5
    bpy.context.view_layer.update()
    old["moved"] = measure_quality.is_old(scene)
    bpy.ops.lancer.measure_quality(seconds=0.2)
    old["measured again"] = measure_quality.is_old(scene)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return {
        "result": sorted(result),
        "changed": [key for key in after if after[key] != before.get(key)],
        "told": told,
        "lines": lines,
        "rendered": [numbers["seconds"], numbers["error"], numbers["error_low"], numbers["error_high"]],
        "more": _values(more),
        "larger": _values(larger),
        "old": old,
        "left": len(measure_quality.measured),
    }


def words():
    """Return the words for intervals of seconds."""
    from addon.measure.forecast import Range
    from addon.operators import measure_quality

    spans = {"sure": (60, 60, 60), "wide": (60, 20, 300), "untold": (900, 6, 133200), "short": (2, 0.2, 9)}
    return {name: measure_quality.seconds(Range(*values)) for name, values in spans.items()}


def missed():
    """Return the lines for a target error that the samples cannot reach."""
    from addon.operators import measure_quality

    scene = stage.room(width=32, height=18, samples=16)
    scene.lancer.target_error = 1e-4
    bpy.ops.lancer.measure_quality(seconds=0.5)
    return list(measure_quality.lines(scene))


_STARTED_WITH = ("quality", "target_error", "samples", "use_denoising", "max_bounces")


def defaults():
    """Return the settings of a new scene, and of files saved by the first releases and now, in each engine."""
    import os
    import tempfile

    from addon.settings import scene_settings

    def now():
        own = bpy.context.scene.lancer
        return [getattr(own, name) for name in _STARTED_WITH]

    def reopened(engine, old, **changes):
        bpy.ops.wm.read_factory_settings(use_empty=False)
        scene = bpy.context.scene
        scene.render.engine = engine
        for name, value in changes.items():
            setattr(scene.lancer, name, value)
        path = os.path.join(tempfile.mkdtemp(), "file.blend")
        if old:
            # The first releases did not record their defaults.
            bpy.app.handlers.save_pre.remove(scene_settings._saving)
        bpy.ops.wm.save_as_mainfile(filepath=path)
        if old:
            bpy.app.handlers.save_pre.append(scene_settings._saving)
        bpy.ops.wm.open_mainfile(filepath=path)
        return now()

    bpy.ops.wm.read_factory_settings(use_empty=False)
    found = {"new": now(), "saved": reopened("LANCER", False), "other engine": reopened("CYCLES", True)}
    found["old"] = reopened("LANCER", True)
    found["old and changed"] = reopened("LANCER", True, quality="FINAL", max_bounces=3, use_denoising=True)
    bpy.ops.wm.read_factory_settings(use_empty=False)
    scene = bpy.context.scene
    scene.render.engine = "LANCER"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 64, 36, 100
    bpy.ops.render.render()
    from addon.engine import render_engine as engine

    found["messages"] = list(engine.last_messages[scene.name])
    found["ended_by"] = engine.last_statistics[scene.name]["ended_by"]
    return found
