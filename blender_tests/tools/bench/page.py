"""What a run leaves: bench.json, index.html, and the README's table."""

import html
import json

from . import goals

BEGIN = "<!-- bench: written by `make bench README=1` -->"
END = "<!-- bench: end -->"

STYLE = """
body { font: 14px sans-serif; margin: 24px; color: #222; background: #f4f4f4 }
table { border-collapse: collapse; background: #fff; margin-bottom: 24px } td, th { padding: 4px 8px; border: 1px solid #ccc }
td { text-align: right } td.text, th.text { text-align: left }
.yes { color: #07702c } .no { color: #b00020 } .absent { color: #777 }
img.picture { width: 192px; image-rendering: pixelated; display: block; background: #000 }
"""


def write(figures, folder, chart_names):
    (folder / "bench.json").write_text(json.dumps(figures, indent=1) + "\n")
    parts = [
        f"<h1>Benchmark of {html.escape(figures['commit'])}</h1><p>{html.escape(describe(figures))}</p>",
        _table(["what", "goal", "measured", ""], [_goal_cells(goal) for goal in figures["goals"]]),
        "".join(f'<img src="{name}" alt="chart">' for name in chart_names if name.endswith(".svg")),
        "<h2>Scenes</h2>",
        *(_scene(name, scene, figures) for name, scene in figures["scenes"].items()),
        "<h2>Rays</h2>",
        _rays(figures.get("rays", {})),
        "<h2>Beside the scenes</h2>",
        _rest(figures),
        "<h2>Roofline</h2>",
        _roofline(figures),
    ]
    head = f'<!DOCTYPE html><html><head><meta charset="utf-8"><title>Benchmark</title><style>{STYLE}</style></head><body>'
    (folder / "index.html").write_text(head + "\n".join(parts) + "</body></html>\n", encoding="utf-8")


def describe(figures):
    """Machine, threads, versions, and who is missing, in one paragraph."""
    machine = figures["machine"]
    text = f"{machine['processor']}, {machine['processors']} processors, {machine['memory_gib']} GiB, {machine['system']}; "
    text += f"{figures['threads']} threads; " + ("a short run; " if figures["quick"] else "")
    renderers = figures["renderers"].values()
    text += ", ".join(f"{r['title']} {r['version']}" for r in renderers if r.get("version"))
    missing = [f"{r['title']} ({r['missing']})" for r in renderers if r.get("missing")]
    return text + (". Missing: " + "; ".join(missing) if missing else ".")


def _table(head, rows):
    def cells(row, tag):
        return "".join(f"<{tag} {_class(number, cell)}>{_plain(cell)}</{tag}>" for number, cell in enumerate(row))

    lines = [f"<tr>{cells(head, 'th')}</tr>", *(f"<tr>{cells(row, 'td')}</tr>" for row in rows)]
    return "<table>" + "\n".join(lines) + "</table>"


def _class(number, cell):
    kind = cell[1] if isinstance(cell, tuple) else ""
    return f'class="{"text " if number == 0 else ""}{kind}"'


def _plain(cell):
    return html.escape(str(cell[0] if isinstance(cell, tuple) else cell))


def _goal_cells(goal):
    state = {True: ("reached", "yes"), False: ("missed", "no"), None: (goals.NOT_MEASURED, "absent")}[goal["reached"]]
    return [goal["what"], goal["goal"], goal["measured"], state]


def _scene(name, scene, figures):
    width, height = scene["size"]
    title = f"<h3>{html.escape(name)}: {html.escape(scene['title'])}</h3>"
    if scene.get("failed"):
        return f'{title}<p class="no">{html.escape(scene["failed"])}</p>'
    told = f"{width} x {height}, {scene['samples']} samples a pixel, {scene['triangles']} triangles, {scene['lights']} lamps"
    head = ["renderer", "million samples/s", "spread", "million rays/s", "set-up s", "first sample s", "peak MB"]
    head += ["squared error", "efficiency", "95 %", "difference: median, 90th percentile, level", "clock"]
    rows = [_renderer(figures["renderers"][key]["title"], record) for key, record in scene["renderers"].items()]
    images = "".join(
        f'<td><img class="picture" src="pictures/{name}-{key}.png"></td>'
        for key, record in scene["renderers"].items()
        if "cannot" not in record and "failed" not in record
    )
    return f"{title}<p>{told}</p>{_table(head, rows)}<table><tr>{images}</tr></table>"


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
    if not rays:
        return "<p>not measured</p>"
    if "missing" in rays:
        return f'<p class="no">{html.escape(rays["missing"])}</p>'
    rows = []
    kinds = ("primary", "diffuse", "shadow")
    ours = ["Lancer", *(f"{rays['lancer'][kind]['median'] / 1e6:.2f}" for kind in kinds)]
    rows.append(ours)
    embree = rays.get("embree", {})
    for quality in ("fast", "robust"):
        for mode in embree.get(quality, {}).get("primary", {}):
            values = [embree[quality][kind][mode]["median"] / 1e6 for kind in kinds]
            rows.append([f"Embree {embree['version']} {quality}, {mode}", *(f"{value:.2f}" for value in values)])
    told = f"<p>Embree: {html.escape(embree['missing'])}</p>" if "missing" in embree else ""
    return told + _table(["million rays/s", *kinds], rows)


