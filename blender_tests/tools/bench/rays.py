"""Rays alone: Embree's and our rates on the same triangles and rays, build times, and the machine's bound."""

import sys
from pathlib import Path

from tools.harness import workers
from tools.harness.places import BUILD, TOOLS
from tools.harness.turns import by_turns, middle

from . import jobs

_SOURCES = TOOLS / "bench" / "rays"
_PASSES = 3
_KINDS = ("primary", "diffuse", "shadow")
# A step through a node of eight boxes keeps the two floating-point ports busy for some 11 cycles, a block of four triangles for
# 22. The clock and the nodes and blocks per ray thus bound the rays per second of a core; cache misses lower them further.
NODE_CYCLES, LEAF_CYCLES = 11.0, 22.0


def find_embree():
    found = sorted(Path(sys.prefix).glob("lib/python*/site-packages/embreex.libs/libembree4*"))
    if not found:
        raise workers.Failed("the Python package embreex, which brings Embree, is not installed")
    return str(found[0])


def build_drivers():
    """Return (our driver, Embree's), compiled with the system's compiler."""
    ours = BUILD / "core"
    workers.build("cmake", "-S", "core", "-B", ours, "-G", "Ninja", "-DLANCER_BENCH=ON")
    workers.build("cmake", "--build", ours, "--target", "lancer_rays")
    theirs = jobs.OUTPUT / "embree_rays"
    workers.build("c++", "-O3", "-std=c++20", "-pthread", _SOURCES / "embree.cpp", "-o", theirs, "-ldl")
    return ours / "lancer_rays", theirs


def write_work(name, snapshot, count, seed=1):
    path = jobs.OUTPUT / "scenes" / f"{name}.rays"
    return path, workers.ask("bench.ray_sets", "write", snapshot=str(snapshot), path=str(path), count=count, seed=seed)


def measure(snapshot, count, rounds, threads, leak_rays):
    """Return the rates of every kind of rays and mode, measured by turns. If Embree is missing, its part has the reason."""
    work, told = write_work("rays", snapshot, count)
    ours, theirs = build_drivers()
    result = {"triangles": told["triangles"], "rays": told["rays"]}
    drivers = {"lancer": [ours]}
    try:
        drivers["embree"] = [theirs, find_embree()]
    except workers.Failed as reason:
        result["embree"] = {"missing": str(reason)}

    def trace(name, _, threads=threads):
        return workers.run([*drivers[name], work, threads, _PASSES])

    answers = by_turns(rounds, drivers, trace)
    mine, embree = answers["lancer"], answers.get("embree")
    result["lancer"] = {kind: middle(answer[kind]["rate"] for answer in mine) for kind in _KINDS}
    result["lancer"]["instruction_set"] = mine[0]["instruction_set"]
    # Nodes and leaves per ray, if the driver counts them.
    counted = {kind: {name: mine[0][kind][name] for name in ("nodes", "leaves")} for kind in _KINDS if "nodes" in mine[0][kind]}
    result["counts"] = counted
    result["hits"] = {kind: mine[0][kind]["hits"] for kind in _KINDS}
    if embree:
        result["embree"] = {quality: _embree(embree, quality) for quality in ("fast", "robust")}
        result["embree"]["version"] = embree[0]["version"]
        result["agreement"] = {kind: _agreement(mine[0], embree[0], kind, told) for kind in _KINDS}
    # Once on one thread, too: the difference shows the cost of shared caches and memory.
    result["one_thread"] = {name: trace(name, 0, threads=1) for name in drivers}
    result.update(_leaks(ours, threads, leak_rays))
    return result


def _embree(answers, quality):
    modes = [mode for mode in answers[0][quality]["primary"] if mode != "hits"]
    return {kind: {mode: middle(answer[quality][kind][mode] for answer in answers) for mode in modes} for kind in _KINDS}


def _agreement(ours, theirs, kind, told):
    """Return the difference of the two numbers of hits as a share of the rays."""
    return abs(ours[kind]["hits"] - theirs["robust"][kind]["hits"]) / told["rays"][kind]


def _leaks(driver, threads, count):
    """Trace rays from inside a closed, bumpy ball to its vertices and edges."""
    import numpy as np
    from trimesh import creation

    ball = creation.icosphere(subdivisions=5)
    bumps = 1.0 + 0.05 * np.sin(9.0 * ball.vertices).sum(axis=1, keepdims=True)
    path = jobs.OUTPUT / "scenes" / "closed.rays"
    with open(path, "wb") as file:
        file.write(np.array([len(ball.vertices), len(ball.faces), 0], np.uint32).tobytes())
        file.write((ball.vertices * bumps).astype(np.float32).tobytes())
        file.write(ball.faces.astype(np.uint32).tobytes())
    answer = workers.run([driver, path, threads, 1, count])
    return {"leak_rays": answer["leak_rays"], "leaks": answer["leaks"]}


def build_times(snapshot, rounds, threads):
    """Return the build times in seconds of both over the triangles of a snapshot, measured by turns."""
    work, told = write_work("build", snapshot, 0)
    ours, theirs = build_drivers()
    drivers = {"lancer": [ours], "embree": [theirs, find_embree()]}
    answers = by_turns(rounds, drivers, lambda name, _: workers.run([*drivers[name], work, threads, 1]))
    return {
        "triangles": told["triangles"],
        "lancer_seconds": middle(answer["build_seconds"] for answer in answers["lancer"]),
        "embree_seconds": middle(answer["fast"]["build_seconds"] for answer in answers["embree"]),
    }


def limits(threads):
    """Return the clock, latencies and bandwidths of this machine."""
    program = jobs.OUTPUT / "machine_limits"
    source = TOOLS / "bench" / "rays" / "machine.cpp"
    # The program is compiled for this very processor.
    workers.build("c++", "-O3", "-std=c++20", "-march=native", "-pthread", source, "-o", program)
    return workers.run([program, threads])


def bound(nodes, leaves, clock, threads):
    """Return the rays per second that these nodes and leaves per ray allow."""
    return threads * clock / (nodes * NODE_CYCLES + leaves * LEAF_CYCLES)


def roofline(machine, rays, threads):
    """Return a row for each kind of ray whose nodes and leaves the library has counted; [] if it counts none."""
    result = []
    for kind, counts in rays.get("counts", {}).items():
        roof = bound(counts["nodes"], counts["leaves"], machine["clock"], threads)
        rate = rays["lancer"][kind]["median"]
        result.append({"what": kind, **counts, "bound": roof, "measured": rate, "fraction": rate / roof})
    return result
