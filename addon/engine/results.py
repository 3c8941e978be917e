"""Results of the last render of each scene, for the panels and for scripts."""

import dataclasses

import bpy
from bpy.app.handlers import persistent

from ..host.by_scene import ByScene

# Numbers of the last view layer; "layers" has those of all view layers, by their names.
last_statistics = ByScene()
# Messages of all view layers.
last_messages = ByScene()
# Features of Cycles that the render could not show: {key of Messages.add: count}.
last_missing = ByScene()
# A costs.Costs of the last measurement.
last_costs = ByScene()


def keep_costs(scene, costs):
    """Keeps the measured costs of a scene's features, among its statistics as well."""
    last_costs[scene] = costs
    if scene in last_statistics:
        last_statistics[scene]["feature_costs"] = {cost.name: dataclasses.asdict(cost) for cost in costs.measured}


@persistent
def _forget(*_):
    """Another file's scenes may have the same names."""
    for results in (last_statistics, last_messages, last_missing, last_costs):
        results.clear()


def register():
    bpy.app.handlers.load_pre.append(_forget)


def unregister():
    bpy.app.handlers.load_pre.remove(_forget)
    _forget()
