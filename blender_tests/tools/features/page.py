"""The page of what features cost: one table, with a verdict where a feature is only compiled in."""

import html

from tools.bench.page import STYLE

_TOLD = """A minimal scene, a matt ball on a matt floor under a point lamp, and one feature more at a time. Used: on the ball,
the lamp, the sky, the camera or in the settings; how much longer the same samples take. Only compiled in: the same scene, in
which an object behind the camera, a lamp below the floor or a sky that no ray may see has the feature, so that its code is
there and is not needed. Figures are medians with their 95 % intervals."""


def percent(value):
    return f"{value['cost'] * 100:+.1f} % ± {value['uncertainty'] * 100:.1f}"


def verdict(value, goal):
    """True where it is within the goal, False where it is beyond it for certain, None where the interval holds the goal."""
    if value["cost"] + value["uncertainty"] <= goal:
        return True
    return False if value["cost"] - value["uncertainty"] > goal else None


_WORDS = {True: ("reached", "yes"), False: ("missed", "no"), None: ("within the interval", "absent")}


def _judged(idle, goal):
    return (idle["note"], "absent") if "note" in idle else _WORDS[verdict(idle, goal)]


def page(figures):
    machine, goal = figures["machine"], figures["goal"]
    head = ["feature", "PATH: used", "only compiled in", "", "kernel", "CLASSIC: used", "only compiled in", ""]
    rows = [_row(name, found, goal) for name, found in figures["cases"].items()]
    where = f"{machine['processor']}, {machine['system']}, one thread; commit {figures['commit']}"
    where += ". A short run." if figures["quick"] else "."
    lines = ["".join(f"<th>{html.escape(text)}</th>" for text in head), *rows]
    table = "<table>" + "\n".join(f"<tr>{line}</tr>" for line in lines) + "</table>"
    style = f'<meta charset="utf-8"><title>What features cost</title><style>{STYLE}</style>'
    body = f"<h1>What features cost</h1><p>{html.escape(where)}</p><p>{html.escape(_TOLD)}</p>{table}"
    return f"<!DOCTYPE html><html><head>{style}</head><body>{body}</body></html>\n"


def _row(name, found, goal):
    cells = [(name, "text")]
    for integrator in ("PATH", "CLASSIC"):
        used, idle = (found.get(integrator, {}).get(kind) for kind in ("used", "idle"))
        cells.append((percent(used) if used else "", ""))
        cells.append((percent(idle) if idle else "", ""))
        cells.append(_judged(idle, goal) if idle else ("", ""))
        if integrator == "PATH":
            cells.append(((idle or used)["kernel"] if found.get(integrator) else "", "text"))
    return "".join(f'<td class="{kind}">{html.escape(text)}</td>' for text, kind in cells)
