"""`make bench`: speed and error of every renderer on this machine, side by side in one run: build/bench/index.html.

Every measurement runs in a process of its own, and competitors take turns, so that a slow minute of the machine falls on all.
Figures are medians over the rounds.
"""

import argparse
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "blender_tests"), str(ROOT / "blender_tests" / "helpers")]

from tools.bench import chart, classic, contest, extras, goals, jobs, page, plan, rays, roofline, window  # noqa: E402

# Seconds that a short run waits for another renderer.
_QUICK_LIMIT = 45.0


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small pictures, few samples: some minutes")
    parser.add_argument("--only", default="", help="comma-separated patterns of scene names, as 'balls*'; nothing else runs")
    parser.add_argument("--rounds", type=int, default=3, help="of what is measured beside the scenes")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--before", type=Path, help="the built tree of another revision: it alone is compared with")
    parser.add_argument("--readme", action="store_true", help="put the figures into README.md")
    return parser.parse_args()


class Log:
    """Tells what was measured, with the seconds since the start."""

    def __init__(self):
        self.started = time.monotonic()

    def __call__(self, text):
        print(f"{time.monotonic() - self.started:7.1f}  {text}", flush=True)


def find_renderers(say):
    """(versions, missing): by key, the version of those that run, and why others do not."""
    own = jobs.in_blender("versions")
    library = jobs.digest_of_file(ROOT / "addon" / "lib" / "liblancer.so")
    versions = {"lancer": f"{own['lancer']} ({library[:8]})", "cycles": own["blender"]}
    missing = {}
    for renderer in plan.RENDERERS:
        if renderer.module:
            try:
                versions[renderer.key] = jobs.with_peer("version", renderer.module, option=renderer.option)["version"]
            except jobs.Failed as reason:
                missing[renderer.key] = str(reason)
                say(f"{renderer.title} is missing: {reason}")
    return versions, missing


def attempt(figures, key, say, measure, *arguments, **settings):
    """figures[key] = measure(...), or why it could not be measured."""
    try:
        figures[key] = measure(*arguments, **settings)
    except jobs.Failed as reason:
        figures[key] = {"missing": str(reason)}
        say(f"{key}: not measured: {reason}")
    else:
        say(f"{key}: measured")


def measure_rest(figures, arguments, say):
    rounds, threads = (1 if arguments.quick else arguments.rounds), arguments.threads
    figures["first_look"] = {}
    for name in ("balls", "million"):
        attempt(figures["first_look"], name, say, extras.first_look, rounds, name, threads=threads)
    attempt(figures, "first_shown", say, extras.first_shown, rounds, threads)
    attempt(figures, "million", say, extras.prepare, rounds, "million", threads)
    attempt(figures, "instances", say, extras.prepare, rounds, "instances", threads)
    attempt(figures, "threads_scaling", say, extras.threads_scaling, rounds, arguments.quick)
    for name in ("balls", "million"):
        path = str(jobs.OUTPUT / "scenes" / f"{name}-rays.npz")
        size = {"width": 640, "height": 480, "samples": 1}
        attempt(figures, f"{name}_snapshot", say, jobs.in_blender, "snapshot", path=path, name=name, threads=threads, **size)
    count, leaks = (200_000, 1_000_000) if arguments.quick else (1_000_000, 100_000_000)
    balls, million = (jobs.OUTPUT / "scenes" / f"{name}-rays.npz" for name in ("balls", "million"))
    attempt(figures, "rays", say, rays.measure, balls, count, rounds, threads, leaks)
    attempt(figures, "build", say, rays.build_times, million, rounds, threads)
    attempt(figures, "limits", say, roofline.measure, threads)
    if "lancer" in figures["rays"] and "clock" in figures["limits"]:
        figures["roofline"] = roofline.rows(figures["limits"], figures["rays"], threads)
    attempt(figures, "window", say, window.gaps, rounds, 5.0 if arguments.quick else 20.0, threads)
    attempt(figures, "view", say, window.view, rounds, threads)
    attempt(figures, "classic", say, classic.measure, rounds, threads, arguments.quick)
    if not arguments.quick:
        attempt(figures, "accelerators", say, extras.accelerators, rounds, threads)


def main():
    arguments, say = read_arguments(), Log()
    for name in ("scenes", "pictures"):
        (jobs.OUTPUT / name).mkdir(parents=True, exist_ok=True)
    versions, missing = find_renderers(say)
    figures = {"machine": jobs.machine(), "threads": arguments.threads, "commit": jobs.commit(), "quick": arguments.quick}
    figures["renderers"] = {
        r.key: {"title": r.title, "version": versions.get(r.key), "missing": missing.get(r.key)} for r in plan.RENDERERS
    }
    say(page.describe(figures))
    figures["scenes"] = {}
    if arguments.before:
        figures["before"] = extras.before(arguments.rounds, arguments.threads, arguments.before.resolve(), say)
    else:
        everyone = contest.Contest(versions, missing, arguments.threads, _QUICK_LIMIT if arguments.quick else None, say)
        for scene in plan.scenes(arguments.only, arguments.quick):
            figures["scenes"][scene.name] = everyone.measure(scene)
        if not arguments.only:
            measure_rest(figures, arguments, say)
    verdicts = goals.judge(figures)
    figures["goals"] = [verdict.as_dict() for verdict in verdicts]
    names = chart.write(figures, jobs.OUTPUT) if figures["scenes"] else []
    page.write(figures, jobs.OUTPUT, names)
    for verdict in verdicts if figures["scenes"] else ():
        state = {True: "reached", False: "missed", None: ""}[verdict.reached]
        print(f"{verdict.what:<88} {verdict.measured:<60} {state}")
    if arguments.readme:
        page.update_readme(ROOT / "README.md", figures)
    print((jobs.OUTPUT / "index.html").relative_to(ROOT))


if __name__ == "__main__":
    main()
