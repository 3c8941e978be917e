"""Results of the last render of each scene, for panels and scripts."""

import dataclasses

import bpy
from bpy.app.handlers import persistent

from ..host.by_scene import ByScene

# Statistics of the last view layer; "layers" has those of all view layers by name.
last_statistics = ByScene()
# Messages of all view layers.
last_messages = ByScene()
# Features that Lancer does not support, as {key of Messages.add: count}.
last_missing = ByScene()
# The costs.Costs of the last measurement.
last_costs = ByScene()


def keep_costs(scene, costs):
    """Store the measured costs of a scene's features, in its statistics too."""
    last_costs[scene] = costs
    if scene in last_statistics:
        last_statistics[scene]["feature_costs"] = {cost.name: dataclasses.asdict(cost) for cost in costs.measured}


@persistent
def _forget(*_):
    """Drop all results before another file is loaded."""
    for results in (last_statistics, last_messages, last_missing, last_costs):
        results.clear()


def register():
    bpy.app.handlers.load_pre.append(_forget)


def unregister():
    bpy.app.handlers.load_pre.remove(_forget)
    _forget()
