"""The page and the tables of `make tradeoff`, and the README's."""

import html
import shutil

from tools.bench.page import STYLE

BEGIN = "<!-- tradeoff: written by `make tradeoff README=1` -->"
END = "<!-- tradeoff: end -->"
_TITLES = {"PATH": "Lancer PATH", "PATH, meshes": "Lancer PATH, meshes for exact shapes"}


def percent(share):
    return f"{100.0 * share:.3g} %"


def _seconds(value):
    return f"{value:.3g}"


def caption(figures):
    """Sentences that a reader of the chart needs."""
    ours, theirs, apart = figures["reference"], figures["cycles_reference"], figures["apart"]
    width, height = figures["size"]
    yield (
        f"{figures['scene']}, {width} x {height}, {figures['bounces']} bounces, box filter, nothing clamped, denoised or "
        f"stopped early but the presets; medians of {figures['seeds']} seeds, the longest of one. Bands: least to greatest."
    )
    yield (
        f"Errors are against converged pictures of other seeds: PATH at {ours['samples']} samples, itself off by "
        f"{percent(ours['error'])}, and for Cycles its own at {theirs['samples']}, off by {percent(theirs['error'])}. What the "
        "reference is off is subtracted, in squares."
    )
    yield (
        f"The two references differ by {percent(apart['median'])} of the picture's level in the median square of 8 x 8 pixels: "
        "each engine is measured against the picture that it itself converges to."
    )
    yield (
        "CLASSIC and NORMALS answer another question than PATH, without light that bounces: their distance to PATH's reference "
        "levels off where their noise ends, and so does that of meshes in place of exact shapes, of which Cycles renders the "
        "meshes, too."
    )
    yield "Seconds are those of rendering alone; the table has those before."
    yield "There is no choice of precision: the renderer has one, so float and double are not compared."


def tables(figures):
    """(title, head, rows) of all that was measured."""
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
        "as it tells",
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
    told = "".join(f"<p>{html.escape(text)}</p>" for text in (where(figures), *caption(figures)))
    parts = [f"<h1>Error and seconds: {html.escape(figures['scene'])}</h1>", '<img src="tradeoff.svg" width="900">', told]
    for title, head, rows in tables(figures):
        lines = ["".join(f"<th>{html.escape(cell)}</th>" for cell in head)]
        lines += ["".join(f"<td>{html.escape(cell)}</td>" for cell in row) for row in rows]
        parts.append(f"<h2>{html.escape(title)}</h2><table>" + "\n".join(f"<tr>{line}</tr>" for line in lines) + "</table>")
    style = f'<meta charset="utf-8"><title>Error and seconds</title><style>{STYLE}</style>'
    page = f"<!DOCTYPE html><html><head>{style}</head><body>{''.join(parts)}</body></html>\n"
    (folder / "index.html").write_text(page, encoding="utf-8")
    text = "\n\n".join([where(figures), *caption(figures)])
    text += "".join(f"\n\n## {title}\n\n{markdown(head, rows)}" for title, head, rows in tables(figures))
    (folder / "table.md").write_text(f"# Error and seconds: {figures['scene']}\n\n{text}\n", encoding="utf-8")


def markdown(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def update_readme(root, folder, figures):
    path = root / "README.md"
    text = path.read_text(encoding="utf-8")
    if BEGIN not in text or END not in text:
        raise ValueError(f"{path.name} lacks the lines between which the table belongs: {BEGIN} and {END}")
    shutil.copyfile(folder / "tradeoff.png", root / "scenes" / "tradeoff.png")
    before, rest = text.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    picture = "![Error against seconds, both logarithmic: Lancer's curves beside Cycles'](scenes/tradeoff.png)"
    parts = [picture, where(figures), markdown(*presets_table(figures)), markdown(*equal_table(figures))]
    path.write_text(f"{before}{BEGIN}\n" + "\n\n".join(parts) + f"\n{END}{after}", encoding="utf-8")
