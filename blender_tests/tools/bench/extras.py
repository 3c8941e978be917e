"""What is measured beside the scenes: first looks, preparation, threads, accelerators, another revision."""

from . import jobs
from .estimates import middle


def columns(answers):
    """{name: median, smallest, largest} of the numbers in several answers of one kind."""
    names = [name for name, value in answers[0].items() if isinstance(value, (int, float))]
    return {name: middle(answer[name] for answer in answers) for name in names}


def first_look(rounds, name, **settings):
    """The same scene through F12 in both engines, by turns: 320 x 180, one sample."""
    answers = {engine: [] for engine in ("LANCER", "CYCLES")}
    size = {"width": 320, "height": 180, "samples": 1}
    for _ in range(rounds):
        for engine, found in answers.items():
            found.append(jobs.in_blender("f12", engine=engine, name=name, **size, **settings))
    return {engine: columns(found) for engine, found in answers.items()}


def first_shown(rounds, threads):
    size = {"width": 640, "height": 480, "samples": 4}
    return columns([jobs.in_blender("first_shown", name="balls", threads=threads, **size) for _ in range(rounds)])


def prepare(rounds, name, threads):
    return columns([jobs.in_blender("prepare", name=name, threads=threads) for _ in range(rounds)])


def threads_scaling(rounds, quick):
    """The rate on two threads over that on one, by turns."""
    size = {"width": 128, "height": 96, "samples": 32} if quick else {"width": 256, "height": 192, "samples": 64}
    rates = {1: [], 2: []}
    for number in range(rounds):
        for threads, found in rates.items():
            answer = jobs.in_blender(
                "render", engine="LANCER", name="balls", threads=threads, seed=number, **size, first_look=False
            )
            found.append(answer["samples"] / answer["render_seconds"])
    return {"times_faster": middle(two / one for one, two in zip(rates[1], rates[2], strict=True))}


def accelerators(rounds, threads):
    kinds = ["KDTREE", "BRUTE_FORCE", "BVH"]
    settings = {"name": "spheres600", "threads": threads, "bounces": 10, "width": 320, "height": 240}
    answers = [jobs.in_blender("accelerators", kinds=kinds, **settings) for _ in range(rounds)]
    result = {"instruction_set": answers[0]["instruction_set"]}
    for kind in kinds:
        result[kind] = columns([answer[kind] for answer in answers])
    ratio = middle(answer["BRUTE_FORCE"]["seconds"] / answer["KDTREE"]["seconds"] for answer in answers)
    return {**result, "kdtree_times_faster": ratio}


def before(rounds, threads, tree, say):
    """F12 of this tree and of another revision's, by turns."""
    result = {}
    for name, samples in (("balls", 16), ("default_cube", 32), ("cornell", 16), ("spheres600", 16)):
        seconds = {"before": [], "now": []}
        for _ in range(rounds):
            for key, root in (("before", tree), ("now", jobs.ROOT)):
                answer = jobs.in_blender("f12", root, engine="LANCER", name=name, threads=threads, samples=samples)
                seconds[key].append(answer["seconds"])
        result[name] = {key: middle(values) for key, values in seconds.items()}
        pairs = zip(seconds["before"], seconds["now"], strict=True)
        result[name]["times_faster"] = middle(a / b for a, b in pairs)
        say(f"{name}, {samples} samples: time before / now {result[name]['times_faster']['median']:.3f}")
    return result
