"""The page and the tables of `make tradeoff`."""

import shutil

from tools.harness import page
from tools.harness.page import element, markdown
from tools.harness.places import ROOT, TABLES

_TITLES = {"PATH": "Lancer PATH", "PATH, meshes": "Lancer PATH, meshes for exact shapes"}


def percent(share):
    return f"{100.0 * share:.3g} %"


def _seconds(value):
    return f"{value:.3g}"


def caption(figures):
    """Yield the sentences below the chart."""
    ours, theirs, apart = figures["reference"], figures["cycles_reference"], figures["apart"]
    width, height = figures["size"]
    yield (
        f"{figures['scene']}, {width} x {height}, {figures['bounces']} bounces, box filter, no clamping, no denoising; only "
        f"the presets end at a target error. Medians of {figures['seeds']} seeds, one for the longest; bands: least to most."
    )
    yield (
        f"Errors are against converged pictures of other seeds: PATH's at {ours['samples']} samples, with an error of "
        f"{percent(ours['error'])}, and for Cycles its own at {theirs['samples']}, with an error of {percent(theirs['error'])}."
        " The reference's error is subtracted, in squares."
    )
    yield (
        f"The two references differ by {percent(apart['median'])} of the picture's level in the median square of 8 x 8 pixels: "
        "each engine is compared with the picture that it converges to."
    )
    yield (
        "CLASSIC and NORMALS compute another picture than PATH, without indirect light: their error against PATH's reference "
        "levels off, and so does that of meshes in place of exact shapes; Cycles also renders the meshes."
    )
    yield "Seconds are those of rendering alone; a table has the seconds before the first sample."
    yield "Lancer has only one precision, so float and double are not compared."


def tables(figures):
    """Yield (title, head, rows) of each table."""
    rows = []
    for name, points in figures["curves"].items():
        for row in points:
            error = f"{percent(row['error'])} ({percent(row['least'])} to {percent(row['greatest'])})"
            cells = [str(row["samples"]), _seconds(row["seconds"]), error, percent(row["noise"]), percent(row["bias"])]
            rows.append([_TITLES.get(name, name), *cells])
    yield "Curves", ["", "samples", "seconds", "error (least to greatest)", "noise", "bias"], rows
    yield "Presets", *presets_table(figures)
    yield "Seconds to equal error", *equal_table(figures)
    preparation = figures["preparation"]
    before = [[name, _seconds(value)] for name, value in preparation.items()]
    yield "Before the first sample", ["Lancer", "seconds"], before
    slopes = [[name, f"{value:.2f}"] for name, value in figures["slopes"].items()]
    yield "Error falls with seconds to the power of minus", ["", "power"], slopes


def presets_table(figures):
    rows = [
        [
            name,
            percent(row["target"]),
            f"{row['samples']:.0f}",
            _seconds(row["seconds"]),
            percent(row["error"]),
            percent(row["told"]),
            row["ended_by"],
        ]
        for name, row in figures["presets"].items()
    ]
    head = [
        "preset",
        "target error",
        "samples, on average",
        "seconds",
        "error against the reference",
        "reported error",
        "ended by",
    ]
    return head, rows


def equal_table(figures):
    rows = [
        [percent(row["error"]), _seconds(row["lancer"]), _seconds(row["cycles"]), f"{row['cycles'] / row['lancer']:.1f}"]
        for row in figures["equal_error"]
    ]
    return ["error", "Lancer PATH, seconds", "Cycles, seconds", "times as fast"], rows


def where(figures):
    machine = figures["machine"]
    text = f"{machine['processor']}, {machine['processors']} processors, load {machine['load']} at the start; "
    text += f"{figures['threads']} "
    return f"{text}threads; Blender {figures['blender']}; commit {figures['commit']}" + (
        ". A short run." if figures["quick"] else "."
    )


def write(figures, folder):
    told, title = [where(figures), *caption(figures)], f"Error and seconds: {figures['scene']}"
    parts = [element("img", None, src="tradeoff.svg", width=900), *told]
    text = "\n\n".join([f"# {title}", *told])
    for name, head, rows in tables(figures):
        parts += [element("h2", name), page.table(head, rows)]
        text += f"\n\n## {name}\n\n{markdown(head, rows)}"
    page.write(folder, "tradeoff", figures, title, parts)
    (folder / "table.md").write_text(f"{text}\n", encoding="utf-8")


def update_tables(figures, folder, path=TABLES):
    page.put_between(path, "tradeoff", [where(figures), markdown(*presets_table(figures))])
    shutil.copyfile(folder / "tradeoff.png", ROOT / "scenes" / "tradeoff.png")
