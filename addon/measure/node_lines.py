"""Sentences about the nodes of a material: how many are left, and what each costs."""

_MOST = 8  # nodes that are named
_LEAST = 0.01  # share that is told as a number


def lines(use, slowness, statistics=None):
    """Return sentences about a ui.node_use.NodeUse.

    slowness: that of node_speed.py; statistics: those of the last render in engine.last_statistics, or None.
    """
    told = [_folded(use)]
    if not use.costs:
        return told
    total = use.nanoseconds
    share = _share_of_picture(total * slowness, statistics)
    told.append(f"About {_time(total * slowness)} for a hit of a ray{_of_picture(share)}")
    for name, cost in use.costs[:_MOST]:
        part = _of_picture(None if share is None else share * cost / total)
        told.append(f"{name}: {_time(cost * slowness)}, {_percent(cost / total)} of its nodes{part}")
    others = [cost for _, cost in use.costs[_MOST:]]
    if others:
        told.append(f"{len(others)} more: {_time(sum(others) * slowness)}, {_percent(sum(others) / total)}")
    return told


def _folded(use):
    if use.total == 0:
        return "No node computes a value"
    nodes = f"{use.total} nodes" if use.total > 1 else "1 node"
    if use.left == 0:
        return f"{nodes}: constant, which costs nothing"
    if use.left >= use.total:
        return f"All of its {nodes} are evaluated" if use.total > 1 else "Its node is evaluated"
    are = "are" if use.left > 1 else "is"
    return f"{use.left} of {nodes} {are} left: the others are constant, equal to one of these or change nothing"


def _share_of_picture(nanoseconds, statistics):
    """Return the share of the last render's time that these take if each ray hits the material; None if it is unknown."""
    seconds = statistics["render_seconds"] * statistics["threads"] if statistics else 0.0
    return min(1.0, statistics["vertices"] * nanoseconds * 1e-9 / seconds) if seconds > 0.0 else None


def _of_picture(share):
    if share is None:
        return ""
    return f", {'at most ' if share >= _LEAST else ''}{_percent(share)} of the picture's time"


def _percent(share):
    return f"{share * 100:.0f} %" if share >= _LEAST else "less than 1 %"


def _time(nanoseconds):
    return f"{nanoseconds / 1000:.1f} \N{MICRO SIGN}s" if nanoseconds >= 1000.0 else f"{nanoseconds:.0f} ns"
