"""CLASSIC beside POV-Ray: 600 exact spheres, the same rays, by turns."""

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "blender_tests"), str(ROOT / "blender_tests" / "helpers")]

import numpy as np  # noqa: E402

from tools.bench import chart, compare, estimates, jobs, process  # noqa: E402

SAMPLES = 16
_BOUNCES = 10
# Highlights are another formula there, and light fades by 1 / (1 + d^2): little of the picture, by little.
_TOLERANCE = 0.02
_BRIGHTEST = 1.0


def trace(snapshot, threads, picture):
    """POV-Ray on a snapshot, in a process of its own."""
    from addon.bindings.snapshot import SceneSnapshot
    from tools.bench.peers import povray

    loaded = SceneSnapshot.load(snapshot)
    povray.check(loaded)
    renderer = povray.Renderer(loaded, threads)
    values, seconds, clock = renderer.render(SAMPLES, 0)
    np.save(picture, values)
    return {"render_seconds": seconds, "clock": clock, "rays": renderer.rays, "version": povray.version()}


def measure(rounds, threads, quick):
    """Rays/s of both, shadow tests counted, and how alike their pictures are."""
    width, height = (160, 120) if quick else (640, 480)
    common = {"name": "spheres600", "threads": threads, "width": width, "height": height, "bounces": _BOUNCES}
    snapshot = str(jobs.OUTPUT / "scenes" / "spheres600.npz")
    jobs.in_blender("snapshot", path=snapshot, **common)
    pictures = {name: str(jobs.OUTPUT / "pictures" / f"spheres600-{name}.npy") for name in ("lancer", "povray")}
    ours, theirs = [], []
    for _ in range(rounds):
        settings = {**common, "engine": "LANCER", "samples": SAMPLES, "seed": 1, "first_look": False}
        ours.append(jobs.in_blender("render", picture=pictures["lancer"], **settings))
        task = json.dumps({"snapshot": snapshot, "threads": threads, "picture": pictures["povray"]})
        theirs.append(jobs.run([sys.executable, __file__, "trace", task]))
    loaded = {name: np.load(path) for name, path in pictures.items()}
    for name, path in pictures.items():
        chart.write_picture(Path(path).with_suffix(".png"), loaded[name], _BRIGHTEST)
        Path(path).unlink()
    difference = compare.difference(loaded["lancer"], loaded["povray"])
    result = {"version": theirs[0]["version"], "samples": SAMPLES, "size": [width, height]}
    for name, answers in (("lancer", ours), ("povray", theirs)):
        rates = [sum(answer["rays"].values()) / answer["render_seconds"] for answer in answers]
        result[name] = {"rays": answers[0]["rays"], "rays_per_second": estimates.middle(rates)}
        result[name]["seconds"] = estimates.middle(answer["render_seconds"] for answer in answers)
    same = compare.is_same(difference, _TOLERANCE)
    result["difference"] = {**difference, "tolerance": _TOLERANCE, "same": same}
    if same:
        pairs = zip(ours, theirs, strict=True)
        ratios = [
            (sum(a["rays"].values()) / a["render_seconds"]) / (sum(b["rays"].values()) / b["render_seconds"]) for a, b in pairs
        ]
        result["times_faster"] = estimates.middle(ratios)
    return result


if __name__ == "__main__":
    process.answer({"trace": trace})
