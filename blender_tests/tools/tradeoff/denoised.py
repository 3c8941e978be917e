"""`make tradeoff DENOISED=1`: errors of denoised pictures against seconds, with Lancer and with Cycles.

Both engines press F12 with Open Image Denoise and their own guides, by turns; errors are those of the displayed picture,
against the engine's own converged one. The scenes are those of the benchmark, or a file.
"""

import math
import shutil

import bpy

import addon
import scenes
from scenes.parity import png
from scenes.render import captured_output
from tools.bench import worker
from tools.harness import denoised, denoising
from tools.harness.denoised import COUNTS
from tools.harness.displayed import Displayed, displayed
from tools.harness.f12 import press_f12
from tools.harness.page import element, lines, markdown, put_between, table, write
from tools.harness.places import ROOT, TABLES, header
from tools.harness.terminal import Progress, wanted

SCENES = ("balls", "room", "glass_metal", "lights200", "models", "textured", "coated", "leaves", "product", "foliage")
_PIXELS = 240 * 180
_REFERENCE, _QUICK_REFERENCE = 4096, 512
# Cycles' own reference has half of the samples: a sample of Cycles takes longer.
_CYCLES_SHARE = 2
_SEEDS, _QUICK_SEEDS = 3, 1
_SHOWN = 32  # samples of Cycles in the pictures side by side


def run(arguments):
    with captured_output() as (terminal, _):
        figures = measure(arguments, Progress(terminal))
    folder = arguments.output
    _page(figures, folder)
    chart(figures, folder)
    if arguments.readme:
        put_between(
            TABLES, "denoised", [_told(figures), markdown(denoised.HEAD, list(_rows(figures))[-1:])], "tradeoff DENOISED=1"
        )
        shutil.copyfile(folder / "denoised.png", ROOT / "scenes" / "denoised.png")
    print(folder / "index.html")


def measure(arguments, say):
    told = header(arguments.quick)
    chosen = [arguments.blend] if arguments.blend else [name for name in SCENES if wanted(arguments.only, name)]
    found = {}
    for name in chosen:
        scene = _opened(name, arguments.threads)
        found[getattr(name, "stem", name)] = study(scene, arguments, say, getattr(name, "stem", name))
    means = denoised.means([one["compared"] for one in found.values()])
    return {**told, "blender": bpy.app.version_string, "threads": arguments.threads, "scenes": found, "means": means}


def _opened(name, threads):
    """Return the scene with equal settings of both engines, as small as the others; a file is never saved."""
    if isinstance(name, str):
        scene = scenes.load(name)
    else:
        bpy.ops.wm.open_mainfile(filepath=str(name.resolve()), load_ui=False)
        scene = bpy.context.scene
    render = scene.render
    factor = min(1.0, math.sqrt(_PIXELS / (render.resolution_x * render.resolution_y)))
    render.resolution_x, render.resolution_y = round(render.resolution_x * factor), round(render.resolution_y * factor)
    render.resolution_percentage = 100
    for layer in scene.view_layers:
        layer.samples = 0
    worker.make_alike(scene, threads)
    bpy.context.view_layer.update()
    return scene


