"""The speed goals, each with its measurement in this run, from the figures of bench.json alone."""

from dataclasses import replace

from tools.harness import denoised, estimates
from tools.harness.verdicts import NOT_MEASURED, Verdict


def judge(figures):
    """Return a Verdict for each row of the table."""
    return [row(figures) for row in _ROWS]


def judge_against_others(figures):
    """Return the first Verdicts of judge(): those of ratios to another renderer."""
    return [row(figures) for row in _AGAINST_OTHERS]


def shown(figures, key, group=""):
    """Yield (scene, our record, theirs) of scenes where both were timed and show the same picture."""
    for name, scene in figures.get("scenes", {}).items():
        if scene.get("group", "") != group:
            continue
        ours, theirs = (scene.get("renderers", {}).get(k, {}) for k in ("lancer", key))
        same = theirs.get("difference", {"same": True})["same"]
        if "samples_per_second" in ours and "samples_per_second" in theirs and same:
            yield name, ours, theirs


def rate_ratios(figures, key, group=""):
    result = {}
    for name, ours, theirs in shown(figures, key, group):
        result[name] = ours["samples_per_second"]["median"] / theirs["samples_per_second"]["median"]
    return result


def efficiency_ratios(figures, key, group=""):
    result = {}
    for name, ours, theirs in shown(figures, key, group):
        if ours.get("errors") and theirs.get("errors"):
            pairs = [(record["errors"], record["seconds"]) for record in (ours, theirs)]
            result[name] = estimates.efficiency_ratio(*pairs)["value"]
    return result


def bake_ratios(figures):
    found = {name: get(bake, "efficiency_ratio", "value") for name, bake in get_dict(figures, "bakes").items()}
    return {name: value for name, value in found.items() if value}


def _denoised(figures):
    """Yield the comparisons of denoised pictures."""
    for scene in figures.get("scenes", {}).values():
        if scene.get("denoised"):
            yield scene["denoised"]["compared"]


def denoised_ratio(figures, kind):
    """Return the geometric mean over scenes of a ratio at equal time, of drafts of all numbers of samples, or of the time."""
    found = denoised.means(list(_denoised(figures)))
    return found["time"] if kind == "time" else denoised.mean(found[kind].values())


def get(figures, *keys):
    """Return figures[key][key] ..., or its median if it has one; None if a key is missing."""
    for key in keys:
        if not isinstance(figures, dict) or key not in figures:
            return None
        figures = figures[key]
    return figures.get("median") if isinstance(figures, dict) else figures


def over(a, b):
    return None if a is None or b is None or b == 0 else a / b


def at_least(what, goal, value, limit, text="{:.2f}x"):
    return _verdict(what, goal, value, text, lambda: value >= limit)


def at_most(what, goal, value, limit, text="{:.2f}x"):
    return _verdict(what, goal, value, text, lambda: value <= limit)


def _verdict(what, goal, value, text, reached):
    if value is None:
        return Verdict(what, goal, NOT_MEASURED, None)
    return Verdict(what, goal, text.format(value), reached())


def _ratios(what, goal, ratios, mean_limit, least_limit):
    """Judge the geometric mean and the smallest ratio; either limit may be None."""
    if not ratios:
        return Verdict(what, goal, NOT_MEASURED, None)
    mean, worst = estimates.geometric_mean(ratios.values()), min(ratios, key=ratios.get)
    text = f"{mean:.2f}x, least {ratios[worst]:.2f}x ({worst}), {len(ratios)} scenes"
    reached = (mean_limit is None or mean >= mean_limit) and (least_limit is None or ratios[worst] >= least_limit)
    return Verdict(what, goal, text, reached)


