"""`make tradeoff`: how near a picture comes in how much time, with Lancer and with Cycles: build/tradeoff/index.html.

The scene is the showcase or a file, in a small picture. Every curve is rendered with several seeds, by turns with the others,
so that a slow minute of the machine falls on all.
"""

import argparse
import json
import math
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "blender_tests"), str(ROOT / "blender_tests" / "helpers")]

import bpy  # noqa: E402

import addon  # noqa: E402
import scenes  # noqa: E402
from addon.bindings.enums import Integrator  # noqa: E402
from addon.scene_settings import QUALITIES  # noqa: E402
from scenes.render import captured_output  # noqa: E402
from tools.bench import compare, jobs, worker  # noqa: E402
from tools.tradeoff import chart as tradeoff_chart  # noqa: E402
from tools.tradeoff import page as tradeoff_page  # noqa: E402
from tools.tradeoff import runs as tradeoff_runs  # noqa: E402
from tools.tradeoff.error import Reference, middle, seconds_to, slope  # noqa: E402

_PIXELS = 192 * 108
_REFERENCE, _QUICK_REFERENCE = 32768, 4096
# Cycles' own reference gets half of the samples: a sample of its takes longer.
_CYCLES_SHARE = 2
_SEEDS, _QUICK_SEEDS = 5, 3
_MOST, _QUICK_MOST = 1024, 128
_CLASSIC_MOST = 64
# Of what takes longer than all else together.
_LONG_SEEDS = 1


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--blend", type=Path, help="a file of Blender; default: the showcase")
    parser.add_argument("--samples", type=int, help=f"of the reference; default: {_REFERENCE}")
    parser.add_argument("--output", type=Path, default=ROOT / "build" / "tradeoff")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="few samples, and no FINAL: some minutes")
    parser.add_argument("--readme", action="store_true", help="put chart and table into the README")
    arguments = parser.parse_args()
    if arguments.readme and arguments.blend:
        parser.error("--readme is for the showcase")
    return arguments


def open_scene(arguments):
    """The scene with settings for this run only; a file is never saved."""
    if arguments.blend is None:
        scene = scenes.load("showcase")
    elif arguments.blend.is_file():
        bpy.ops.wm.open_mainfile(filepath=str(arguments.blend.resolve()), load_ui=False)
        scene = bpy.context.scene
    else:
        sys.exit(f"{arguments.blend}: there is no such file.")
    render, own = scene.render, scene.lancer
    factor = math.sqrt(_PIXELS / (render.resolution_x * render.resolution_y))
    if factor < 1.0:
        render.resolution_x = max(1, round(render.resolution_x * factor))
        render.resolution_y = max(1, round(render.resolution_y * factor))
    render.resolution_percentage = 100
    render.use_border = render.film_transparent = False
    for layer in scene.view_layers:
        layer.samples = 0
    worker.make_alike(scene, arguments.threads, own.max_bounces)
    own.integrator, own.clamp_indirect, own.target_error, own.time_limit = "PATH", 0.0, 0.0, 0.0
    own.use_animated_seed = own.use_denoising = False
    bpy.context.view_layer.update()
    return scene


