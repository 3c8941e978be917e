"""`make accuracy`: is the error that renders tell true? build/accuracy/index.html.

Twenty scenes, many seeds, references that converged: what lies inside its bar, what the interval holds, which targets are met,
and whether anything is biased. What a scene has been measured at is kept, so a run that was broken off goes on where it ended.
Beside it, for the record, the same for the noise threshold of Cycles.
"""

import argparse
import dataclasses
import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "blender_tests")]

from bench import accuracy_goals, accuracy_page, accuracy_runs, accuracy_scenes, jobs  # noqa: E402
from bench.longer import Line, kept  # noqa: E402

OUTPUT = ROOT / "build" / "accuracy"
# Of those that exist for Blender too, each with another kind of noise; smaller, since most runs go up to 4096 samples.
CYCLES_SCENES = ("balls", "room", "glass_metal", "lights200", "models")
CYCLES_SIZE = {"width": 48, "height": 32}
CYCLES_LIMIT = 3600.0


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="three scenes, six seeds, one target: a minute or two")
    parser.add_argument("--only", default="", help="comma-separated patterns of scene names, as 'glass*'")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--no-cycles", action="store_true", help="leave Cycles out")
    return parser.parse_args()


def summary(result):
    parts = []
    for count, run in result["even"].items():
        inside = accuracy_goals.shares([run])
        share = f"{100 * sum(inside) / len(inside):.1f} %" if inside else "no noise"
        held = 100 * sum(run["holds"]) / len(run["holds"])
        parts.append(f"{count}: inside {share}, interval {held:.0f} %")
    parts += [f"{run['target']:g}: met {100 * run['met']:.0f} % by {run['samples']:.0f}" for run in result["targets"]]
    return "; ".join(parts)


def main():
    arguments, line = read_arguments(), Line()
    plan = accuracy_runs.QUICK if arguments.quick else accuracy_runs.Plan()
    plan = dataclasses.replace(plan, threads=arguments.threads)
    folder = OUTPUT / ("quick" if arguments.quick else "full")
    library = jobs.digest_of_file(ROOT / "addon" / "lib" / "liblancer.so")
    scenes = accuracy_scenes.chosen(arguments.only, arguments.quick)
    figures = {"machine": jobs.machine(), "commit": jobs.commit(), "library": library, "quick": arguments.quick}
    figures |= {"plan": dataclasses.asdict(plan), "scenes": {}, "cycles": {}}
    for number, scene in enumerate(scenes):
        place = f"{number + 1}/{len(scenes)}"
        measured = accuracy_runs.Measured(scene, plan, OUTPUT, lambda text, at=place: line.show(f"{at} {text}"))
        key = [library, *map(str, dataclasses.astuple(dataclasses.replace(plan, threads=0))), measured.samples]
        result = kept(folder / f"{scene.name}.json", key, measured.measure)
        figures["scenes"][scene.name] = result
        line.end(f"{place} {scene.name}: {summary(result)}")
        write(figures)
    if not arguments.no_cycles:
        measure_cycles(figures, scenes, arguments, folder, line)
    for goal in write(figures):
        state = "reached" if goal["reached"] else "missed"
        print(f"{goal['what']:<46} {goal['goal']:<36} {goal['measured']:<88} {state}")
    print((OUTPUT / "index.html").relative_to(ROOT))


def measure_cycles(figures, scenes, arguments, folder, line):
    names = [scene.name for scene in scenes if scene.name in CYCLES_SCENES]
    for name in names[:1] if arguments.quick else names:
        line.show(f"Cycles: {name}")
        settings = {"name": name, "threads": arguments.threads, "folder": str(OUTPUT / "references")}
        settings |= CYCLES_SIZE
        settings |= {"seeds": 3, "thresholds": [0.05], "reference": 512} if arguments.quick else {}
        command = [sys.executable, str(Path(__file__).with_name("accuracy_cycles.py")), "measure", json.dumps(settings)]
        try:
            result = kept(folder / f"{name}-cycles.json", settings, lambda c=command: jobs.run(c, limit=CYCLES_LIMIT))
        except jobs.Failed as reason:
            result = {"failed": str(reason)}
        figures["cycles"][name] = result
        line.end(f"Cycles: {name}: {result.get('failed', 'measured')}")
        write(figures)


def write(figures):
    figures["goals"] = [verdict.as_dict() for verdict in accuracy_goals.judge(figures["scenes"])]
    OUTPUT.mkdir(parents=True, exist_ok=True)
    (OUTPUT / "accuracy.json").write_text(json.dumps(figures, indent=1) + "\n")
    accuracy_page.write(figures, OUTPUT)
    return figures["goals"]


if __name__ == "__main__":
    main()