def _all(what, goal, parts):
    """Return a Verdict of several figures that must all reach their goals: (text, value, reached)."""
    texts = [f"{name} {NOT_MEASURED}" if value is None else f"{name} {text}" for name, value, text, _ in parts]
    if all(value is None for _, value, _, _ in parts):
        return Verdict(what, goal, NOT_MEASURED, None)
    known = [reached for _, value, _, reached in parts if value is not None]
    reached = False if not all(known) else (True if len(known) == len(parts) else None)
    return Verdict(what, goal, "; ".join(texts), reached)


def _part(name, value, text, reached):
    return name, value, "" if value is None else text.format(value), None if value is None else reached(value)


def _rays(figures):
    parts = []
    for kind, words, limit in (("primary", "camera", 0.8), ("shadow", "shadow", 0.9), ("diffuse", "scattered", 1.4)):
        modes = get_dict(figures, "rays", "embree", "fast", kind)
        best = max((get(modes, mode) for mode in modes), default=None)
        value = over(get(figures, "rays", "lancer", kind), best)
        parts.append(_part(words, value, "{:.2f}x", lambda x, limit=limit: x >= limit))
    return _all("rays/s against Embree 4.4, best of its single and packet modes", "0.8x, 0.9x, 1.4x", parts)


def get_dict(figures, *keys):
    for key in keys:
        figures = figures.get(key, {}) if isinstance(figures, dict) else {}
    return figures


def _build(figures):
    ratio = over(get(figures, "build", "embree_seconds"), get(figures, "build", "lancer_seconds"))
    held = get(figures, "million", "held_bytes_per_triangle")
    return _all(
        "BVH build, 1 million triangles",
        "not slower than Embree's medium quality; under 120 bytes a triangle",
        [
            _part("Embree's time / ours", ratio, "{:.2f}", lambda x: x >= 1.0),
            _part("bytes a triangle", held, "{:.0f}", lambda x: x < 120.0),
        ],
    )


def _instances(figures):
    seconds = get(figures, "instances", "total_seconds")
    memory = get(figures, "instances", "peak_bytes")
    return _all(
        "20 000 instances x 15 744 triangles: export, upload and build",
        "under 1 s, under 250 MB above Blender's own",
        [
            _part("seconds", seconds, "{:.2f}", lambda x: x < 1.0),
            _part("MB", None if memory is None else memory / 1e6, "{:.0f}", lambda x: x < 250.0),
        ],
    )


def _first_sample(figures):
    parts = []
    for name in ("balls", "million", "instances"):
        look = get_dict(figures, "first_look", name)
        time = over(get(look, "CYCLES", "seconds"), get(look, "LANCER", "seconds"))
        memory = over(get(look, "LANCER", "peak_bytes"), get(look, "CYCLES", "peak_bytes"))
        parts.append(_part(f"{name}: Cycles' time / ours", time, "{:.2f}", lambda x: x >= 1.3))
        parts.append(_part("our memory / Cycles'", memory, "{:.2f}", lambda x: x <= 1.0))
    goal = "1.3x; memory above Blender's own not more than Cycles'"
    return _all("F12 to the end of the first sample, against Cycles: balls; 1 million triangles; 20 000 instances", goal, parts)


def _heavy_set_up(figures):
    parts = []
    for name, words in (("terrain", "triangles"), ("crowd", "instances")):
        look = get_dict(figures, "first_look", name)
        for key, what in (("setup_seconds", "set-up"), ("peak_bytes", "memory")):
            value = over(get(look, "LANCER", key), get(look, "CYCLES", key))
            parts.append(_part(f"{words}: our {what} / Cycles'", value, "{:.2f}", lambda x: x <= 1.0))
    return _all("10 million triangles; 100 000 instances: F12 without its sampling, against Cycles", "1; 1", parts)


def _lights(figures):
    def seconds(name):
        return over(1.0, get(figures, "scenes", name, "renderers", "lancer", "samples_per_second"))

    few, many, most = (seconds(name) for name in ("lights2", "lights200", "lights10k"))
    return _all(
        "many lights: cost of a sample against that with 2",
        "200: at most 1.5x; 10 000: at most 2.5x",
        [
            _part("200:", over(many, few), "{:.2f}x", lambda x: x <= 1.5),
            _part("10 000:", over(most, few), "{:.2f}x", lambda x: x <= 2.5),
        ],
    )