class Study:
    """Curves: {name: [of each seed [(samples, seconds, picture)]]}."""

    def __init__(self, scene, quick, say):
        self.scene, self.quick, self.say = scene, quick, say
        self.most = _QUICK_MOST if quick else _MOST
        self.exact = tradeoff_runs.Lancer(scene)
        self.meshes = None
        if self.exact.exact:
            with tradeoff_runs.without_exact_shapes(scene):
                self.meshes = tradeoff_runs.Lancer(scene)
        self.cycles = tradeoff_runs.Cycles(scene)
        self.curves, self.presets = {}, {}

    def references(self, samples):
        """Those of Lancer and of Cycles; seeds are far from those of the curves."""
        halves = [self.exact.converged(seed, samples // 2) for seed in (1001, 1002)]
        self.say(f"reference of Lancer, {samples} samples")
        theirs = [self.cycles.render(seed, samples // (2 * _CYCLES_SHARE))[1] for seed in (1001, 1002)]
        self.say(f"reference of Cycles, {samples // _CYCLES_SHARE} samples")
        self.apart = compare.difference(sum(halves) / 2, sum(theirs) / 2)
        return Reference(*halves), Reference(*theirs)

    def round(self, seed, number):
        """Everyone once."""
        self._add("PATH", self.exact.doublings(Integrator.PATH, seed, self.most))
        self._add("Cycles", self._cycles(seed))
        if self.meshes:
            self._add("PATH, meshes", self.meshes.doublings(Integrator.PATH, seed, self.most))
        for name in ("CLASSIC", "NORMALS"):
            self._add(name, self.exact.doublings(Integrator[name], seed, _CLASSIC_MOST))
        for name, (target, most) in QUALITIES.items():
            if self.quick and name == "FINAL" or number >= _LONG_SEEDS and name == ("GOOD" if self.quick else "FINAL"):
                continue
            self.presets.setdefault(name, []).append(self.exact.preset(seed, target, most))
            self.say(f"seed {seed}: {name} in {self.presets[name][-1][1]:.2f} s")
        self.say(f"seed {seed}")

    def _cycles(self, seed):
        found, count = [], 1
        while count <= self.most:
            found.append((count, *self.cycles.render(seed, count)))
            count *= 2
        return found

    def _add(self, name, points):
        self.curves.setdefault(name, []).append(points)


def conclude(study, ours, theirs):
    """Figures of all curves, for the page and for the file."""
    result = {}
    for name, of_seeds in study.curves.items():
        reference = theirs if name == "Cycles" else ours
        points = middle([[(seconds, reference.distance(picture)) for _, seconds, picture in points] for points in of_seeds])
        samples = [count for count, *_ in of_seeds[0]]
        rows = [
            {"samples": count, "seconds": seconds, "error": error, "least": least, "greatest": greatest}
            for count, (seconds, error, least, greatest) in zip(samples, points, strict=True)
        ]
        for index, row in enumerate(rows):
            row["noise"], row["bias"] = reference.split([points[index][2] for points in of_seeds])
        # Below five hundredths of a second Cycles' clock says nothing.
        result[name] = [row for row in rows if name != "Cycles" or row["seconds"] >= 0.05]
    return result


def conclude_presets(study, ours):
    result = {}
    for name, renders in study.presets.items():
        (point,) = middle([[(seconds, ours.distance(picture))] for _, seconds, picture, *_ in renders])
        keys = ("seconds", "error", "least", "greatest")
        told = sorted(own for *_, own, _ in renders)[len(renders) // 2]
        samples = sorted(count for count, *_ in renders)[len(renders) // 2]
        target = QUALITIES[name][0]
        result[name] = {**dict(zip(keys, point, strict=True)), "told": told, "samples": samples, "target": target}
        result[name]["ended_by"] = renders[0][4]
    return result


def headlines(curves):
    """Seconds to equal error, at the errors of the presets and between, as far as both curves were measured."""
    rows = []
    for error in (0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.01):
        found = [seconds_to([(row["seconds"], row["error"]) for row in curves[name]], error) for name in ("PATH", "Cycles")]
        if None not in found:
            rows.append({"error": error, "lancer": found[0], "cycles": found[1]})
    return rows


def slopes(curves):
    """Of those that go on falling, from where samples have spread over a pixel."""
    result = {}
    for name in ("PATH", "Cycles"):
        points = [(row["seconds"], row["error"]) for row in curves[name] if row["samples"] >= 4 and row["error"] > 0.0]
        if len(points) > 1:
            result[name] = slope(points)
    return result


def measure(arguments, say):
    """All figures, as they go into the file."""
    # Before anything runs: its load is that of others.
    machine = jobs.machine()
    scene = open_scene(arguments)
    study = Study(scene, arguments.quick, say)
    samples = arguments.samples or (_QUICK_REFERENCE if arguments.quick else _REFERENCE)
    ours, theirs = study.references(samples)
    # Whoever is first brings everything into the caches.
    study.cycles.render(1, 1)
    for number in range(_QUICK_SEEDS if arguments.quick else _SEEDS):
        study.round(number + 1, number)
    curves = conclude(study, ours, theirs)
    return {
        "scene": arguments.blend.stem if arguments.blend else "showcase",
        "machine": machine,
        "threads": arguments.threads,
        "commit": jobs.commit(),
        "blender": bpy.app.version_string,
        "quick": arguments.quick,
        "size": [scene.render.resolution_x, scene.render.resolution_y],
        "bounces": scene.lancer.max_bounces,
        "seeds": _QUICK_SEEDS if arguments.quick else _SEEDS,
        "reference": {"samples": samples, "error": ours.error},
        "cycles_reference": {"samples": samples // _CYCLES_SHARE, "error": theirs.error},
        "apart": study.apart,
        "preparation": study.exact.seconds,
        "left_out": study.exact.messages.lines(),
        "curves": curves,
        "presets": conclude_presets(study, ours),
        "slopes": slopes(curves),
        "equal_error": headlines(curves),
    }


def main():
    arguments, started = read_arguments(), time.monotonic()
    # Cycles tells of every picture that it writes.
    with captured_output() as (terminal, _):

        def say(text):
            print(f"{time.monotonic() - started:7.1f}  {text}", file=terminal, flush=True)

        figures = measure(arguments, say)
    arguments.output.mkdir(parents=True, exist_ok=True)
    (arguments.output / "tradeoff.json").write_text(json.dumps(figures, indent=1) + "\n")
    tradeoff_chart.write(figures, arguments.output)
    tradeoff_page.write(figures, arguments.output)
    if arguments.readme:
        tradeoff_page.update_readme(ROOT, arguments.output, figures)
    print(arguments.output / "index.html")


if __name__ == "__main__":
    addon.register()
    try:
        main()
    finally:
        addon.unregister()
