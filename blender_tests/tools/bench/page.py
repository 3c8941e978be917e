"""The output of the benchmark: bench.json, index.html, and the tables of README files."""

from tools.harness import denoised, page, verdicts
from tools.harness.page import element, lines
from tools.harness.places import README, TABLES

from . import goals

_STYLE = "img.picture { width: 192px }"
# Measurements besides scenes and rays.
_REST = (
    "first_look", "first_shown", "frames", "edits", "shared", "million", "instances", "build", "threads_scaling",
    "many_machines", "bakes", "classic", "accelerators", "before",
)  # fmt: skip
# The renderers of the table for users.
_USERS = ("lancer", "cycles")


def write(figures, folder, chart_names):
    charts = (element("img", None, src=name, alt="chart") for name in chart_names if name.endswith(".svg"))
    parts = [
        describe(figures),
        page.table(verdicts.HEAD, [verdicts.row(goal) for goal in figures["goals"]]),
        *charts,
        _heading("Scenes"),
        *(part for name, scene in figures["scenes"].items() for part in _scene(name, scene, figures)),
        _heading("Rays"),
        *_rays(figures.get("rays", {})),
        _heading("Beside the scenes"),
        _rest(figures),
        _heading("Roofline"),
        *_roofline(figures),
    ]
    page.write(folder, "bench", figures, f"Benchmark of {figures['commit']}", parts, _STYLE)


def _heading(text):
    return element("h2", text)


def describe(figures):
    """Return machine, threads, versions, and missing renderers, in one paragraph."""
    machine = figures["machine"]
    text = f"{machine['processor']}, {machine['processors']} processors, {machine['memory_gib']} GiB, {machine['system']}; "
    text += f"{figures['threads']} threads; " + ("a short run; " if figures["quick"] else "")
    renderers = figures["renderers"].values()
    text += ", ".join(f"{r['title']} {r['version']}" for r in renderers if r.get("version"))
    missing = [f"{r['title']} ({r['missing']})" for r in renderers if r.get("missing")]
    return text + (". Missing: " + "; ".join(missing) if missing else ".")


def _scene(name, scene, figures):
    width, height = scene["size"]
    yield element("h3", f"{name}: {scene['title']}")
    if scene.get("failed"):
        yield element("p", scene["failed"], class_="no")
        return
    yield f"{width} x {height}, {scene['samples']} samples a pixel, {scene['triangles']} triangles, {scene['lights']} lamps"
    head = ["renderer", "million samples/s", "spread", "million rays/s", "set-up s", "first sample s", "peak MB"]
    head += ["squared error", "efficiency", "95 %", "difference: median, 90th percentile, level", "clock"]
    yield page.table(head, [_renderer(figures["renderers"][key]["title"], one) for key, one in scene["renderers"].items()])
    if scene.get("denoised"):
        head, rows = denoised.table(scene["denoised"]["compared"])
        yield page.table(head, rows)
    shown = [key for key, record in scene["renderers"].items() if "cannot" not in record and "failed" not in record]
    images = lines((element("img", None, class_="picture", src=f"pictures/{name}-{key}.png") for key in shown), "</td><td>")
    yield page.Markup(f"<table><tr><td>{images}</td></tr></table>")


def _renderer(title, record):
    for reason, kind in (("cannot", "absent"), ("failed", "no")):
        if reason in record:
            return [title, (f"{reason}: {record[reason]}", kind)]
    told = record.get("difference")
    difference = f"{told['median']:.3f}, {told['p90']:.3f}, {told['level']:+.3f} of {told['tolerance']:.2f}" if told else ""
    if told and not told["same"]:
        return [title, ("another picture, not counted", "no"), *[""] * 8, (difference, "no")]
    if "samples_per_second" not in record:
        return [title, ("not timed", "absent")]
    rate, clock = record["samples_per_second"], record["clock"]
    rays = sum(kind["median"] for kind in record.get("rays_per_second", {}).values())
    measured = record.get("efficiency", {})
    interval = f"{measured['low']:.3g} .. {measured['high']:.3g}" if measured.get("low") else ""
    return [
        title,
        f"{rate['median'] / 1e6:.3f}",
        f"{rate['min'] / 1e6:.3f} .. {rate['max'] / 1e6:.3f}",
        f"{rays / 1e6:.2f}" if rays else "",
        f"{record['setup_seconds']['median']:.2f}",
        f"{record['first_pixel_seconds']['median']:.2f}",
        f"{record['peak_bytes']['median'] / 1e6:.0f}",
        f"{record['mse']['median']:.3g}" if "mse" in record else "",
        f"{measured['value']:.3g}" if measured else "",
        interval,
        difference,
        clock,
    ]


