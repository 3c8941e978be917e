"""The output of a run: a page with both pictures and the figures of every file, in a sortable table; and the summary."""

from pathlib import Path

from tools.harness import denoised, page
from tools.harness.page import element, lines, markdown, percent, times
from tools.harness.places import TABLES

from . import verdicts

_GROUPS = (("files with equal pictures", "equal"), ("all files", "all"))
_STYLE = """
h1 { font-size: 20px } button { margin-right: 6px }
table.files td { vertical-align: top } table.sortable th { cursor: pointer; user-select: none }
th[data-order=up]::after { content: " \\25b2" } th[data-order=down]::after { content: " \\25bc" }
td.name { text-align: left; min-width: 170px; overflow-wrap: anywhere } td.remarks { text-align: left; min-width: 320px }
td.remarks div { max-height: 190px; overflow: auto } .what { color: #777 }
td img { width: 220px; display: block; background: #000 }
.untold, .failed { color: #b00020; font-weight: bold } .told, .cycles, .unreadable { color: #9a6700 }
.equal { color: #07702c } .noise { color: #3d7a4e } .black, .missing { color: #777 }
"""
_HEAD = ("file", "verdict", "Lancer", "Cycles", "difference x 8", "mean", "99th", "noise", "speed", "variance", "efficiency")
_HEAD += ("denoised: squared error", "FLIP", "time to FLIP")
_HEAD += ("Lancer set-up, s", "export", "build", "Cycles set-up", "Lancer MB", "Cycles MB", "missing", "remarks")


def write(figures, folder):
    """Write index.html and corpus.json."""
    rows = sorted(figures["files"], key=lambda row: (verdicts.ORDER.index(row["verdict"]), row["name"]))
    found = figures["summary"]
    buttons = {"": f"all {found['files']} files"}
    buttons |= {verdict: f"{count} {verdicts.words(verdict, count)}" for verdict, count in found["counts"].items()}
    parts = [
        describe(figures),
        lines((element("button", text, data_verdict=verdict) for verdict, text in buttons.items()), ""),
        page.table(*_means(found["means"])),
        page.table(
            ["missing feature", "files made right, given all before", "total", "files that use it", "uses"],
            [[row[name] for name in ("key", "completes", "total", "files", "uses")] for row in found["missing"]],
        )
        if found["missing"]
        else "",
        page.table(_HEAD, [_row(row) for row in rows], "files sortable"),
    ]
    script = (Path(__file__).with_name("table.js")).read_text(encoding="utf-8")
    title = f"Files as their authors left them: {figures['commit']}"
    page.write(folder, "corpus", figures, title, parts, _STYLE, script)


def describe(figures):
    machine, plan = figures["machine"], figures["plan"]
    text = f"{figures['date']}; Blender {figures['blender']}; {machine['processor']}, {plan['threads']} threads; "
    text += "a short run; " if figures["quick"] else ""
    return text + (
        f"{plan['pixels']} pixels on the longer side, {plan['rounds']} seeds of each engine by turns. Speed, variance at equal "
        "samples and efficiency, 1 / (variance x seconds), are Lancer's over Cycles'; the variance leaves out the hundredth of "
        "the pixels where either engine's is largest."
    )


def _means(means):
    """Return (head, rows)."""
    rows = []
    for title, key in _GROUPS:
        found = means[key]
        cells = [times(found[name]) for name in ("speed", "variance", "efficiency", "least_efficiency")]
        rows.append([title, found["files"], *cells])
    return ["Lancer over Cycles, geometric means", "files", "samples/s", "variance", "efficiency", "least efficiency"], rows


def _row(row):
    what = ", ".join(
        filter(None, (row["kind"], f"Blender {row['saved_by']}" if "saved_by" in row else "", row.get("engine", "")))
    )
    verdict, parity = row["verdict"], row.get("parity", {})
    ours, theirs = (row["engines"].get(engine, {}) for engine in ("LANCER", "CYCLES"))
    shown = [f"pictures/{name}" for name in row.get("pictures", ())]
    images = [element("a", element("img", None, src=name, loading="lazy"), href=name) for name in shown]
    missing = lines(f"{key} ({count})" for key, count in row["missing"].items())
    cells = [
        (lines((row["name"], element("span", what, class_="what"))), "name"),
        (verdicts.words(verdict), f"text {verdict}", verdicts.ORDER.index(verdict)),
        *images,
        *[""] * (3 - len(images)),
        *(_number(parity.get(name), lambda value: percent(value, 2)) for name in ("mean", "p99", "noise_mean")),
        _number(row.get("speed"), times),
        _number(row.get("variance", {}).get("ratio"), times),
        _number(row.get("efficiency"), times),
        *(_number(value, times) for value in _denoised(row)),
        *(_number(ours.get(name), _seconds) for name in ("setup_seconds", "export_seconds", "build_seconds")),
        _number(theirs.get("setup_seconds"), _seconds),
        *(_number(engine.get("peak_bytes"), _megabytes) for engine in (ours, theirs)),
        (missing, "text", len(row["missing"])),
        (element("div", lines(_remarks(row))), "remarks"),
    ]
    return page.row(cells, data_verdict=verdict)


def _denoised(row):
    """Return the ratios of squared error and FLIP at equal time, means over drafts, and of the time to Cycles' FLIP."""
    found = row.get("denoised", {}).get("compared")
    if not found:
        return None, None, None
    return denoised.mean(found["square"].values()), denoised.mean(found["flip"].values()), found["time"]


def _remarks(row):
    yield from filter(None, (row["sentence"], row["note"], *row["told"]))
    if row["alike"]:
        yield "made alike: " + ", ".join(row["alike"])
    if "samples" in row:
        yield f"{row['samples']} samples, {row['rounds']} seeds, {row['size'][0]} x {row['size'][1]}, {row['seconds']:.0f} s"
    yield from (f"Lancer: {text}" for text in row["messages"])


def _number(value, words):
    return ("", "", "") if value is None else (words(value), "", value)


def _seconds(value):
    return f"{value:.2f}"


def _megabytes(value):
    return f"{value / 1e6:.0f}"


def summary(figures):
    """Yield machine, counts of verdicts and means, as Markdown."""
    found, machine, plan = figures["summary"], figures["machine"], figures["plan"]
    yield f"{figures['date']}, commit {figures['commit']}, Blender {figures['blender']}; {machine['processor']}, " + (
        f"{plan['threads']} threads, {plan['pixels']} pixels" + ("; a short run." if figures["quick"] else ".")
    )
    yield verdicts.sentence(found) + "."
    yield markdown(*_means(found["means"]))
    rows = [_denoised(row) for row in figures["files"] if row.get("denoised")]
    if rows:
        means = [times(denoised.mean(column)) for column in zip(*rows, strict=True)]
        worst = max(value for square, flip, _ in rows for value in (square, flip) if value is not None)
        yield (
            f"Denoised, {len(rows)} files, Lancer over Cycles at the time of Cycles' drafts: squared error {means[0]}, FLIP "
            f"{means[1]}, at most {times(worst)}; time to Cycles' FLIP at {denoised.REACHED} samples {means[2]}."
        )


def update_tables(figures, path=TABLES):
    page.put_between(path, "corpus", summary(figures))
