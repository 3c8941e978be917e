"""The page and the JSON of a run: every scene with both pictures, their difference, figures and limits."""

import math
import os

from tools.harness import page
from tools.harness.page import element, lines
from tools.harness.pictures import write_pair

_STYLE = """
td { vertical-align: top; text-align: left } img { width: 240px }
.pass { color: #07702c } .fail, .error { color: #b00020; font-weight: bold } .noise { color: #9a6700 }
td.figures { white-space: nowrap; font-family: monospace }
"""
_HEAD = ["scene", "Lancer", "Cycles", "difference x 8", "figures", "remarks"]


def write(outcomes, folder, title):
    pictures = os.path.join(folder, "pictures")
    os.makedirs(pictures, exist_ok=True)
    table = page.table(_HEAD, [_row(outcome, pictures) for outcome in outcomes])
    record = {"title": title, "scenes": [_record(outcome) for outcome in outcomes]}
    page.write(folder, "parity", record, title, [summary(outcomes), table], _STYLE)


def summary(outcomes):
    names = ("pass", "fail", "noise", "error", "absent")
    counts = {name: sum(outcome.verdict == name for outcome in outcomes) for name in names}
    reasons = sorted({outcome.note for outcome in outcomes if outcome.verdict == "absent"})
    text = f"{len(outcomes)} scenes: " + ", ".join(f"{counts[name]} {name}" for name in names if counts[name])
    return text + (f" ({'; '.join(reasons)})" if reasons else "")


def _row(outcome, folder):
    case = outcome.case
    remarks = [outcome.note] if outcome.note else []
    if case.reason:
        remarks.append(f"Limit of its own: {case.reason}")
    remarks += [f"Lancer: {text}" for text in outcome.messages]
    name = lines((element("b", case.name), case.subject, element("span", outcome.verdict, class_=outcome.verdict)))
    if not outcome.parts:
        return [name, *[""] * 4, lines(remarks)]
    shown = write_pair(folder, case.name, *outcome.pictures[outcome.worst])
    images = [element("img", None, src=f"pictures/{picture}") for picture in shown]
    return [name, *images, (lines(_figures(outcome)), "figures"), lines(remarks)]


def _figures(outcome):
    limit = outcome.case.limits
    for name, (numbers, verdict) in outcome.parts.items():
        yield lines((element("b", name), element("span", verdict.name, class_=verdict.name)), " ")
        yield f"mean {numbers.mean:.3%} of {limit.mean:.3%}, noise {numbers.noise_mean:.3%}"
        yield f"p99 {numbers.p99:.3%} of {limit.p99:.3%}, noise {numbers.noise_p99:.3%}"
        if numbers.dim:
            yield f"dim parts: mean {numbers.dim.mean:.3%}, noise {numbers.dim.noise_mean:.3%}"
            yield f"p99 {numbers.dim.p99:.3%}, noise {numbers.dim.noise_p99:.3%}"
    yield f"{outcome.samples} samples; " + ", ".join(f"{engine} {time:.1f} s" for engine, time in outcome.seconds.items())


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
    """Return the figures for JSON, which has no infinity."""
    plain = {key: value if math.isfinite(value) else None for key, value in figures._asdict().items() if key != "dim"}
    return {**plain, "dim": as_record(figures.dim)} if figures.dim else plain
