"""The page of faults: which test found each."""

from collections import Counter

from tools.harness import page

_TOLD = """One line of a copy of the project is made wrong at a time, and the tests that must notice are run. Killed: a test
fails. Survived: all pass, so a test is missing. Broken: the faulty code does not compile, or its tests do not come to their
end."""
_HEAD = ["fault", "file", "line", "with the fault", "verdict", "seconds", "failure"]
_CLASSES = {"killed": "yes", "survived": "no", "broken": "no"}


def sentence(rows):
    counts = Counter(row["verdict"] for row in rows)
    return f"{len(rows)} faults: " + ", ".join(f"{counts[verdict]} {verdict}" for verdict in _CLASSES)


def write(figures, folder):
    rows = [_row(found) for found in figures["faults"]]
    page.write(folder, "mutants", figures, "Faults and tests", [_TOLD, sentence(figures["faults"]), page.table(_HEAD, rows)])


def _row(found):
    texts = [(found[name], "text") for name in ("file", "find", "put")]
    verdict = (found["verdict"], _CLASSES[found["verdict"]])
    return [f"{found['name']}: {found['about']}", *texts, verdict, f"{found['seconds']:.1f}", (found["failure"], "text")]
