"""`make tradeoff`: the error of pictures against seconds, with Lancer and with Cycles: build/tradeoff/index.html.

The scene is the showcase or a file, in a small picture. Every curve is rendered with several seeds, by turns with the others,
so that a slow minute of the machine affects all.
"""

import math
import sys
from pathlib import Path

import bpy

import scenes
from addon.bindings.enums import Integrator
from addon.settings.scene_settings import QUALITIES
from scenes.render import captured_output
from tools.bench import worker
from tools.harness import pictures
from tools.harness.errors import Reference
from tools.harness.f12 import registered
from tools.harness.places import header
from tools.harness.terminal import Progress, make_parser

from . import chart, curves, denoised, page, runs

_PIXELS = 192 * 108
_REFERENCE, _QUICK_REFERENCE = 32768, 4096
# Cycles' own reference has half of the samples: a sample of Cycles takes longer.
_CYCLES_SHARE = 2
_SEEDS, _QUICK_SEEDS = 5, 3
_MOST, _QUICK_MOST = 1024, 128
_CLASSIC_MOST = 64
# Seeds of the longest curves, which take longer than all others together.
_LONG_SEEDS = 1


def read_arguments():
    quick = "few samples, and no FINAL: some minutes"
    parser = make_parser(__doc__, quick=quick, threads=2, readme=True, output="tradeoff")
    parser.add_argument("--blend", type=Path, help="a file of Blender; default: the showcase")
    parser.add_argument("--denoised", action="store_true", help="compare denoised pictures, by scene")
    parser.add_argument("--only", default="", help="names of scenes for --denoised")
    parser.add_argument("--samples", type=int, help=f"of the reference; default: {_REFERENCE}")
    arguments = parser.parse_args()
    if arguments.readme and arguments.blend:
        parser.error("--readme is for the showcase")
    return arguments


def open_scene(arguments):
    """Return the scene with settings for this run only; a file is never saved."""
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
    """The renders of a run. curves: {name: [of each seed [(samples, seconds, picture)]]}."""

    def __init__(self, scene, quick, say):
        self.scene, self.quick, self.say = scene, quick, say
        self.most = _QUICK_MOST if quick else _MOST
        self.exact = runs.Lancer(scene)
        self.meshes = None
        if self.exact.exact:
            with runs.without_exact_shapes(scene):
                self.meshes = runs.Lancer(scene)
        self.cycles = runs.Cycles(scene)
        self.curves, self.presets = {}, {}

    def references(self, samples):
        """Return the references of Lancer and of Cycles; their seeds are far from those of the curves."""
        halves = [self.exact.converged(seed, samples // 2) for seed in (1001, 1002)]
        self.say(f"reference of Lancer, {samples} samples")
        theirs = [self.cycles.render(seed, samples // (2 * _CYCLES_SHARE))[1] for seed in (1001, 1002)]
        self.say(f"reference of Cycles, {samples // _CYCLES_SHARE} samples")
        self.apart = pictures.difference(sum(halves) / 2, sum(theirs) / 2)
        return Reference.of(halves), Reference.of(theirs)

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


def measure(arguments, say):
    """Return all figures, for the file."""
    # The load is measured before anything runs, so that it is that of other processes.
    told = header(arguments.quick)
    scene = open_scene(arguments)
    study = Study(scene, arguments.quick, say)
    samples = arguments.samples or (_QUICK_REFERENCE if arguments.quick else _REFERENCE)
    ours, theirs = study.references(samples)
    # The first render fills the caches.
    study.cycles.render(1, 1)
    for number in range(_QUICK_SEEDS if arguments.quick else _SEEDS):
        study.round(number + 1, number)
    found = curves.conclude(study.curves, ours, theirs)
    return {
        "scene": arguments.blend.stem if arguments.blend else "showcase",
        **told,
        "threads": arguments.threads,
        "blender": bpy.app.version_string,
        "size": [scene.render.resolution_x, scene.render.resolution_y],
        "bounces": scene.lancer.max_bounces,
        "seeds": _QUICK_SEEDS if arguments.quick else _SEEDS,
        "reference": {"samples": samples, "error": ours.error},
        "cycles_reference": {"samples": samples // _CYCLES_SHARE, "error": theirs.error},
        "apart": study.apart,
        "preparation": study.exact.seconds,
        "left_out": study.exact.messages.lines(),
        "curves": found,
        "presets": curves.conclude_presets(study.presets, {name: target for name, (target, _) in QUALITIES.items()}, ours),
        "slopes": curves.slopes(found),
        "equal_error": curves.headlines(found),
    }


def main():
    arguments = read_arguments()
    if arguments.denoised:
        denoised.run(arguments)
        return
    # Cycles prints a line for every picture that it writes.
    with captured_output() as (terminal, _):
        figures = measure(arguments, Progress(terminal))
    page.write(figures, arguments.output)
    chart.write(figures, arguments.output)
    if arguments.readme:
        page.update_tables(figures, arguments.output)
    print(arguments.output / "index.html")


if __name__ == "__main__":
    registered(main)
