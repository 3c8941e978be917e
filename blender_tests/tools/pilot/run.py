"""`make pilot`: fits the weights of the pilot's cost model, and prints them beside those of core/src/render/pilot.h.

Each scene is rendered with several fixed splits, on one thread, by turns. The figures are the processor's seconds and the
counts of rays and vertices after the first sample. Then each scene is rendered with the splits that the pilot finds, and with
the same splits given: the difference is the time of the search.
"""

import re
import statistics
import time

import numpy as np
import tiny_scenes as tiny

from addon.bindings.enums import Integrator
from addon.bindings.session import Session
from tools.accuracy import scenes as accuracy_scenes
from tools.harness import workers
from tools.harness.places import ROOT, machine
from tools.harness.terminal import Progress, make_parser
from tools.harness.turns import by_turns

from .fit import deviation, fit

MODEL = ROOT / "core" / "src" / "render" / "pilot.h"
WEIGHTS = ("camera_ray", "ray", "vertex")
# Ways of splitting: lights, paths. With them, the counts of rays and of vertices vary independently.
SPLITS = ((1, 1), (4, 1), (1, 4), (4, 4))
WIDTH, HEIGHT = 192, 128
_SECONDS = 0.3
# The pictures for the time of the search, as in pilot.h.
_PLANNED = 64


def read_arguments():
    patterns = "comma-separated patterns of scene names, as 'glass*'"
    return make_parser(__doc__, quick="three scenes, one round: a minute", only=patterns).parse_args()


def weights_of_source():
    """Returns the weights of CostModel; raises LookupError if the header lacks one of them."""
    text = MODEL.read_text(encoding="utf-8")
    found = {name: re.search(rf"uint64_t {name} = (\d+);", text) for name in WEIGHTS}
    missing = [name for name, match in found.items() if not match]
    if missing:
        raise LookupError(f"{MODEL.name} has no {', '.join(missing)}")
    return np.array([float(match[1]) for match in found.values()])


def counts_of(statistics_):
    vertices = statistics_.vertices
    return np.array([statistics_.camera_rays, statistics_.bounce_rays + statistics_.shadow_rays, vertices], float)


def measure(snapshot, samples):
    """Returns (seconds of the processor, counts) of the samples after the first."""
    with Session.upload(snapshot) as session:
        session.render_all(1)
        before, start = counts_of(session.statistics()), time.process_time()
        session.render(1, samples)
        while not session.wait(1.0).finished:
            pass
        return time.process_time() - start, counts_of(session.statistics()) - before


def with_splits(snapshot, splits, samples=2):
    fields = {"split_lights": splits[0], "split_paths": splits[1], "threads": 1, "samples": samples}
    return tiny.with_settings(snapshot, **fields)


def measure_scene(snapshot, rounds):
    """Returns [(seconds, counts)] for each of SPLITS, the medians over the rounds."""
    seconds, _ = measure(with_splits(snapshot, (1, 1)), 4)
    samples = max(2, round(4 * _SECONDS / max(seconds, 1e-4)))
    found = by_turns(rounds, SPLITS, lambda splits, _: measure(with_splits(snapshot, splits, samples + 1), samples))
    return [(statistics.median(one[0] for one in runs), runs[0][1]) for runs in found.values()]


def search_share(snapshot, rounds):
    """Returns (splits, time of the search over the time of a picture of _PLANNED samples with these splits)."""

    def seconds(splits):
        with Session.upload(with_splits(snapshot, splits, _PLANNED)) as session:
            start = time.process_time()
            session.render_all(_PLANNED)
            used = session.statistics()
            return time.process_time() - start, (used.split_lights, used.split_paths)

    _, splits = seconds((0, 0))
    ratios = [seconds((0, 0))[0] / seconds(splits)[0] for _ in range(rounds)]
    return splits, statistics.median(ratios) - 1.0


def report(counts, seconds, scenes):
    """Yields the lines of the fit beside the source."""
    source = weights_of_source()
    fixed = WEIGHTS.index("ray")
    counts, seconds, scenes = np.asarray(counts, float), np.asarray(seconds, float), np.asarray(scenes)
    found = fit(counts, seconds, scenes, source, fixed)
    yield f"{'weight':<12}{'source':>8}{'fit':>9}   95 %"
    for name, old, new, error in zip(WEIGHTS, source, found.weights, found.errors, strict=True):
        interval = "fixed" if error == 0.0 else f"{new - 1.96 * error:.1f} ... {new + 1.96 * error:.1f}"
        yield f"{name:<12}{old:8.0f}{new:9.2f}   {interval}"
    of_source = deviation(source, counts, seconds, scenes)
    yield f"standard deviation of a predicted time: source {100 * of_source:.1f} %, fit {100 * found.deviation:.1f} %"


def main():
    arguments, say = read_arguments(), Progress()
    rounds = 1 if arguments.quick else 3
    counts, seconds, names = [], [], []
    for scene in accuracy_scenes.chosen(arguments.only, arguments.quick):
        try:
            snapshot = accuracy_scenes.at_size(scene.build(), WIDTH, HEIGHT)
        except workers.Failed as reason:
            say(f"{scene.name}: left out: {reason}")
            continue
        if snapshot.settings.integrator != Integrator.PATH:
            continue
        runs = measure_scene(snapshot, rounds)
        for one, count in runs:
            seconds.append(one)
            counts.append(count)
            names.append(scene.name)
        times = ", ".join(f"{lights} x {paths}: {one:.2f} s" for (lights, paths), (one, _) in zip(SPLITS, runs, strict=True))
        splits, share = search_share(snapshot, rounds)
        say(f"{scene.name}: {times}; finds {splits[0]} x {splits[1]}, search {100 * share:+.1f} % of {_PLANNED} samples")
    facts = machine()
    print(f"{len(set(names))} scenes, {len(SPLITS)} splits each, {rounds} rounds; {facts['processor']}, load {facts['load']}")
    for line in report(counts, seconds, names):
        print(line)


if __name__ == "__main__":
    main()
