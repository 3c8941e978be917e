"""The settings of motion blur: when the shutter is open, and at which times objects and the camera are read.

Relative times run from -1, where the shutter opens, to 1, where it closes, as in Cycles; 0 is its middle.
"""

from dataclasses import dataclass

import numpy as np

from ..bindings import snapshot
from ..bindings.enums import Pass

# Samples of the shutter's curve, and entries of its table, as in Cycles; steps of the opening that follows from them.
_CURVE = 256
_OPENING = 2049
# The fewest and the most keys of lancer_motion.
LEAST_KEYS, MOST_KEYS = 3, 129


@dataclass(frozen=True)
class Shutter:
    """The shutter of one picture. frames: how long it is open; middle: the time of its middle, in frames."""

    frames: float
    middle: float
    opening: object  # how far it is open over time, for snapshot.Motion; None: nothing is blurred, times are those of vectors
    rolling: bool = False
    rolling_duration: float = 0.1

    @property
    def blurs(self):
        return self.opening is not None

    def frame_at(self, relative):
        """Return the time of a relative time, in frames."""
        return self.middle + 0.5 * relative * self.frames


def blurs_motion(scene, view_layer):
    """Whether a picture of the view layer has motion blur."""
    return scene.render.use_motion_blur and view_layer.use_motion_blur


def shutter_of(scene, view_layer, passes):
    """Return the Shutter of a view layer's picture with these passes; None if nothing moves in it.

    With motion blur the pass Vector is empty, as in Cycles.
    """
    render = scene.render
    now = scene.frame_current + scene.frame_subframe
    if not blurs_motion(scene, view_layer):
        return Shutter(2.0, now, None) if Pass.VECTOR in passes else None
    # Properties of Cycles, an add-on that may be disabled. The position was one of them before Blender 4.2.
    cycles = getattr(scene, "cycles", None)
    position = getattr(render, "motion_blur_position", None) or getattr(cycles, "motion_blur_position", "CENTER")
    frames = render.motion_blur_shutter
    middle = now + {"START": 0.5, "CENTER": 0.0, "END": -0.5}[position] * frames
    return Shutter(
        frames,
        middle,
        _opening(render.motion_blur_shutter_curve),
        getattr(cycles, "rolling_shutter_type", "NONE") != "NONE",
        min(max(getattr(cycles, "rolling_shutter_duration", 0.1), 0.0), 1.0),
    )


def _opening(mapping):
    mapping.initialize()
    curve = mapping.curves[0]
    values = np.array([mapping.evaluate(curve, i / (_CURVE - 1)) for i in range(_CURVE)])
    return opening_of(np.where(np.isfinite(values), np.maximum(values, 0.0), 0.0))


def opening_of(values):
    """Return how far Cycles' shutter is open, at equal steps of time. values: its curve, at as many steps as its table has.

    Cycles chooses times by a table that is read between the middles of its entries and that ends early: an even curve gives the
    times 0.002 to 0.994, evenly. A picture of a fast edge shows the difference, half a percent of the edge's contrast.
    """
    count = len(values)
    # The curve is summed at one step fewer than it has, each read a step early, and the inverse of the sums is scaled to all.
    steps = np.arange(count - 1) / (count - 2)
    sums = np.concatenate([[0.0], np.cumsum(np.interp(steps * count - 1.0, np.arange(count), values))])
    if not sums[-1] > 0.0:
        return np.ones(2, np.float32)
    middles = (np.arange(count) + 0.5) / count
    times = np.interp(middles, sums / sums[-1], np.arange(count)) / count
    lengths = np.diff(times)
    place = np.arange(_OPENING) / (_OPENING - 1.0)
    # Between two entries all times are equally likely.
    inside = np.clip(np.searchsorted(times, place, "right") - 1, 0, count - 2)
    density = np.where(lengths[inside] > 0.0, 1.0 / np.maximum(lengths[inside], 1e-12), 0.0)
    density[(place < times[0]) | (place > times[-1])] = 0.0
    return (density / density.max()).astype(np.float32)


def key_count(thing, owner, shutter):
    """Return the number of keys of an object, 0 if it stands still. owner: its instancer, or itself."""
    if not shutter.blurs:
        return LEAST_KEYS
    steps = 0
    for one in dict.fromkeys((thing, owner)):
        settings = getattr(one, "cycles", None)
        if not getattr(settings, "use_motion_blur", True):
            return 0
        steps = max(steps, getattr(settings, "motion_steps", 1))
    return min((2 << (max(steps, 1) - 1)) + 1, MOST_KEYS)


def reshapes(thing, shutter):
    """Whether the deformation of an object is blurred, or shown by the pass Vector."""
    return not shutter.blurs or getattr(getattr(thing, "cycles", None), "use_deform_motion", True)


def relative_times(count):
    """Return the relative times of so many keys."""
    return tuple(2.0 * i / (count - 1) - 1.0 for i in range(count))


def as_motion(shutter, cameras):
    """Return the snapshot.Motion of a Shutter. cameras: snapshot.Cameras at the keys, or none."""
    return snapshot.Motion(
        shutter=shutter.opening, keys=cameras, rolling=shutter.rolling, rolling_duration=shutter.rolling_duration
    )