def _exact(figures):
    rate = "renderers", "lancer", "samples_per_second"
    ratio = over(get(figures, "scenes", "balls_exact", *rate), get(figures, "scenes", "balls", *rate))
    return at_least("exact spheres instead of 238 082 triangles, balls, samples/s", "1.8x", ratio, 1.8)


def _threads(figures):
    ratio = get(figures, "threads_scaling", "times_faster")
    return at_least("2 threads against 1, balls", "1.9x on 2 real cores", ratio, 1.9)


def _many_machines(figures):
    """Two plain processes show what the machine allows; a picture of other bits would not count."""
    ratio, limit = (get(figures, "many_machines", name) for name in ("times_faster", "times_faster_without_a_road"))
    beside = "" if limit is None else f" ({limit:.2f}x without a road)"
    told = ratio if (figures.get("many_machines") or {}).get("equal", True) else None
    return at_least(f"two workers of Dask against one process, one thread each, balls{beside}", "1.9x, equal bits", told, 1.9)


def _window(figures):
    parts = []
    for name in ("longest", "median"):
        ours, theirs = (get(figures, "window", engine, name) for engine in ("LANCER", "CYCLES"))
        seconds = "" if ours is None or theirs is None else f"{ours:.2f} s, Cycles {theirs:.2f} s:"
        parts.append(_part(f"{name} {seconds}", over(ours, theirs), "{:.2f}x", lambda x: x <= 1.0))
    return _all("gaps of Blender's main loop while it renders in a window, against Cycles", "1.0x", parts)


def _view(figures):
    parts = []
    for name, words, limit in (("edits", "edit", 0.2), ("moves", "camera move", 0.1)):
        ours, theirs = (get(figures, "view", engine, name) for engine in ("LANCER", "CYCLES"))
        beside = "" if theirs is None else f" (Cycles {theirs:.2f} s)"
        parts.append(_part(f"first picture after {words}{beside}:", ours, "{:.2f} s", lambda x, limit=limit: x <= limit))
    ours, theirs = (get(figures, "view", engine, "pictures_per_second") for engine in ("LANCER", "CYCLES"))
    size = get(figures, "view", "LANCER", "pixel_size")
    beside = "" if theirs is None or size is None else f" (pixels of {size:.0f} x {size:.0f}; Cycles {theirs:.1f})"
    parts.append(_part(f"pictures a second while it turns{beside}:", ours, "{:.1f}", lambda x: x >= 8.0))
    return _all("3D view in Rendered shading, balls, 960 x 540, software GL", "0.2 s; 0.1 s; 8 a second", parts)


_EDITS = {"material": 0.1, "object": 0.1, "mesh": 0.15, "lamp": 0.15, "world": 0.15}


def _edits(figures):
    parts = []
    for name, limit in _EDITS.items():
        ours, theirs = (get(figures, "edits", engine, name) for engine in ("LANCER", "CYCLES"))
        beside = "" if theirs is None else f" (Cycles {theirs:.2f} s)"
        parts.append(_part(f"{name}{beside}:", ours, "{:.2f} s", lambda x, limit=limit: x <= limit))
    goal = "0.1 s; mesh, lamp, world 0.15 s"
    return _all("first picture after an edit, 3D view of a million faces, software GL", goal, parts)


def _frames(figures):
    parts = []
    for name in ("camera", "character", "instances"):
        ours, theirs = (get(figures, "frames", name, engine, "seconds") for engine in ("LANCER", "CYCLES"))
        parts.append(_part(f"{name}: our time / Cycles'", over(ours, theirs), "{:.2f}", lambda x: x <= 0.5))
    goal = "half of Cycles'"
    return _all("a frame beside its samples, Persistent Data: camera; deforming head; 20 000 moving instances", goal, parts)


