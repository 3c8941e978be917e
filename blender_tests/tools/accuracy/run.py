"""`make accuracy`: is the error that renders report true? build/accuracy/index.html.

Scenes of all kinds, many seeds and converged references: the share of pixels inside their error bars, of errors inside the
interval, of targets that are met, and biases. The figures of each scene are kept, so that an interrupted run continues where
it ended. For comparison the page has the same figures for the noise threshold of Cycles.
"""

import dataclasses

from tools.harness import verdicts, workers
from tools.harness.kept import kept
from tools.harness.places import BUILD, ROOT, digest_of_library, header
from tools.harness.terminal import Progress, make_parser

from . import goals, page, runs, scenes

OUTPUT = BUILD / "accuracy"
# Scenes that also exist for Blender, each with another kind of noise; smaller, since most runs take up to 4096 samples.
CYCLES_SCENES = ("balls", "room", "glass_metal", "lights200", "models")
CYCLES_SIZE = {"width": 48, "height": 32}
CYCLES_LIMIT = 3600.0
# Version of the kept figures of a scene; it is raised when their fields change.
_RECORD = 3


def read_arguments():
    quick = "three scenes, six seeds, one target: a minute or two"
    patterns = "comma-separated patterns of scene names, as 'glass*'"
    parser = make_parser(__doc__, quick=quick, only=patterns, threads=2)
    parser.add_argument("--no-cycles", action="store_true", help="leave Cycles out")
    return parser.parse_args()


def summary(result):
    parts = []
    for count, run in result["even"].items():
        inside = goals.shares([run])
        share = f"{100 * sum(inside) / len(inside):.1f} %" if inside else "no noise"
        held = 100 * sum(run["holds"]) / len(run["holds"])
        parts.append(f"{count}: inside {share}, interval {held:.0f} %")
    parts += [f"{run['target']:g}: met {100 * run['met']:.0f} % by {run['samples']:.0f}" for run in result["targets"]]
    return "; ".join(parts)


def main():
    arguments, say = read_arguments(), Progress()
    plan = runs.QUICK if arguments.quick else runs.Plan()
    plan = dataclasses.replace(plan, threads=arguments.threads)
    folder = OUTPUT / ("quick" if arguments.quick else "full")
    library = digest_of_library()
    chosen = scenes.chosen(arguments.only, arguments.quick)
    figures = {**header(arguments.quick), "library": library}
    figures |= {"plan": dataclasses.asdict(plan), "scenes": {}, "cycles": {}}
    for number, scene in enumerate(chosen, 1):
        place = f"{number}/{len(chosen)}"
        measured = runs.Measured(scene, plan, OUTPUT, lambda text, at=place: say.show(f"{at} {text}"))
        key = [library, _RECORD, *map(str, dataclasses.astuple(dataclasses.replace(plan, threads=0))), measured.samples]
        result = kept(folder / f"{scene.name}.json", key, measured.measure)
        figures["scenes"][scene.name] = result
        say(f"{place} {scene.name}: {summary(result)}")
        write(figures)
    if not arguments.no_cycles:
        measure_cycles(figures, chosen, arguments, folder, say)
    verdicts.tell(write(figures))
    print((OUTPUT / "index.html").relative_to(ROOT))


def measure_cycles(figures, chosen, arguments, folder, say):
    names = [scene.name for scene in chosen if scene.name in CYCLES_SCENES]
    for name in names[:1] if arguments.quick else names:
        say.show(f"Cycles: {name}")
        settings = {"name": name, "threads": arguments.threads, "folder": str(OUTPUT / "references")}
        settings |= CYCLES_SIZE
        settings |= {"seeds": 3, "thresholds": [0.05], "reference": 512} if arguments.quick else {}

        def measure(settings=settings):
            return workers.ask("accuracy.cycles", "measure", limit=CYCLES_LIMIT, **settings)

        try:
            result = kept(folder / f"{name}-cycles.json", settings, measure)
        except workers.Failed as reason:
            result = {"failed": str(reason)}
        figures["cycles"][name] = result
        say(f"Cycles: {name}: {result.get('failed', 'measured')}")
        write(figures)


def write(figures):
    figures["goals"] = [verdict.as_dict() for verdict in goals.judge(figures["scenes"])]
    page.write(figures, OUTPUT)
    return figures["goals"]


if __name__ == "__main__":
    main()