def _rays(rays):
    if not rays or "missing" in rays:
        yield element("p", rays.get("missing", verdicts.NOT_MEASURED), class_="no")
        return
    kinds = ("primary", "diffuse", "shadow")
    rows = [["Lancer", *(f"{rays['lancer'][kind]['median'] / 1e6:.2f}" for kind in kinds)]]
    embree = rays.get("embree", {})
    for quality in ("fast", "robust"):
        for mode in embree.get(quality, {}).get("primary", {}):
            values = [embree[quality][kind][mode]["median"] / 1e6 for kind in kinds]
            rows.append([f"Embree {embree['version']} {quality}, {mode}", *(f"{value:.2f}" for value in values)])
    if "missing" in embree:
        yield f"Embree: {embree['missing']}"
    yield page.table(["million rays/s", *kinds], rows)


def _rest(figures):
    """Return a table with a row for each figure that has a median."""
    rows = []

    def walk(name, value):
        if isinstance(value, dict) and {"median", "min", "max"} <= value.keys():
            rows.append([name, *(f"{value[key]:.4g}" for key in ("median", "min", "max"))])
        elif isinstance(value, dict) and "missing" in value:
            rows.append([name, (f"not measured: {value['missing']}", "no"), "", ""])
        elif isinstance(value, dict):
            for key, inner in value.items():
                walk(f"{name}, {key.replace('_', ' ')}", inner)

    for name in _REST:
        walk(name.replace("_", " "), figures.get(name))
    return page.table(["what", "median", "smallest", "largest"], rows) if rows else verdicts.NOT_MEASURED


def _roofline(figures):
    """Yield the machine's limits, and the share of them that the library's rays reach if nodes and leaves are counted."""
    limits, rows = figures.get("limits", {}), figures.get("roofline", [])
    if "clock" not in limits:
        yield verdicts.NOT_MEASURED
        return
    yield f"Clock {limits['clock'] / 1e9:.2f} GHz, by additions that wait for one another."
    levels = [
        [n, f"{limits[n]['latency'] * 1e9:.1f}", f"{limits[n]['bandwidth'] / 1e9:.1f}"] for n in ("l1", "l2", "l3", "memory")
    ]
    yield page.table(["memory", "latency, ns", "reading, GB/s, all threads"], levels)
    if not rows:
        yield "Nodes and leaves a ray: no counters."
        return
    head = ["rays", "nodes a ray", "leaves a ray", "bound, million rays/s", "measured", "fraction"]
    million = {"bound": 1e-6, "measured": 1e-6}
    keys = ("nodes", "leaves", "bound", "measured", "fraction")
    yield page.table(head, [[row["what"], *(f"{row[key] * million.get(key, 1.0):.3g}" for key in keys)] for row in rows])


def update_tables(figures, tables=TABLES, readme=README):
    """Update the tables: ratios to other renderers for developers, samples/s of Lancer and Cycles for users."""
    text = f"{describe(figures)} Commit {figures['commit']}."
    rows = [verdicts.plain_row(verdict.as_dict()) for verdict in goals.judge_against_others(figures)]
    page.put_between(tables, "bench", [text, page.markdown(verdicts.HEAD, rows)])
    text = f"{figures['machine']['processor']}, {figures['threads']} threads; commit {figures['commit']}."
    page.put_between(readme, "speed", [_rates(figures), text], program="bench")


def _rates(figures):
    """Return rows of the scenes on which both renderers of the table for users were timed."""
    titles = [f"{figures['renderers'][key]['title']} {figures['renderers'][key]['version']}" for key in _USERS]
    rows = []
    for scene in figures["scenes"].values():
        rates = [scene["renderers"].get(key, {}).get("samples_per_second") for key in _USERS]
        if all(rates):
            rows.append([scene["title"], *(f"{rate['median'] / 1e6:.2f}" for rate in rates)])
    return page.markdown(["million samples/s", *titles], rows)
