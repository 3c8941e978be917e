"""The first picture of a final render: coarse, and there before the first tile."""

import dataclasses
import math

import numpy as np

from ..bindings.enums import Pass
from ..bindings.numbered_pass import extras
from ..bindings.session import Session

# Pixels of the coarse picture: one sample of each takes a few milliseconds in most scenes.
_PIXELS = 4800
# A picture of few pixels has its first sample at once.
_LEAST_SIDE = 4
_STEP = 0.005


class FirstLook:
    """Combined of a session without a whole sample: pixels that have none yet have the colours of large pixels.

    coarse: these colours, (height, width, 4) float32; None in a small picture, in a part of an image, and after a cancel.
    """

    def __init__(self, session, is_over):
        self._session = session
        self.coarse = _coarse_picture(session, is_over)

    def read(self, which):
        picture = self._session.read(which)
        if which == Pass.COMBINED and self.coarse is not None:
            blank = ~picture.any(axis=2)
            picture[blank] = self.coarse[blank]
        return picture


def _coarse_picture(session, is_over):
    camera, scene = session.camera, getattr(session, "scene", None)
    width, height = camera.width, camera.height
    side = 2 ** round(0.5 * math.log2(max(1.0, width * height / _PIXELS)))
    is_part = (camera.region_width, camera.region_height) != (width, height)
    if side < _LEAST_SIDE or is_part or scene is None:
        return None
    across, up = math.ceil(width / side), math.ceil(height / side)
    coarse = camera.replaced(width=across, height=up, region_width=across, region_height=up)
    settings = dataclasses.replace(
        session.settings,
        samples=1,
        passes=(Pass.COMBINED,),
        target_error=0.0,
        time_limit=0.0,
        split_lights=1,
        split_paths=1,
        **extras(()),
    )
    with Session(scene, coarse, settings) as first:
        first.render(0, 1)
        while not first.wait(_STEP).finished:
            if is_over():
                return None
        picture = first.read()
    return picture[np.arange(height) * up // height][:, np.arange(width) * across // width]
