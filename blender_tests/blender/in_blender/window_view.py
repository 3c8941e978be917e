"""Inside a real window: the delay until a 3D view in Rendered shading shows a change, and its pictures while it turns.

blender --factory-startup -p 0 0 960 540 -P window_view.py -- ANSWER.json ENGINE THREADS
"""

import os
import sys
import time

import numpy as np
from mathutils import Quaternion

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.dirname(HERE))), HERE]

import window_watch  # noqa: E402
from window_watch import DOWN, delay, seen  # noqa: E402

from addon.viewport import viewport  # noqa: E402
from scenes import spheres  # noqa: E402

ANSWER, ENGINE, THREADS = sys.argv[sys.argv.index("--") + 1 :]
SETTLING, RESTING, TURNING = 4.0, 1.5, 4.0  # seconds
TIMES = 5
STEP = 0.02  # radians by which the view turns in each round of Blender's loop


def measure():
    region, space = yield from window_watch.open_view(scene, ENGINE, 12.0, SETTLING)
    data = space.region_3d
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND").inputs["Strength"]
    edits, moves = [], []
    for number in range(TIMES):
        edits.append((yield from delay(lambda value=(20.0, 0.2)[number % 2]: setattr(background, "default_value", value))))
        yield RESTING
    # A bright sky above, a dim floor below.
    background.default_value = 20.0
    for item in scene.objects:
        item.hide_viewport = item.type == "LIGHT"
    yield RESTING
    for number in range(TIMES):
        turned = (Quaternion((1, 0, 0), 1.8), DOWN)[number % 2]
        moves.append((yield from delay(lambda turned=turned: setattr(data, "view_rotation", turned))))
        yield RESTING
    data.view_rotation = DOWN
    yield RESTING
    first, sizes, started = len(seen), [], time.monotonic()
    while time.monotonic() - started < TURNING:
        data.view_rotation = Quaternion((0, 0, 1), STEP) @ data.view_rotation
        sizes += [each.painter.picture.size for each in viewport._open]
        yield 0.016
    pictures = len({key for *_, key in seen[first:]})
    return {
        "edits": edits,
        "moves": moves,
        "pictures_per_second": pictures / (time.monotonic() - started),
        "pixel_size": float(np.median(sizes)) if sizes else None,
        "region": [region.width, region.height],
    }


scene = window_watch.start(ENGINE, THREADS)
spheres.build_balls(scene)
window_watch.run(measure, ANSWER)
