"""F12 by the workers of a scheduler."""

import bpy
import stage

from addon import engine
from addon.farm import pipe_pool


def f12(address, python):
    """Return whether the picture by a scheduler equals the one of this machine, and what was told."""
    scene = stage.room()
    scene.lancer.samples = 40
    told = []
    # Blender 3.4 gives its handlers no text.
    bpy.app.handlers.render_stats.append(lambda text, *_: told.append(text or ""))
    names = ("error", "samples", "split_lights", "split_paths", "rays", "triangles", "kernel", "features")
    return {**both(scene, address, python, names), "told": told}


def both(scene, address, python, names):
    """Render here and by the scheduler; return whether the bits are the same, and the statistics of these names."""
    here = stage.picture(scene)
    own = {name: engine.last_statistics[scene.name][name] for name in names}
    many(scene, address, python)
    there = stage.picture(scene)
    others = {name: engine.last_statistics[scene.name][name] for name in names}
    return {"same": here.tobytes() == there.tobytes(), "here": own, "there": others, "bright": float(here.max())}


def many(scene, address, python):
    scene.lancer.use_many_machines, scene.lancer.scheduler = True, address
    pipe_pool.default_python = python


def target(address, python):
    """Render to a target error; as f12()."""
    scene = stage.room()
    scene.lancer.samples, scene.lancer.target_error = 4096, 0.01
    return both(scene, address, python, ("ended_by", "error", "error_high", "samples", "samples_most"))


def failure(address, python):
    """Return the error of a render that cannot begin."""
    scene = stage.room()
    many(scene, address, python)
    try:
        stage.picture(scene)
    except RuntimeError as error:
        return str(error)
    return ""
