"""`make features`: what each feature costs where it is used, and where it is only compiled in: build/features/index.html.

Both scenes of a comparison take turns in one process, on one thread, in runs of a twentieth of a second of the processor's
time; each round makes both anew, so that no chance of memory stays with one of them. Figures are medians over the rounds, with
the 95 % interval of the median.
"""

import argparse
import json
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "blender_tests")]

import tiny_scenes as tiny  # noqa: E402

from addon.bindings.enums import Integrator  # noqa: E402
from addon.bindings.session import Session  # noqa: E402
from addon.measure.costs import median_with_uncertainty  # noqa: E402
from bench import feature_cases, features_page, jobs  # noqa: E402

OUTPUT = ROOT / "build" / "features"
# At most so much where a feature is only compiled in.
GOAL = 0.02
_RUN_SECONDS = 0.05
_LEAST_ROUNDS = 8


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="fewer rounds: wide intervals, a few minutes")
    parser.add_argument("--only", default="", help="comma-separated parts of features' names")
    return parser.parse_args()


def seconds_of(snapshot, samples):
    """Of the processor, for a render from its first sample on; and the kernel that ran."""
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


def compare(base, other, wanted, limit):
    """Time of other over that of base for the same samples; rounds until the interval is wanted, or for limit seconds."""
    samples = samples_for(base)
    start, ratios = time.monotonic(), []
    while True:
        # With, without, without, with: what drifts evenly falls on both.
        a, kernel_base = seconds_of(base, samples)
        b, kernel = seconds_of(other, samples)
        b += seconds_of(other, samples)[0]
        a += seconds_of(base, samples)[0]
        ratios.append(b / a)
        ratio, uncertainty = median_with_uncertainty(ratios)
        enough = uncertainty < wanted * max(1.0, ratio) or time.monotonic() - start > limit
        if len(ratios) >= _LEAST_ROUNDS and enough:
            break
    figures = {"cost": ratio - 1.0, "uncertainty": uncertainty, "rounds": len(ratios)}
    return {**figures, "kernel": kernel, "kernel_without": kernel_base}


def measure(case, integrator, quick):
    base = tiny.with_settings(feature_cases.minimal(), integrator=integrator)
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
    arguments, started = read_arguments(), time.monotonic()
    patterns = [pattern for pattern in arguments.only.split(",") if pattern]
    cases = [c for c in feature_cases.CASES if not patterns or any(pattern in c.name for pattern in patterns)]
    figures = {"machine": jobs.machine(), "commit": jobs.commit(), "goal": GOAL, "quick": arguments.quick, "cases": {}}
    OUTPUT.mkdir(parents=True, exist_ok=True)
    for integrator in (Integrator.PATH, Integrator.CLASSIC):
        for case in cases:
            found = measure(case, integrator, arguments.quick)
            figures["cases"].setdefault(case.name, {})[integrator.name] = found
            told = ", ".join(f"{kind} {features_page.percent(value)}" for kind, value in found.items())
            print(f"{time.monotonic() - started:7.1f}  {integrator.name:<8} {case.name:<40} {told}", flush=True)
            # A run takes long: what there is so far can be looked at.
            (OUTPUT / "features.json").write_text(json.dumps(figures, indent=1) + "\n")
            (OUTPUT / "index.html").write_text(features_page.page(figures), encoding="utf-8")
    print((OUTPUT / "index.html").relative_to(ROOT))


if __name__ == "__main__":
    main()
