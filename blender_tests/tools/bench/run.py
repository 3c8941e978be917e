"""`make bench`: speed and error of every renderer on this machine, side by side in one run: build/bench/index.html.

Every measurement runs in its own process, and the competitors take turns, so that a slow minute of the machine affects all.
Figures are medians over the rounds.
"""

from pathlib import Path

from tools.harness import verdicts
from tools.harness.places import ROOT, digest_of_library, header
from tools.harness.terminal import Progress, make_parser
from tools.harness.workers import Failed

from . import bakes, chart, classic, contest, extras, goals, jobs, many_machines, page, plan, rays, window

# Seconds that a short run waits for another renderer.
_QUICK_LIMIT = 45.0


def read_arguments():
    patterns = "comma-separated patterns of scene names, as 'balls*'; nothing else runs"
    quick = "small pictures, few samples: some minutes"
    parser = make_parser(__doc__, quick=quick, only=patterns, threads=2, readme=True)
    parser.add_argument("--rounds", type=int, default=3, help="of what is measured beside the scenes")
    parser.add_argument("--before", type=Path, help="the built tree of another revision: it alone is compared with")
    return parser.parse_args()


def find_renderers(say):
    """Return ({key: version} of the renderers that run, {key: reason} of the others)."""
    own = jobs.in_blender("versions")
    versions = {"lancer": f"{own['lancer']} ({digest_of_library()[:8]})", "cycles": own["blender"]}
    missing = {}
    for renderer in plan.RENDERERS:
        if renderer.module:
            try:
                versions[renderer.key] = jobs.with_peer("version", renderer.module, option=renderer.option)["version"]
            except Failed as reason:
                missing[renderer.key] = str(reason)
                say(f"{renderer.title} is missing: {reason}")
    return versions, missing


def attempt(figures, key, say, measure, *arguments, **settings):
    """Set figures[key] to measure(...), or to the reason why it could not be measured."""
    try:
        figures[key] = measure(*arguments, **settings)
    except Failed as reason:
        figures[key] = {"missing": str(reason)}
        say(f"{key}: not measured: {reason}")
    else:
        say(f"{key}: measured")


def measure_rest(figures, arguments, say):
    rounds, threads = (1 if arguments.quick else arguments.rounds), arguments.threads
    figures["first_look"] = {}
    heavy = () if arguments.quick else ("terrain", "crowd")
    for name in ("balls", "million", "instances", *heavy):
        attempt(figures["first_look"], name, say, extras.first_look, rounds, name, threads=threads)
    attempt(figures, "frames", say, extras.frames, rounds, threads)
    attempt(figures, "first_shown", say, extras.first_shown, rounds, threads)
    attempt(figures, "million", say, extras.prepare, rounds, "million", threads)
    attempt(figures, "instances", say, extras.prepare, rounds, "instances", threads)
    attempt(figures, "threads_scaling", say, extras.threads_scaling, rounds, arguments.quick)
    attempt(figures, "many_machines", say, many_machines.measure, rounds, arguments.quick)
    for name in ("balls", "million"):
        path = str(jobs.OUTPUT / "scenes" / f"{name}-rays.npz")
        size = {"width": 640, "height": 480, "samples": 1}
        attempt(figures, f"{name}_snapshot", say, jobs.in_blender, "snapshot", path=path, name=name, threads=threads, **size)
    count, leaks = (200_000, 1_000_000) if arguments.quick else (1_000_000, 100_000_000)
    balls, million = (jobs.OUTPUT / "scenes" / f"{name}-rays.npz" for name in ("balls", "million"))
    attempt(figures, "rays", say, rays.measure, balls, count, rounds, threads, leaks)
    attempt(figures, "build", say, rays.build_times, million, rounds, threads)
    attempt(figures, "limits", say, rays.limits, threads)
    if "lancer" in figures["rays"] and "clock" in figures["limits"]:
        figures["roofline"] = rays.roofline(figures["limits"], figures["rays"], threads)
    attempt(figures, "window", say, window.gaps, rounds, 5.0 if arguments.quick else 20.0, threads)
    attempt(figures, "view", say, window.view, rounds, threads)
    attempt(figures, "edits", say, window.edits, rounds, threads)
    attempt(figures, "shared", say, window.shared, threads)
    attempt(figures, "bakes", say, bakes.measure, rounds, threads, arguments.quick, say)
    attempt(figures, "classic", say, classic.measure, rounds, threads, arguments.quick)
    if not arguments.quick:
        attempt(figures, "accelerators", say, extras.accelerators, rounds, threads)


def main():
    arguments, say = read_arguments(), Progress()
    for name in ("scenes", "pictures"):
        (jobs.OUTPUT / name).mkdir(parents=True, exist_ok=True)
    versions, missing = find_renderers(say)
    figures = {**header(arguments.quick), "threads": arguments.threads}
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
    figures["goals"] = [verdict.as_dict() for verdict in goals.judge(figures)]
    names = chart.write(figures, jobs.OUTPUT) if figures["scenes"] else []
    page.write(figures, jobs.OUTPUT, names)
    if figures["scenes"]:
        verdicts.tell(figures["goals"])
    if arguments.readme:
        page.update_tables(figures)
    print((jobs.OUTPUT / "index.html").relative_to(ROOT))


if __name__ == "__main__":
    main()
