"""The first picture of a final render: coarse, and there before the first tile."""

import dataclasses
import math

import numpy as np

from ..bindings.enums import Pass
from ..bindings.session import Session

# Pixels of the coarse picture: one sample of each takes a few milliseconds in most scenes.
_PIXELS = 4800
# A picture of few pixels has its first sample at once.
_LEAST_SIDE = 4
_STEP = 0.005


def coarse_picture(session, is_over):
    """Return Combined of a session's picture with large pixels, (height, width, 4) float32.

    None if the picture is small or a part of the image, or if the user cancels.
    """
    camera = session.camera
    width, height = camera.width, camera.height
    side = 2 ** round(0.5 * math.log2(max(1.0, width * height / _PIXELS)))
    if side < _LEAST_SIDE or getattr(session, "scene", None) is None or (camera.region_width, camera.region_height) != (width, height):
        return None
    across, up = math.ceil(width / side), math.ceil(height / side)
    coarse = camera.replaced(width=across, height=up, region_width=across, region_height=up)
    settings = dataclasses.replace(
        session.settings, samples=1, passes=(Pass.COMBINED,), target_error=0.0, time_limit=0.0, split_lights=1, split_paths=1
    )
    with Session(session.scene, coarse, settings) as first:
        first.render(0, 1)
        while not first.wait(_STEP).finished:
            if is_over():
                return None
        picture = first.read()
    return picture[np.arange(height) * up // height][:, np.arange(width) * across // width]
