"""The chart of `make tradeoff`: error against seconds, both logarithmic, a name at the end of each curve."""

# Colour, dashes, and the name at the end of the curve.
_LOOKS = {
    "PATH": ("#1b6ca8", "-", "Lancer PATH"),
    "Cycles": ("#d9822b", "-", "Cycles"),
    "PATH, meshes": ("#7aa7c7", ":", "PATH, meshes for exact shapes"),
    "CLASSIC": ("#3d9a5f", "-", "CLASSIC"),
    "NORMALS": ("#8a8a8a", "-", "NORMALS"),
}
_PRESETS = "#12395c"
# A larger distance means only that the pictures differ.
_TOP = 4.0
_LINE = 12  # points between two names, one above the other
_WIDTH = 7  # points per letter


def write(figures, folder):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    # Text stays text, not outlines: smaller files, and the text can be searched.
    pyplot.rcParams["svg.fonttype"] = "none"
    figure, axis = pyplot.subplots(figsize=(8.6, 5.4), layout="constrained")
    for name, rows in figures["curves"].items():
        _curve(axis, name, rows)
    _presets(axis, figures["presets"])
    floor = figures["reference"]["error"]
    axis.axhline(floor, color="#999999", lw=0.8, ls="--", zorder=0)
    note = f"error of the reference itself, {100 * floor:.2g} %: it is subtracted"
    axis.annotate(
        note,
        (0.01, floor),
        xycoords=("axes fraction", "data"),
        xytext=(0, 3),
        textcoords="offset points",
        fontsize=7.5,
        color="#777777",
    )
    _axes(axis, figures, floor)
    figure.draw_without_rendering()
    _names(axis, figures["curves"])
    _own_name(axis, figures["curves"]["PATH"])
    for kind in ("svg", "png"):
        metadata = {"Date": None} if kind == "svg" else None
        figure.savefig(folder / f"tradeoff.{kind}", dpi=110, facecolor="white", metadata=metadata)
    pyplot.close(figure)


def _axes(axis, figures, floor):
    from matplotlib import ticker

    axis.set_xscale("log")
    axis.set_yscale("log")
    shown = [row for rows in figures["curves"].values() for row in rows] + list(figures["presets"].values())
    low, high = min(row["seconds"] for row in shown), max(row["seconds"] for row in shown)
    axis.set_xlim(low / 1.3, high * 3.0)
    axis.set_ylim(top=_TOP, bottom=min(floor, *(row["error"] for row in shown if row["error"] > 0.0)) / 1.4)
    axis.xaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g} s"))
    axis.yaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 3.0)))
    axis.yaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{100 * value:g} %"))
    axis.yaxis.set_minor_formatter(ticker.NullFormatter())
    axis.grid(which="major", lw=0.4, color="#dddddd")
    axis.set_axisbelow(True)
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)
    width, height = figures["size"]
    axis.set_xlabel(f"seconds of rendering, {width} x {height} pixels, {figures['threads']} threads")
    axis.set_ylabel("error: RMS of relative luminance")
    title = f"{figures['scene']}: farther left and lower is better"
    if figures["equal_error"]:
        row = figures["equal_error"][-1]
        title += f"; {100 * row['error']:g} % after {row['lancer']:.2g} s, with Cycles after {row['cycles']:.2g} s"
    axis.set_title(title, loc="left", fontsize=11, color="#333333")


def _curve(axis, name, rows):
    color, line, _ = _LOOKS[name]
    rows = [row for row in rows if row["error"] > 0.0]
    seconds = [row["seconds"] for row in rows]
    axis.plot(seconds, [min(row["error"], _TOP) for row in rows], line, color=color, marker="o", ms=3, lw=1.6)
    low, high = ([max(row[end], 1e-6) for row in rows] for end in ("least", "greatest"))
    axis.fill_between(seconds, low, high, color=color, alpha=0.15, lw=0)


def _names(axis, curves):
    """Draw the names of the other curves beside their ends; a name that would cover another moves below it."""
    points = axis.figure.dpi / 72.0
    ends = []
    for name, rows in curves.items():
        if name == "PATH":
            continue
        last = [row for row in rows if row["error"] > 0.0][-1:]
        for row in last:
            end = row["seconds"], min(row["error"], _TOP)
            ends.append((axis.transData.transform(end) / points, end, _LOOKS[name]))
    placed = []
    for (x, y), end, (color, _, label) in sorted(ends, key=lambda item: -item[0][1]):
        at = y
        for other_x, other_y, length in placed:
            if x < other_x + length and other_x < x + _WIDTH * len(label) and abs(at - other_y) < _LINE:
                at = other_y - _LINE
        placed.append((x, at, _WIDTH * len(label)))
        place = {"xytext": (7, at - y), "va": "center"}
        axis.annotate(label, end, textcoords="offset points", color=color, fontsize=9, weight="bold", **place)


def _own_name(axis, rows):
    """Draw the name of PATH on the left of its curve, where no slower curve is."""
    row, (color, _, label) = rows[-1], _LOOKS["PATH"]
    place = {"xytext": (-8, -3), "textcoords": "offset points", "ha": "right", "va": "top"}
    axis.annotate(label, (row["seconds"], row["error"]), fontsize=9, color=color, weight="bold", **place)


def _presets(axis, presets):
    rows = list(presets.values())
    axis.plot(
        [r["seconds"] for r in rows], [r["error"] for r in rows], "--", color=_PRESETS, lw=0.9, marker="D", ms=7, mec="white"
    )
    for name, row in presets.items():
        place = {"xytext": (6, 4), "textcoords": "offset points", "ha": "left", "va": "bottom"}
        axis.annotate(name, (row["seconds"], row["error"]), fontsize=9, color=_PRESETS, weight="bold", **place)
