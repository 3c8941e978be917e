"""`make bench`: speed and memory, next to Cycles in the same run. Prints a table and writes build/bench.json.

Every measurement runs in a process of its own, and competitors take turns, so that a slow minute of the machine falls on all.
Figures are medians over the rounds; the table shows the spread. Nothing here is asserted: tests judge pictures, not clocks.
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORKER = Path(__file__).with_name("bench_worker.py")
ENGINES = ("LANCER", "CYCLES")


def measure(task, root=ROOT, **arguments):
    """root: the tree that is measured; one of another revision has its own worker."""
    command = [sys.executable, str(root / WORKER.relative_to(ROOT)), task, json.dumps(arguments)]
    result = subprocess.run(command, cwd=root, capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"{task} {arguments} failed:\n{result.stdout[-2000:]}{result.stderr[-2000:]}")
    return json.loads(result.stdout.strip().splitlines()[-1])


def middle(rounds, *keys):
    """Median, smallest and largest of one figure over the rounds."""
    values = []
    for answer in rounds:
        for key in keys:
            answer = answer[key]
        values.append(answer)
    return {"median": statistics.median(values), "min": min(values), "max": max(values)}


def machine():
    facts = {"processor": platform.machine(), "processors": os.cpu_count(), "system": platform.system()}
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            facts["processor"] = line.split(":", 1)[1].strip()
            break
    facts["memory_gib"] = round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30, 1)
    return facts


def row(name, figure, unit, goal="", scale=1.0):
    spread = f"{figure['min'] * scale:.3g} .. {figure['max'] * scale:.3g}"
    print(f"{name:<58} {figure['median'] * scale:>9.3g} {unit:<12} {spread:<18} {goal}", flush=True)


def bench_f12(rounds, title, **settings):
    """The same scene through F12 in both engines, by turns."""
    answers = {engine: [] for engine in ENGINES}
    for _ in range(rounds):
        for engine in ENGINES:
            answers[engine].append(measure("f12", engine=engine, **settings))
    result = {}
    for engine in ENGINES:
        seconds, peak = middle(answers[engine], "seconds"), middle(answers[engine], "peak_bytes")
        result[engine] = {"seconds": seconds, "peak_bytes": peak}
        row(f"{title}, {engine.title()}", seconds, "s")
        row(f"{title}, {engine.title()}, memory", peak, "MB", scale=1e-6)
    pairs = [
        {"ratio": cycles["seconds"] / lancer["seconds"]}
        for lancer, cycles in zip(answers["LANCER"], answers["CYCLES"], strict=True)
    ]
    result["times_faster"] = middle(pairs, "ratio")
    row(f"{title}, Cycles' time / Lancer's", result["times_faster"], "")
    return result


def bench_prepare(rounds, threads, name):
    answers = [measure("prepare", name=name, threads=threads) for _ in range(rounds)]
    million = name == "million"
    result = {"triangles": answers[0]["triangles"], "instances": answers[0]["instances"]}
    goals = {"export_seconds": "< 0.6", "build_seconds": "< 2", "peak_bytes_per_triangle": "< 350"} if million else {}
    units = {"export_seconds": "s", "build_seconds": "s", "peak_bytes_per_triangle": "B"}
    print(f"{name}: {result['triangles']} triangles, {result['instances']} instances")
    for key, unit in units.items():
        result[key] = middle(answers, key)
        if million or unit == "s":
            row(f"{name}, {key.replace('_', ' ')}", result[key], unit, goals.get(key, ""))
    result["peak_bytes"] = middle(answers, "peak_bytes")
    return result


def bench_accelerators(rounds, threads):
    kinds = ["KDTREE", "BRUTE_FORCE", "BVH"]
    answers = [measure("accelerators", kinds=kinds, name="spheres600", threads=threads, bounces=10) for _ in range(rounds)]
    result = {"instruction_set": answers[0]["instruction_set"]}
    for kind in kinds:
        result[kind] = {key: middle(answers, kind, key) for key in ("seconds", "rays_per_second")}
        row(f"600 spheres, {kind}", result[kind]["rays_per_second"], "M rays/s", scale=1e-6)
    ratios = [{"ratio": answer["BRUTE_FORCE"]["seconds"] / answer["KDTREE"]["seconds"]} for answer in answers]
    result["kdtree_times_faster"] = middle(ratios, "ratio")
    row("600 spheres, brute force's time / kd-tree's", result["kdtree_times_faster"], "", "> 4")
    return result


def bench_before(rounds, threads, before):
    """F12 of this tree and of another revision's, by turns."""
    result = {}
    for name, samples in (("balls", 16), ("default_cube", 32), ("cornell", 16), ("spheres600", 16)):
        seconds = {"before": [], "now": []}
        for _ in range(rounds):
            for key, root in (("before", before), ("now", ROOT)):
                answer = measure("f12", root, engine="LANCER", name=name, threads=threads, samples=samples)
                seconds[key].append({"seconds": answer["seconds"]})
        pairs = [{"ratio": a["seconds"] / b["seconds"]} for a, b in zip(seconds["before"], seconds["now"], strict=True)]
        result[name] = {key: middle(answers, "seconds") for key, answers in seconds.items()}
        result[name]["times_faster"] = middle(pairs, "ratio")
        for key in seconds:
            row(f"{name}, {samples} samples, {key}", result[name][key], "s")
        row(f"{name}, time before / now", result[name]["times_faster"], "")
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--before", type=Path, help="the built tree of another revision, to be compared with")
    arguments = parser.parse_args()
    rounds, threads = arguments.rounds, arguments.threads
    facts = {**machine(), **measure("versions"), "threads": threads, "rounds": rounds}
    print(", ".join(f"{key} {value}" for key, value in facts.items()))
    print(f"{'what':<58} {'median':>9} {'':<12} {'spread':<18} goal")
    first_look = {"threads": threads, "width": 320, "height": 180, "samples": 1}
    figures = {
        "machine": facts,
        "balls": bench_f12(rounds, "balls 640x480, 16 samples", name="balls", threads=threads, samples=16),
        "balls_first_look": bench_f12(rounds, "balls 320x180, 1 sample", name="balls", **first_look),
        "million_first_look": bench_f12(rounds, "million 320x180, 1 sample", name="million", **first_look),
        "instances_first_look": bench_f12(rounds, "instances 320x180, 1 sample", name="instances", **first_look),
        "million": bench_prepare(rounds, threads, "million"),
        "instances": bench_prepare(rounds, threads, "instances"),
        "spheres600": bench_accelerators(rounds, threads),
    }
    if arguments.before:
        figures["before"] = bench_before(rounds, threads, arguments.before.resolve())
    path = ROOT / "build" / "bench.json"
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps(figures, indent=2) + "\n")
    print(path.relative_to(ROOT))


if __name__ == "__main__":
    main()
