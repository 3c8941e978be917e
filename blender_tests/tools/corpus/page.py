"""The page of a run: every file with both pictures, their difference, figures and messages, in a table that can be sorted."""

import html
import json
from pathlib import Path

from tools.bench.page import STYLE

from . import verdicts

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
_HEAD += ("wide", "Lancer set-up, s", "export", "build", "Cycles set-up", "Lancer MB", "Cycles MB", "missing", "remarks")


def write(figures, folder):
    """Writes index.html; figures: as corpus.json has them."""
    rows = sorted(figures["files"], key=lambda row: (verdicts.ORDER.index(row["verdict"]), row["name"]))
    found = figures["summary"]
    script = (Path(__file__).with_name("table.js")).read_text(encoding="utf-8")
    buttons = "".join(
        f'<button data-verdict="{verdict}">{count} {html.escape(verdicts.words(verdict, count))}</button>'
        for verdict, count in found["counts"].items()
    )
    parts = [
        f"<h1>Files as their authors left them: {html.escape(figures['commit'])}</h1>",
        f"<p>{html.escape(describe(figures))}</p>",
        f'<p><button data-verdict="">all {found["files"]} files</button>{buttons}</p>',
        _means(found["means"]),
        _missing(found["missing"]),
        '<table class="files sortable"><thead><tr>' + "".join(f"<th>{name}</th>" for name in _HEAD) + "</tr></thead><tbody>",
        *(_row(row) for row in rows),
        "</tbody></table>",
    ]
    head = f'<meta charset="utf-8"><title>Corpus</title><style>{STYLE}{_STYLE}</style>'
    text = "\n".join(parts)
    page = f"<!DOCTYPE html><html><head>{head}</head><body>{text}<script>{script}</script></body></html>\n"
    (folder / "index.html").write_text(page, encoding="utf-8")
    (folder / "corpus.json").write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")


def describe(figures):
    machine, plan = figures["machine"], figures["plan"]
    text = f"{figures['date']}; Blender {figures['blender']}; {machine['processor']}, {plan['threads']} threads; "
    text += "a short run; " if figures["quick"] else ""
    return text + (
        f"{plan['pixels']} pixels on the longer side, {plan['rounds']} seeds of each engine by turns. Speed, variance at equal "
        "samples and efficiency, 1 / (variance x seconds), are Lancer's over Cycles'; the variance leaves out the hundredth of "
        "the pixels where either engine's is largest. Wide: share of the vertices that kernels of many lanes shaded."
    )


def _means(means):
    head = ["Lancer over Cycles, geometric means", "files", "samples/s", "variance", "efficiency", "least efficiency", "wide"]
    lines = ["".join(f"<th>{name}</th>" for name in head)]
    for title, key in (("files with equal pictures", "equal"), ("all files", "all")):
        found = means[key]
        cells = [_times(found[name]) for name in ("speed", "variance", "efficiency", "least_efficiency")]
        cells = [str(found["files"]), *cells, _percent(found["wide_share"])]
        lines.append(f'<td class="text">{title}</td>' + "".join(f"<td>{cell}</td>" for cell in cells))
    return "<table>" + "".join(f"<tr>{line}</tr>" for line in lines) + "</table>"


def _missing(ranked):
    if not ranked:
        return ""
    head = ["what is missing", "files made right, given all before", "in all", "files that have it", "uses"]
    lines = ["".join(f"<th>{name}</th>" for name in head)]
    for row in ranked:
        cells = (row["completes"], row["total"], row["files"], row["uses"])
        lines.append(f'<td class="text">{html.escape(row["key"])}</td>' + "".join(f"<td>{cell}</td>" for cell in cells))
    return "<table>" + "".join(f"<tr>{line}</tr>" for line in lines) + "</table>"


def _row(row):
    what = ", ".join(
        filter(None, (row["kind"], f"Blender {row['saved_by']}" if "saved_by" in row else "", row.get("engine", "")))
    )
    verdict, parity = row["verdict"], row.get("parity", {})
    ours, theirs = (row["engines"].get(engine, {}) for engine in ("LANCER", "CYCLES"))
    cells = [
        f'<td class="name">{html.escape(row["name"])}<br><span class="what">{html.escape(what)}</span></td>',
        f'<td class="text {verdict}" data-value="{verdicts.ORDER.index(verdict)}">{html.escape(verdicts.words(verdict))}</td>',
        *(
            f'<td><a href="pictures/{name}"><img src="pictures/{name}" loading="lazy"></a></td>'
            for name in row.get("pictures", ())
        ),
        *(["<td></td>"] * (3 - len(row.get("pictures", ())))),
        _cell(parity.get("mean"), _percent),
        _cell(parity.get("p99"), _percent),
        _cell(parity.get("noise_mean"), _percent),
        _cell(row.get("speed"), _times),
        _cell(row.get("variance", {}).get("ratio"), _times),
        _cell(row.get("efficiency"), _times),
        _cell(verdicts.wide_share(row), _percent),
        _cell(ours.get("setup_seconds"), _seconds),
        _cell(ours.get("export_seconds"), _seconds),
        _cell(ours.get("build_seconds"), _seconds),
        _cell(theirs.get("setup_seconds"), _seconds),
        _cell(ours.get("peak_bytes"), _megabytes),
        _cell(theirs.get("peak_bytes"), _megabytes),
        f'<td class="text" data-value="{len(row["missing"])}">{_lines(f"{k} ({n})" for k, n in row["missing"].items())}</td>',
        f'<td class="remarks"><div>{_lines(_remarks(row))}</div></td>',
    ]
    return f'<tr data-verdict="{verdict}">{"".join(cells)}</tr>'


def _remarks(row):
    yield from filter(None, (row["sentence"], row["note"], *row["told"]))
    if row["alike"]:
        yield "made alike: " + ", ".join(row["alike"])
    if "samples" in row:
        yield f"{row['samples']} samples, {row['rounds']} seeds, {row['size'][0]} x {row['size'][1]}, {row['seconds']:.0f} s"
    yield from (f"Lancer: {text}" for text in row["messages"])


def _lines(texts):
    return "<br>".join(html.escape(text) for text in texts)


def _cell(value, words):
    return '<td data-value=""></td>' if value is None else f'<td data-value="{value}">{words(value)}</td>'


def _percent(value):
    return "" if value is None else f"{value:.2%}"


def _times(value):
    return "" if value is None else f"{value:.2f}x"


def _seconds(value):
    return f"{value:.2f}"


def _megabytes(value):
    return f"{value / 1e6:.0f}"