def _memory(figures):
    """A leak of a frame's mesh alone would add 50 times 10 MB."""
    grown = get(figures, "frames", "steady", "growth_bytes")
    second = over(get(figures, "shared", "LANCER", "second"), get(figures, "shared", "LANCER", "first"))
    parts = [
        _part("50 frames add", None if grown is None else grown / 2**20, "{:.1f} MB", lambda x: x <= 4.0),
        _part("a second view of a million faces adds", second, "{:.2f} of the first", lambda x: x <= 0.1),
    ]
    return _all("memory of an animation of a deforming head; of two views of one scene", "flat; one scene", parts)


def _leaks(figures):
    """A leak misses the goal with any number of rays; no leak reaches it only with as many rays as the goal names."""
    count, rays = get(figures, "rays", "leaks"), get(figures, "rays", "leak_rays") or 0
    verdict = at_most("watertight: rays aimed at edges and vertices that leak", "0 in 1e8", count, 0, f"{{}} in {rays:.3g}")
    return replace(verdict, reached=None) if verdict.reached and rays < 1e8 else verdict


_AGAINST_OTHERS = (
    lambda f: _ratios("samples/s against Cycles", "3.5x in geometric mean", rate_ratios(f, "cycles"), 3.5, None),
    lambda f: _ratios(
        "samples/s against Mitsuba llvm_ad_rgb", "1x or more on every scene", rate_ratios(f, "mitsuba_llvm"), None, 1.0
    ),
    lambda f: _ratios("efficiency against Cycles", "6x in geometric mean", efficiency_ratios(f, "cycles"), 6.0, None),
    lambda f: _ratios(
        "lifelike scenes: samples/s against Cycles", "3x in geometric mean", rate_ratios(f, "cycles", "lifelike"), 3.0, None
    ),
    lambda f: _ratios(
        "lifelike scenes: efficiency against Cycles",
        "5x in geometric mean",
        efficiency_ratios(f, "cycles", "lifelike"),
        5.0,
        None,
    ),
    lambda f: _ratios(
        "motion blur: efficiency against Cycles", "3x on every scene", efficiency_ratios(f, "cycles", "moving"), None, 3.0
    ),
    lambda f: _ratios("bakes: efficiency against Cycles", "3x on every scene", bake_ratios(f), None, 3.0),
    lambda f: _ratios(
        "efficiency against Mitsuba llvm_ad_rgb",
        "10x in geometric mean, none below 1.5x",
        efficiency_ratios(f, "mitsuba_llvm"),
        10.0,
        1.5,
    ),
    _rays,
    lambda f: at_most("denoised drafts at equal time against Cycles: squared error", "0.5x", denoised_ratio(f, "square"), 0.5),
    lambda f: at_most("denoised drafts at equal time against Cycles: FLIP", "0.75x", denoised_ratio(f, "flip"), 0.75),
    lambda f: at_most("denoised: time to Cycles' FLIP at 128 samples", "0.4x", denoised_ratio(f, "time"), 0.4),
    lambda f: at_least(
        "CLASSIC on 600 exact spheres against POV-Ray 3.7, rays/s", "5x", get(f, "classic", "times_faster"), 5.0
    ),
)
_ROWS = (
    *_AGAINST_OTHERS,
    _leaks,
    _exact,
    _build,
    _instances,
    _first_sample,
    _heavy_set_up,
    lambda f: at_most(
        "first picture handed to Blender after F12, balls", "0.12 s", get(f, "first_shown", "seconds"), 0.12, "{:.2f} s"
    ),
    _lights,
    _threads,
    _many_machines,
    _window,
    _view,
    _edits,
    lambda f: at_most(
        "the add-on holds Blender's main loop after an edit, longest",
        "0.05 s",
        get(f, "edits", "LANCER", "hold"),
        0.05,
        "{:.3f} s",
    ),
    _frames,
    _memory,
)
