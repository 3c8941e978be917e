"""The chart of `make scaling`: speedup against workers, both logarithmic, a line for each still."""

# Colours tell the size of the picture, dashes the network and the end.
_HD, _UHD = "#1b6ca8", "#d9822b"
_LINES = {"A": (_HD, "-"), "B": (_HD, "--"), "C": (_HD, ":"), "D": (_UHD, "-"), "E": (_UHD, "--"), "F": (_UHD, ":")}
_APART = 11  # points between two labels, one above the other


def write(figures, folder):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axis = pyplot.subplots(figsize=(9.0, 5.6), layout="constrained")
    ends = []
    for still in figures["stills"]:
        rows, (color, dashes) = still["rows"], _LINES[still["letter"]]
        workers, speedups = [row["workers"] for row in rows], [row["speedup"] for row in rows]
        axis.plot(workers, speedups, dashes, color=color, lw=1.7, marker="o", ms=3)
        ends.append((speedups[-1], f"{still['letter']}  {_short(still)}", color))
    most = max(row["workers"] for still in figures["stills"] for row in still["rows"])
    axis.plot([1, most], [1, most], color="#999999", lw=0.8, zorder=0)
    _axes(axis, figures, most)
    figure.draw_without_rendering()
    _labels(axis, ends, most)
    figure.savefig(folder / "scaling.png", dpi=110, facecolor="white")
    pyplot.close(figure)


def _short(still):
    size, ends, kind, network = still["name"].split(", ")
    return f"{size}, {ends}, {'denoising, ' if 'denoising' in kind else ''}{network}"


def _axes(axis, figures, most):
    from matplotlib import ticker

    axis.set_xscale("log")
    axis.set_yscale("log")
    least = min(row["speedup"] for still in figures["stills"] for row in still["rows"])
    axis.set_xlim(0.9, most * 1.15)
    axis.set_ylim(min(0.8, 0.9 * least), most * 1.3)
    for side in (axis.xaxis, axis.yaxis):
        side.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
        side.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
        side.set_minor_formatter(ticker.NullFormatter())
    axis.grid(which="major", lw=0.4, color="#dddddd")
    axis.set_axisbelow(True)
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)
    axis.set_xlabel("workers")
    axis.set_ylabel("times as fast as one machine")
    axis.set_title("A still of one hour on many machines, simulated; the thin line is the ideal", loc="left", fontsize=11)


def _labels(axis, ends, most):
    """Draw the labels beside the ends of the lines, apart from each other."""
    points = axis.figure.dpi / 72.0
    at = None
    for speedup, label, color in sorted(ends, key=lambda end: -end[0]):
        place = axis.transData.transform((most, speedup))[1] / points
        at = place if at is None else min(place, at - _APART)
        axis.annotate(
            label, (most, speedup), xytext=(9, at - place), textcoords="offset points", va="center", color=color, fontsize=8.5,
            annotation_clip=False,
        )  # fmt: skip
