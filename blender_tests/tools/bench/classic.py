"""Compare CLASSIC with POV-Ray: 600 exact spheres, the same rays, by turns."""

from pathlib import Path

import numpy as np

from tools.harness import pictures, workers
from tools.harness.turns import by_turns, middle, ratio

from . import jobs

SAMPLES = 16
_BOUNCES = 10
# POV-Ray has another formula for highlights, and light fades by 1 / (1 + d^2): small differences in a small part.
_TOLERANCE = 0.02
_BRIGHTEST = 1.0


def trace(snapshot, threads, picture):
    """Render a snapshot with POV-Ray, in its own process."""
    from addon.bindings.snapshot import SceneSnapshot

    from .peers import povray

    loaded = SceneSnapshot.load(snapshot)
    povray.check(loaded)
    renderer = povray.Renderer(loaded, threads)
    values, seconds, clock = renderer.render(SAMPLES, 0)
    np.save(picture, values)
    return {"render_seconds": seconds, "clock": clock, "rays": renderer.rays, "version": povray.version()}


def measure(rounds, threads, quick):
    """Return the rays/s of both, shadow rays included, and the difference of their pictures."""
    width, height = (160, 120) if quick else (640, 480)
    common = {"name": "spheres600", "threads": threads, "width": width, "height": height, "bounces": _BOUNCES}
    snapshot = str(jobs.OUTPUT / "scenes" / "spheres600.npz")
    jobs.in_blender("snapshot", path=snapshot, **common)
    paths = {name: jobs.OUTPUT / "pictures" / f"spheres600-{name}.npy" for name in ("lancer", "povray")}

    def render(name, _):
        picture = str(paths[name])
        if name == "lancer":
            settings = {**common, "engine": "LANCER", "samples": SAMPLES, "seed": 1, "first_look": False}
            return jobs.in_blender("render", picture=picture, **settings)
        return workers.ask("bench.classic", "trace", snapshot=snapshot, threads=threads, picture=picture)

    answers = by_turns(rounds, paths, render)
    loaded = {name: np.load(path) for name, path in paths.items()}
    for name, path in paths.items():
        pictures.write_picture(Path(path).with_suffix(".png"), loaded[name], _BRIGHTEST)
        Path(path).unlink()
    difference = pictures.difference(loaded["lancer"], loaded["povray"])
    result = {"version": answers["povray"][0]["version"], "samples": SAMPLES, "size": [width, height]}
    rates = {}
    for name, found in answers.items():
        rates[name] = [sum(answer["rays"].values()) / answer["render_seconds"] for answer in found]
        result[name] = {"rays": found[0]["rays"], "rays_per_second": middle(rates[name])}
        result[name]["seconds"] = middle(answer["render_seconds"] for answer in found)
    same = pictures.is_same(difference, _TOLERANCE)
    result["difference"] = {**difference, "tolerance": _TOLERANCE, "same": same}
    if same:
        result["times_faster"] = ratio(rates["lancer"], rates["povray"])
    return result


if __name__ == "__main__":
    workers.answer(trace)
