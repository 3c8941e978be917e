"""The parity scenes that are flagged as quick, small and with few samples."""

import collections
import tempfile

from scenes.parity import catalogue, contest, run


def subset(engine, pattern):
    """What noise explains is no failure here: to a limit comes 1.5 times the noise's mean, and to that of the 99th percentile
    four standard deviations of a block, all of it measured from the difference of two halves with different seeds."""
    outcomes = []
    with tempfile.TemporaryDirectory() as folder:
        for case in catalogue.select(pattern, quick=True):
            case = catalogue.smaller(case)
            outcomes.append(contest.run(case, folder, (engine, "CYCLES"), run.QUICK_SAMPLES, noise_aware=True))
    counts = collections.Counter(outcome.verdict for outcome in outcomes)
    return {"lines": [run.line(outcome) for outcome in outcomes], "counts": dict(counts)}