def study(scene, arguments, say, name):
    """Return the figures of one scene."""
    counts = COUNTS[2:] if arguments.quick else COUNTS
    samples = arguments.samples or (_QUICK_REFERENCE if arguments.quick else _REFERENCE)
    references = {}
    denoising.denoise(scene, False)
    for engine, share in (("LANCER", 1), ("CYCLES", _CYCLES_SHARE)):
        scene.render.engine = engine
        halves = []
        for seed in (1001, 1002):
            worker.set_samples(scene, samples // (2 * share), seed)
            halves.append(press_f12(scene).picture[..., :3])
        references[engine] = Displayed.of(halves)
        say(f"{name}: reference of {engine}")
    denoising.denoise(scene)
    curves = {"LANCER": [], "CYCLES": []}
    for seed in range(1, 1 + (_QUICK_SEEDS if arguments.quick else _SEEDS)):
        for engine, found in curves.items():
            found.append(denoising.curve(scene, engine, counts, seed, worker.set_samples))
        say(f"{name}: seed {seed}")
    rows = {engine: denoised.measured(found, references[engine]) for engine, found in curves.items()}
    _side_by_side(arguments.output / "pictures", name, curves, references["LANCER"])
    return {
        "size": [scene.render.resolution_x, scene.render.resolution_y],
        "curves": rows,
        "told": _errors_told(scene, counts),
        "compared": denoised.compared(rows["LANCER"], rows["CYCLES"]),
    }


def _errors_told(scene, counts):
    """Return [(samples, error, low, high)] as Lancer tells them of its denoised pictures."""
    scene.render.engine, found = "LANCER", []
    for count in counts:
        worker.set_samples(scene, count, 1)
        press_f12(scene)
        numbers = addon.engine.last_statistics[scene.name]
        if math.isfinite(numbers["denoised_error"]):
            found.append([count, *(numbers[f"denoised_error{end}"] for end in ("", "_low", "_high"))])
    return found


def _side_by_side(folder, name, curves, reference):
    """Write the converged picture, Cycles' at _SHOWN samples, and Lancer's that took no longer, side by side."""
    theirs = next(point for point in curves["CYCLES"][0] if point[0] == _SHOWN)
    ours = [point for point in curves["LANCER"][0] if point[1] <= theirs[1]] or curves["LANCER"][0][:1]
    shown = (0.5 * (reference.first + reference.second), displayed(ours[-1][2]), displayed(theirs[2]))
    folder.mkdir(parents=True, exist_ok=True)
    for kind, picture in zip(("converged", "lancer", "cycles"), shown, strict=True):
        (folder / f"{name}-{kind}.png").write_bytes(png.encode(picture[::-1]))


def _rows(figures):
    for name, one in figures["scenes"].items():
        yield [name, *denoised.cells(one["compared"])]
    yield ["geometric mean", *denoised.cells(figures["means"])]


def _told(figures):
    machine = figures["machine"]
    return (
        f"{machine['processor']}, {machine['processors']} processors; {figures['threads']} threads; "
        f"Blender {figures['blender']}; commit {figures['commit']}. Lancer over Cycles at the seconds that Cycles takes with "
        "so many samples, both denoised."
    )


def _page(figures, folder):
    parts = [_told(figures), element("img", None, src="denoised.svg", alt="chart"), table(denoised.HEAD, list(_rows(figures)))]
    for name, one in figures["scenes"].items():
        parts.append(element("h3", name))
        images = (element("img", None, src=f"pictures/{name}-{kind}.png") for kind in ("converged", "lancer", "cycles"))
        parts.append(element("table", element("tr", element("td", lines(images, "</td><td>")))))
        rows = [
            [engine, str(row["samples"]), f"{row['seconds']:.2f}", f"{row['square']:.3g}", f"{row['flip']:.4f}"]
            + [f"{100 * row['error']:.2g} %"]
            for engine, curve in one["curves"].items()
            for row in curve
        ]
        parts.append(table(["", "samples", "seconds", "squared error", "FLIP", "relative error"], rows))
        told = [["told by Lancer", str(n), *(f"{100 * value:.2g} %" for value in values)] for n, *values in one["told"]]
        parts.append(table(["", "samples", "denoised error", "from", "to"], told))
    write(folder, "denoised", figures, f"Denoised pictures at {figures['commit']}", parts)


def chart(figures, folder):
    """Draw FLIP and relative error against seconds of the first four scenes, with the error that Lancer tells."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    names = list(figures["scenes"])[:4]
    size = {"figsize": (2.9 * len(names), 5.4), "layout": "constrained", "squeeze": False, "sharex": "col"}
    figure, axes = pyplot.subplots(2, len(names), **size)
    for column, name in enumerate(names):
        one = figures["scenes"][name]
        for line, kind in enumerate(("flip", "error")):
            axis = axes[line][column]
            for engine, color, label in (("CYCLES", "#d9822b", "Cycles"), ("LANCER", "#1b6ca8", "Lancer")):
                rows = one["curves"][engine]
                axis.plot([r["seconds"] for r in rows], [r[kind] for r in rows], "o-", color=color, ms=3, lw=1.5, label=label)
            _style(axis)
        _draw_told(axes[1][column], one)
        axes[0][column].set_title(name, loc="left", fontsize=10)
    for axis, label in zip(axes[:, 0], ("FLIP", "relative error"), strict=True):
        axis.set_ylabel(label, fontsize=8)
        axis.legend(fontsize=8, frameon=False)
    for kind in ("svg", "png"):
        figure.savefig(
            folder / f"denoised.{kind}", dpi=110, facecolor="white", metadata={"Date": None} if kind == "svg" else None
        )
    pyplot.close(figure)


def _draw_told(axis, one):
    """Draw the told errors with their intervals, at the seconds of Lancer's pictures."""
    seconds = {row["samples"]: row["seconds"] for row in one["curves"]["LANCER"]}
    told = [(seconds[count], error, error - low, high - error) for count, error, low, high in one["told"]]
    if told:
        places, errors, below, above = zip(*told, strict=True)
        style = {"fmt": "_", "color": "#7a3b8f", "lw": 1.0, "ms": 5}
        axis.errorbar(places, errors, yerr=(below, above), label="told by Lancer", **style)


def _style(axis):
    from matplotlib import ticker

    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.xaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g} s"))
    axis.yaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{100 * value:g} %"))
    axis.yaxis.set_minor_formatter(ticker.NullFormatter())
    axis.xaxis.set_minor_formatter(ticker.NullFormatter())
    axis.yaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.grid(which="major", lw=0.4, color="#dddddd")
    axis.tick_params(labelsize=7)
