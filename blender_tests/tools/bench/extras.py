"""Measurements besides the scenes: first samples, preparation, threads, accelerators, another revision."""

from tools.harness.places import ROOT
from tools.harness.turns import by_turns, middle, middles, ratio

from . import jobs


def first_look(rounds, name, **settings):
    """Render the same scene by F12 in both engines, by turns: 320 x 180, one sample."""
    size = {"width": 320, "height": 180, "samples": 1}

    def render(engine, _):
        return jobs.in_blender("f12", engine=engine, name=name, **size, **settings)

    return {engine: middles(found) for engine, found in by_turns(rounds, ("LANCER", "CYCLES"), render).items()}


def frames(rounds, threads):
    """Return {kind of animation: {engine: seconds of a frame beside its samples}}, measured by turns.

    steady: the bytes that 50 frames add to a long animation.
    """
    found = {}
    for kind in ("camera", "character", "instances"):

        def show(engine, _, kind=kind):
            return jobs.in_blender("frames", engine=engine, kind=kind, threads=threads)

        found[kind] = {engine: middles(all_) for engine, all_ in by_turns(rounds, ("LANCER", "CYCLES"), show).items()}
    found["steady"] = jobs.in_blender("steady", engine="LANCER", threads=threads)
    return found


def first_shown(rounds, threads):
    size = {"width": 640, "height": 480, "samples": 4}
    return middles([jobs.in_blender("first_shown", name="balls", threads=threads, **size) for _ in range(rounds)])


def prepare(rounds, name, threads):
    return middles([jobs.in_blender("prepare", name=name, threads=threads) for _ in range(rounds)])


def threads_scaling(rounds, quick):
    """Return the rate on two threads over that on one, measured by turns."""
    size = {"width": 128, "height": 96, "samples": 32} if quick else {"width": 256, "height": 192, "samples": 64}
    settings = {"engine": "LANCER", "name": "balls", **size, "first_look": False}

    def rate(threads, number):
        answer = jobs.in_blender("render", threads=threads, seed=number, **settings)
        return answer["samples"] / answer["render_seconds"]

    rates = by_turns(rounds, (1, 2), rate)
    return {"times_faster": ratio(rates[2], rates[1])}


def accelerators(rounds, threads):
    kinds = ["KDTREE", "BRUTE_FORCE", "BVH"]
    settings = {"name": "spheres600", "threads": threads, "bounces": 10, "width": 320, "height": 240}
    answers = [jobs.in_blender("accelerators", kinds=kinds, **settings) for _ in range(rounds)]
    result = {"instruction_set": answers[0]["instruction_set"]}
    for kind in kinds:
        result[kind] = middles([answer[kind] for answer in answers])
    slow, fast = ([answer[kind]["seconds"] for answer in answers] for kind in ("BRUTE_FORCE", "KDTREE"))
    return {**result, "kdtree_times_faster": ratio(slow, fast)}


def before(rounds, threads, tree, say):
    """Return the times of F12 of this tree and of another revision's, measured by turns."""
    result, trees = {}, {"before": tree, "now": ROOT}
    for name, samples in (("balls", 16), ("default_cube", 32), ("cornell", 16), ("spheres600", 16)):
        settings = {"engine": "LANCER", "name": name, "threads": threads, "samples": samples}

        def seconds_of(key, _, settings=settings):
            return jobs.in_blender("f12", trees[key], **settings)["seconds"]

        seconds = by_turns(rounds, trees, seconds_of)
        result[name] = {key: middle(values) for key, values in seconds.items()}
        result[name]["times_faster"] = ratio(seconds["before"], seconds["now"])
        say(f"{name}, {samples} samples: time before / now {result[name]['times_faster']['median']:.3f}")
    return result
