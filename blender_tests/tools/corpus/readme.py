"""The summary as it stands in the README."""

from tools.bench.page import replace_between

from . import verdicts

BEGIN = "<!-- corpus: written by `make corpus README=1` -->"
END = "<!-- corpus: end -->"
_MOST_MISSING = 12


def text(figures):
    """figures: as corpus.json has them."""
    found, machine = figures["summary"], figures["machine"]
    lines = [
        f"{figures['date']}, commit {figures['commit']}, Blender {figures['blender']}; {machine['processor']}, "
        f"{figures['plan']['threads']} threads, {figures['plan']['pixels']} pixels"
        + ("; a short run." if figures["quick"] else "."),
        "",
        verdicts.sentence(found) + ".",
        "",
        "| Lancer over Cycles, geometric means | files | samples/s | variance | efficiency | least efficiency |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for title, key in (("files with equal pictures", "equal"), ("all files", "all")):
        lines.append(_means(title, found["means"][key]))
    untold = [row["name"] for row in figures["files"] if row["verdict"] in verdicts.FAULTS]
    if untold:
        lines += ["", "To be mended: " + ", ".join(f"`{name}`" for name in untold) + "."]
    if found["missing"]:
        lines += ["", "| what is missing | files made right | in all | files that have it |", "| --- | --- | --- | --- |"]
        rows = found["missing"][:_MOST_MISSING]
        lines += [f"| {_plain(row['key'])} | {row['completes']} | {row['total']} | {row['files']} |" for row in rows]
    return "\n".join(lines)


def _plain(key):
    """Of "node:Noise Texture" and "feature:volume"."""
    return f"{key.removeprefix('node:')} node" if key.startswith("node:") else key.removeprefix("feature:")


def _means(title, found):
    cells = [_times(found[name]) for name in ("speed", "variance", "efficiency", "least_efficiency")]
    return f"| {title} | {found['files']} | " + " | ".join(cells) + " |"


def _times(value):
    return "" if value is None else f"{value:.2f}x"


def update(path, figures):
    replace_between(path, BEGIN, END, text(figures))
