"""`make features`: the cost of each feature where it is used, and where it is only compiled in, and of each kind of node.

It writes build/features/index.html.

Both scenes of a comparison take turns in one process, on one thread, in runs of a twentieth of a second of processor time. Each
round uploads both scenes anew, so that no layout of memory favours one of them. Figures are medians over the rounds, with the
95 % interval of the median.
"""

import time

import tiny_scenes as tiny

from addon.bindings.enums import Integrator
from addon.bindings.session import Session
from addon.measure.costs import median_with_uncertainty
from tools.harness.places import BUILD, ROOT, header
from tools.harness.terminal import Progress, make_parser, wanted

from . import cases, nodes, page

OUTPUT = BUILD / "features"
# Largest cost of a feature that is only compiled in.
GOAL = 0.02
_RUN_SECONDS = 0.05
_LEAST_ROUNDS = 8


def read_arguments():
    parts = "comma-separated parts of features' names"
    return make_parser(__doc__, quick="fewer rounds: wide intervals, a few minutes", only=parts).parse_args()


def seconds_of(snapshot, samples):
    """Return the processor's seconds of a render from its first sample on, and the kernel that ran."""
    with Session.upload(snapshot) as session:
        session.render_all(1)
        start = time.process_time()
        session.render(1, samples)
        while not session.wait(1.0).finished:
            pass
        return time.process_time() - start, session.statistics().kernel


def samples_for(snapshot):
    seconds, _ = seconds_of(snapshot, 4)
    return max(1, round(4 * _RUN_SECONDS / seconds))


def compare(base, other, interval, limit):
    """Return the time of other over that of base for the same samples. Rounds run until the interval is this small, or for
    limit seconds.
    """
    samples = samples_for(base)
    start, ratios = time.monotonic(), []
    while True:
        # In the order base, other, other, base an even drift of the machine affects both alike.
        a, kernel_base = seconds_of(base, samples)
        b, kernel = seconds_of(other, samples)
        b += seconds_of(other, samples)[0]
        a += seconds_of(base, samples)[0]
        ratios.append(b / a)
        ratio, uncertainty = median_with_uncertainty(ratios)
        enough = uncertainty < interval * max(1.0, ratio) or time.monotonic() - start > limit
        if len(ratios) >= _LEAST_ROUNDS and enough:
            break
    figures = {"cost": ratio - 1.0, "uncertainty": uncertainty, "rounds": len(ratios)}
    return {**figures, "kernel": kernel, "kernel_without": kernel_base}


def measure(case, integrator, quick):
    base = tiny.with_settings(cases.minimal(), integrator=integrator)
    result = {}
    if case.used is not None:
        result["used"] = compare(base, case.used(base), 0.02, 2.0 if quick else 6.0)
    if case.idle is not None:
        idle_base = base if case.idle_base is None else case.idle_base(base)
        result["idle"] = compare(idle_base, case.idle(base), 0.007, 4.0 if quick else 20.0)
        if integrator == Integrator.CLASSIC and case.in_classic:
            result["idle"]["note"] = case.in_classic
    return result


def main():
    arguments, say = read_arguments(), Progress()
    parts = ",".join(f"*{part}*" for part in arguments.only.split(",") if part)
    chosen = [case for case in cases.CASES if wanted(parts, case.name)]
    figures = {**header(arguments.quick), "goal": GOAL, "cases": {}, "nodes": {}}
    for integrator in (Integrator.PATH, Integrator.CLASSIC):
        for case in chosen:
            found = measure(case, integrator, arguments.quick)
            figures["cases"].setdefault(case.name, {})[integrator.name] = found
            told = ", ".join(f"{kind} {page.percent(value)}" for kind, value in found.items())
            say(f"{integrator.name:<8} {case.name:<40} {told}")
            # A run takes long: the page has the figures so far.
            page.write(figures, OUTPUT)
    for name, node in nodes.NODES.items():
        if wanted(parts, f"node: {name}"):
            figures["nodes"][name] = found = nodes.measure(node)
            say(f"node: {name:<42} {page.in_nanoseconds(found)}")
    page.write(figures, OUTPUT)
    print((OUTPUT / "index.html").relative_to(ROOT))


if __name__ == "__main__":
    main()
