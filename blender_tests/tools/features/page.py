"""The page of the features' costs: a table with a verdict on each feature that is only compiled in, and one of nodes."""

from tools.harness import page, verdicts

_TOLD = """A minimal scene, a diffuse ball on a diffuse floor under a point lamp, with one feature at a time. Used: the ball,
the lamp, the sky, the camera or the settings have the feature. Only compiled in: an object behind the camera, a lamp below the
floor or a sky that is hidden from all rays has it, so that its code is compiled in but does not run. Figures are the extra time
for the same samples: medians with their 95 % intervals."""
_NODES_TOLD = """Nanoseconds of one evaluation of a node for one vertex, in lanes: the difference of pictures with nine copies
and with one. The Material tab tells the last column, from a table that is scaled by the speed of this machine."""
_NODES_HEAD = ["node", "measured", "told before a render"]
_HEAD = ["feature", "PATH: used", "only compiled in", "", "kernel", "CLASSIC: used", "only compiled in", ""]


def percent(value):
    return f"{value['cost'] * 100:+.1f} % ± {value['uncertainty'] * 100:.1f}"


def in_nanoseconds(value):
    return f"{value['nanoseconds']:.0f} ns ± {value['uncertainty']:.0f}"


def verdict(value, goal):
    """Return True if the interval is within the goal, False if it is beyond the goal, None if it contains the goal."""
    if value["cost"] + value["uncertainty"] <= goal:
        return True
    return False if value["cost"] - value["uncertainty"] > goal else None


def _judged(idle, goal):
    return (idle["note"], "absent") if "note" in idle else verdicts.words(verdict(idle, goal), "within the interval")


def write(figures, folder):
    machine = figures["machine"]
    where = f"{machine['processor']}, {machine['system']}, one thread; commit {figures['commit']}"
    where += ". A short run." if figures["quick"] else "."
    rows = [_row(name, found, figures["goal"]) for name, found in figures["cases"].items()]
    parts = [where, _TOLD, page.table(_HEAD, rows)]
    if figures["nodes"]:
        told = [[name, in_nanoseconds(found), f"{found['told']:.0f} ns"] for name, found in figures["nodes"].items()]
        parts += [_NODES_TOLD, page.table(_NODES_HEAD, told)]
    page.write(folder, "features", figures, "What features cost", parts)


def _row(name, found, goal):
    cells = [name]
    for integrator in ("PATH", "CLASSIC"):
        used, idle = (found.get(integrator, {}).get(kind) for kind in ("used", "idle"))
        cells += [percent(used) if used else "", percent(idle) if idle else "", _judged(idle, goal) if idle else ""]
        if integrator == "PATH":
            cells.append(((idle or used)["kernel"] if found.get(integrator) else "", "text"))
    return cells
