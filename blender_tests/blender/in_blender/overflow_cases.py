"""A lamp that nearly touches the floor, so that its irradiance overflows single precision."""

import numpy as np
import stage

from addon.engine import render_engine as engine


def not_told():
    scene = stage.empty(16, 16, samples=2)
    stage.plane(material=stage.shader(Color=(0.5, 0.5, 0.5)))
    stage.light(energy=3e38, location=(0, 0, 1e-6), shadow_soft_size=0.0)
    stage.camera(location=(0, 0, 2), target=(0, 0, 0), type="ORTHO", ortho_scale=2e-4)
    try:
        picture, error = stage.picture(scene), ""
    except RuntimeError as failure:
        picture, error = np.zeros(1), str(failure)
    return {
        "error": error,
        "finite": bool(np.isfinite(picture).all()),
        "statistics": {k: v for k, v in engine.last_statistics.get(scene.name, {}).items() if k.startswith("invalid")},
        "messages": list(engine.last_messages.get(scene.name, ())),
    }


def told():
    return not_told()


told.overflows = True
