"""The page and the JSON that a run leaves: every scene with both pictures, their difference, and figures beside limits."""

import html
import json
import math
import os

import numpy as np

from scenes.parity import png

_STYLE = """
body { font: 14px sans-serif; margin: 24px; color: #222; background: #f4f4f4 }
table { border-collapse: collapse; background: #fff } td, th { padding: 4px 8px; border: 1px solid #ccc; vertical-align: top }
img { width: 240px; image-rendering: pixelated; display: block; background: #000 }
.pass { color: #07702c } .fail, .error { color: #b00020; font-weight: bold } .noise { color: #9a6700 } .absent { color: #777 }
td.figures { white-space: nowrap; font-family: monospace }
"""


def write(outcomes, folder, title):
    pictures = os.path.join(folder, "pictures")
    os.makedirs(pictures, exist_ok=True)
    rows = "\n".join(_row(outcome, pictures) for outcome in outcomes)
    text = f"""<!DOCTYPE html><html><head><meta charset="utf-8"><title>Parity</title><style>{_STYLE}</style></head><body>
<h1>{html.escape(title)}</h1><p>{html.escape(summary(outcomes))}</p>
<table><tr><th>Scene</th><th>Lancer</th><th>Cycles</th><th>Difference x 8</th><th>Figures</th><th>Remarks</th></tr>
{rows}</table></body></html>"""
    with open(os.path.join(folder, "index.html"), "w", encoding="utf-8") as file:
        file.write(text)
    with open(os.path.join(folder, "parity.json"), "w", encoding="utf-8") as file:
        json.dump({"title": title, "scenes": [_record(outcome) for outcome in outcomes]}, file, indent=1)


def summary(outcomes):
    names = ("pass", "fail", "noise", "error", "absent")
    counts = {name: sum(outcome.verdict == name for outcome in outcomes) for name in names}
    reasons = sorted({outcome.note for outcome in outcomes if outcome.verdict == "absent"})
    text = f"{len(outcomes)} scenes: " + ", ".join(f"{counts[name]} {name}" for name in names if counts[name])
    return text + (f" ({'; '.join(reasons)})" if reasons else "")


def _row(outcome, folder):
    case = outcome.case
    begin = f'<tr><td><b>{case.name}</b><br>{case.subject}<br><span class="{outcome.verdict}">{outcome.verdict}</span></td>'
    remarks = [outcome.note] if outcome.note else []
    if case.reason:
        remarks.append(f"Limit of its own: {case.reason}")
    remarks += [f"Lancer: {text}" for text in outcome.messages]
    remarks = "<br>".join(html.escape(text) for text in remarks)
    if not outcome.parts:
        return f"{begin}<td></td><td></td><td></td><td></td><td>{remarks}</td></tr>"
    worst = outcome.worst
    images = "".join(
        f'<td><img src="pictures/{name}"></td>' for name in write_pictures(folder, case.name, *outcome.pictures[worst])
    )
    return f'{begin}{images}<td class="figures">{"<br>".join(_lines(outcome))}</td><td>{remarks}</td></tr>'


def _lines(outcome):
    limit = outcome.case.limits
    for name, (numbers, verdict) in outcome.parts.items():
        yield f'<b>{html.escape(name)}</b> <span class="{verdict.name}">{verdict.name}</span>'
        yield f"mean {numbers.mean:.3%} of {limit.mean:.3%}, noise {numbers.noise_mean:.3%}"
        yield f"p99 {numbers.p99:.3%} of {limit.p99:.3%}, noise {numbers.noise_p99:.3%}"
        if numbers.dim:
            yield f"dim parts: mean {numbers.dim.mean:.3%}, noise {numbers.dim.noise_mean:.3%}"
            yield f"p99 {numbers.dim.p99:.3%}, noise {numbers.dim.noise_p99:.3%}"
    yield f"{outcome.samples} samples; " + ", ".join(f"{engine} {time:.1f} s" for engine, time in outcome.seconds.items())


def write_pictures(folder, name, ours, theirs):
    """Writes ours, theirs and their difference x 8, all as bright as theirs asks for, and gives the three file names."""
    # Show the brightest hundredth as white, so that dark passes can be read too.
    brightest = float(np.percentile(np.abs(np.nan_to_num(theirs)), 99))
    exposure = 1.0 / brightest if brightest > 0.0 else 1.0
    difference = 8.0 * np.abs(ours - theirs)
    names = []
    for suffix, picture in (("lancer", ours), ("cycles", theirs), ("difference", difference)):
        names.append(f"{name}-{suffix}.png")
        with open(os.path.join(folder, names[-1]), "wb") as file:
            file.write(png.encode(png.display(picture, exposure)))
    return names


def _record(outcome):
    case = outcome.case
    return {
        "name": case.name,
        "subject": case.subject,
        "class": case.kind_name,
        "limit": case.limits._asdict(),
        "reason": case.reason,
        "verdict": outcome.verdict,
        "note": outcome.note,
        "samples": outcome.samples,
        "seconds": outcome.seconds,
        "passes": {name: {**as_record(numbers), "verdict": verdict.name} for name, (numbers, verdict) in outcome.parts.items()},
        "messages": outcome.messages,
    }


def as_record(figures):
    """JSON knows no infinity."""
    plain = {key: value if math.isfinite(value) else None for key, value in figures._asdict().items() if key != "dim"}
    return {**plain, "dim": as_record(figures.dim)} if figures.dim else plain
