"""Bare rays: Embree's and ours on the same triangles and rays, and the time that each takes to build."""

import json
import sys
from pathlib import Path

from . import estimates, jobs

_SOURCES = jobs.HERE / "rays"
_PASSES = 3
_KINDS = ("primary", "diffuse", "shadow")


def find_embree():
    found = sorted(Path(sys.prefix).glob("lib/python*/site-packages/embreex.libs/libembree4*"))
    if not found:
        raise jobs.Failed("the Python package embreex, which brings Embree, is not installed")
    return str(found[0])


def build_drivers():
    """(our driver, Embree's), compiled with the system's compiler."""
    ours = jobs.ROOT / "build" / "core"
    jobs.build("cmake", "-S", "core", "-B", ours, "-G", "Ninja", "-DLANCER_BENCH=ON")
    jobs.build("cmake", "--build", ours, "--target", "lancer_rays")
    theirs = jobs.OUTPUT / "embree_rays"
    jobs.build("c++", "-O3", "-std=c++20", "-pthread", _SOURCES / "embree.cpp", "-o", theirs, "-ldl")
    return ours / "lancer_rays", theirs


def write_work(name, snapshot, count, seed=1):
    path = jobs.OUTPUT / "scenes" / f"{name}.rays"
    arguments = {"snapshot": str(snapshot), "path": str(path), "count": count, "seed": seed}
    told = jobs.run([sys.executable, str(jobs.HERE / "ray_sets.py"), "write", json.dumps(arguments)])
    return path, told


def measure(snapshot, count, rounds, threads, leak_rays):
    """Rates of every kind and mode, by turns; Embree's part says why where it is missing."""
    work, told = write_work("rays", snapshot, count)
    ours, theirs = build_drivers()
    result = {"triangles": told["triangles"], "rays": told["rays"]}
    mine, embree = [], []
    library = None
    try:
        library = find_embree()
    except jobs.Failed as reason:
        result["embree"] = {"missing": str(reason)}
    for _ in range(rounds):
        mine.append(jobs.run([str(ours), str(work), str(threads), str(_PASSES)]))
        if library:
            embree.append(jobs.run([str(theirs), library, str(work), str(threads), str(_PASSES)]))
    result["lancer"] = {kind: estimates.middle(answer[kind]["rate"] for answer in mine) for kind in _KINDS}
    result["lancer"]["instruction_set"] = mine[0]["instruction_set"]
    # What a ray asks of the tree, where the driver counts it.
    counted = {kind: {name: mine[0][kind][name] for name in ("nodes", "leaves")} for kind in _KINDS if "nodes" in mine[0][kind]}
    result["counts"] = counted
    result["hits"] = {kind: mine[0][kind]["hits"] for kind in _KINDS}
    if embree:
        result["embree"] = {quality: _embree(embree, quality) for quality in ("fast", "robust")}
        result["embree"]["version"] = embree[0]["version"]
        result["agreement"] = {kind: _agreement(mine[0], embree[0], kind, told) for kind in _KINDS}
    # On one thread too, once: what several threads share shows in the difference.
    result["one_thread"] = {"lancer": jobs.run([str(ours), str(work), "1", str(_PASSES)])}
    if library:
        result["one_thread"]["embree"] = jobs.run([str(theirs), library, str(work), "1", str(_PASSES)])
    result.update(_leaks(ours, threads, leak_rays))
    return result


def _embree(answers, quality):
    modes = [mode for mode in answers[0][quality]["primary"] if mode != "hits"]
    return {
        kind: {mode: estimates.middle(answer[quality][kind][mode] for answer in answers) for mode in modes} for kind in _KINDS
    }


def _agreement(ours, theirs, kind, told):
    """Share of the rays about which the two differ at least: both are asked whether there is a hit."""
    return abs(ours[kind]["hits"] - theirs["robust"][kind]["hits"]) / told["rays"][kind]


def _leaks(driver, threads, count):
    """Rays from within a closed, bumpy ball at its vertices and edges."""
    import numpy as np
    from trimesh import creation

    ball = creation.icosphere(subdivisions=5)
    bumps = 1.0 + 0.05 * np.sin(9.0 * ball.vertices).sum(axis=1, keepdims=True)
    path = jobs.OUTPUT / "scenes" / "closed.rays"
    with open(path, "wb") as file:
        file.write(np.array([len(ball.vertices), len(ball.faces), 0], np.uint32).tobytes())
        file.write((ball.vertices * bumps).astype(np.float32).tobytes())
        file.write(ball.faces.astype(np.uint32).tobytes())
    answer = jobs.run([str(driver), str(path), str(threads), "1", str(count)])
    return {"leak_rays": answer["leak_rays"], "leaks": answer["leaks"]}


def build_times(snapshot, rounds, threads):
    """Seconds that both take to build over the triangles of a snapshot, by turns."""
    work, told = write_work("build", snapshot, 0)
    ours, theirs = build_drivers()
    mine, embree = [], []
    library = find_embree()
    for _ in range(rounds):
        mine.append(jobs.run([str(ours), str(work), str(threads), "1"])["build_seconds"])
        embree.append(jobs.run([str(theirs), library, str(work), str(threads), "1"])["fast"]["build_seconds"])
    return {
        "triangles": told["triangles"],
        "lancer_seconds": estimates.middle(mine),
        "embree_seconds": estimates.middle(embree),
    }