def _rest(figures):
    """What is measured beside scenes and rays: a line for each figure that has a median."""
    rows = []

    def walk(name, value):
        if isinstance(value, dict) and {"median", "min", "max"} <= value.keys():
            rows.append([name, *(f"{value[key]:.4g}" for key in ("median", "min", "max"))])
        elif isinstance(value, dict) and "missing" in value:
            rows.append([name, (f"not measured: {value['missing']}", "no"), "", ""])
        elif isinstance(value, dict):
            for key, inner in value.items():
                walk(f"{name}, {key.replace('_', ' ')}", inner)

    for name in (
        "first_look",
        "first_shown",
        "million",
        "instances",
        "build",
        "threads_scaling",
        "classic",
        "accelerators",
        "before",
    ):
        walk(name.replace("_", " "), figures.get(name))
    return _table(["what", "median", "smallest", "largest"], rows) if rows else "<p>not measured</p>"


def _roofline(figures):
    """What the machine can do, and how near the library's rays come to it where their nodes and leaves are counted."""
    limits, rows = figures.get("limits", {}), figures.get("roofline", [])
    if "clock" not in limits:
        return "<p>not measured</p>"
    told = f"<p>Clock {limits['clock'] / 1e9:.2f} GHz, by additions that wait for one another.</p>"
    levels = [
        [n, f"{limits[n]['latency'] * 1e9:.1f}", f"{limits[n]['bandwidth'] / 1e9:.1f}"] for n in ("l1", "l2", "l3", "memory")
    ]
    told += _table(["memory", "latency, ns", "reading, GB/s, all threads"], levels)
    if not rows:
        return told + "<p>Nodes and leaves a ray: no counters.</p>"
    head = ["rays", "nodes a ray", "leaves a ray", "bound, million rays/s", "measured", "fraction"]
    million = {"bound": 1e-6, "measured": 1e-6}
    keys = ("nodes", "leaves", "bound", "measured", "fraction")
    return told + _table(head, [[row["what"], *(f"{row[key] * million.get(key, 1.0):.3g}" for key in keys)] for row in rows])


def readme_table(figures):
    """The lines between the two markers."""
    keys = [key for key, renderer in figures["renderers"].items() if not renderer.get("missing")]
    titles = [f"{figures['renderers'][key]['title']} {figures['renderers'][key]['version']}" for key in keys]
    lines = [f"{describe(figures)} Commit {figures['commit']}.", ""]
    lines += ["| million samples/s | " + " | ".join(titles) + " |", "| --- |" + " --- |" * len(keys)]
    for name, scene in figures["scenes"].items():
        if scene.get("failed"):
            lines.append(f"| {name}: {scene['failed']} |" + " |" * len(keys))
            continue
        cells = [_readme_cell(scene["renderers"].get(key)) for key in keys]
        lines.append(f"| {name}: {scene['title']} | " + " | ".join(cells) + " |")
    lines += ["", "| goal | asked | measured | |", "| --- | --- | --- | --- |"]
    marks = {True: "reached", False: "missed", None: ""}
    for goal in figures["goals"]:
        lines.append(f"| {goal['what']} | {goal['goal']} | {goal['measured']} | {marks[goal['reached']]} |")
    return "\n".join(lines)


def _readme_cell(record):
    if record is None:
        return ""
    if "cannot" in record:
        return "cannot"
    if "failed" in record:
        return "failed"
    if not record.get("difference", {"same": True})["same"]:
        return "another picture"
    return f"{record['samples_per_second']['median'] / 1e6:.2f}" if "samples_per_second" in record else ""


def update_readme(path, figures):
    replace_between(path, BEGIN, END, readme_table(figures))


def replace_between(path, begin, end, text):
    """Puts text between two lines of a file that are there already."""
    whole = path.read_text(encoding="utf-8")
    if begin not in whole or end not in whole:
        raise ValueError(f"{path.name} lacks the lines between which the table belongs: {begin} and {end}")
    before, rest = whole.split(begin, 1)
    path.write_text(f"{before}{begin}\n{text}\n{end}{rest.split(end, 1)[1]}", encoding="utf-8")
