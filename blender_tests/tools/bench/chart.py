"""The chart of a run, as SVG and PNG."""

import numpy as np

_COLORS = {
    "lancer": "#1b6ca8",
    "cycles": "#d9822b",
    "mitsuba_llvm": "#3d9a5f",
    "mitsuba_scalar": "#9bc8aa",
    "luxcore": "#8e6bb0",
}


def write(figures, folder):
    """Draw two rows of bars, samples/s and efficiency, with a group for each scene. Return the files' names."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    scenes = {name: scene for name, scene in figures["scenes"].items() if not scene.get("failed")}
    figure, axes = pyplot.subplots(2, 1, figsize=(max(6.0, 1.3 * len(scenes) + 2.0), 7.0), sharex=True, layout="constrained")
    _bars(axes[0], figures, scenes, _rate)
    axes[0].set_ylabel("million samples/s")
    axes[0].legend(fontsize=8)
    _bars(axes[1], figures, scenes, _efficiency)
    axes[1].set_ylabel("efficiency, Lancer = 1\n1 / (squared error x seconds)")
    axes[1].set_xticks(range(len(scenes)), list(scenes), rotation=20, ha="right")
    machine = figures["machine"]
    figure.suptitle(f"{machine['processor']}, {figures['threads']} threads, {figures['commit']}", fontsize=9)
    names = [f"bench.{kind}" for kind in ("svg", "png")]
    for name in names:
        figure.savefig(folder / name, dpi=110)
    pyplot.close(figure)
    return names


def _bars(axis, figures, scenes, value_of):
    keys = [key for key in _COLORS if key in figures["renderers"]]
    width = 0.8 / max(1, len(keys))
    for number, key in enumerate(keys):
        places, heights, errors = [], [], []
        for place, scene in enumerate(scenes.values()):
            found = value_of(scene["renderers"], key)
            if found is not None:
                value, low, high = found
                places.append(place + (number - (len(keys) - 1) / 2) * width)
                heights.append(value)
                errors.append((value - low, high - value))
        if heights:
            title = figures["renderers"][key]["title"]
            spread = np.array(errors).T
            axis.bar(places, heights, width, color=_COLORS[key], label=title, yerr=spread, error_kw={"lw": 0.7})
    axis.set_yscale("log")
    axis.grid(axis="y", lw=0.3)


def _rate(records, key):
    rate = records.get(key, {}).get("samples_per_second")
    return None if rate is None else tuple(rate[name] / 1e6 for name in ("median", "min", "max"))


def _efficiency(records, key):
    ours, theirs = (records.get(k, {}).get("efficiency") for k in ("lancer", key))
    if not ours or not theirs or not ours["value"] > 0.0:
        return None
    value = theirs["value"] / ours["value"]
    low, high = theirs["low"] or theirs["value"], theirs["high"] or theirs["value"]
    return value, low / ours["value"], high / ours["value"]
