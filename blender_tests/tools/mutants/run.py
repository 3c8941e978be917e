"""`make mutants`: one line of the code is made wrong at a time, and a test must fail: build/mutants/index.html.

First the tests run without a fault. Verdicts are kept: a run that was broken off goes on where it ended, as long as no file has
changed. The exit code is 1 where a fault survives, or is broken: where it does not compile or its tests do not end.
"""

import os
import sys
import time
from dataclasses import asdict

from tools.harness.kept import kept
from tools.harness.places import BUILD, ROOT, header
from tools.harness.terminal import Progress, make_parser, wanted

from . import page, tests
from .faults import read_faults
from .tree import Broken, Tree

OUTPUT = BUILD / "mutants"


def read_arguments():
    patterns = "comma-separated patterns of faults, rooms or files, as 'export*'"
    parser = make_parser(__doc__, quick="leave out the faults of the core, which are compiled", only=patterns)
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilers at a time")
    return parser.parse_args()


def try_without(tree, faults, say):
    """All tests of these faults without any; raises Broken where one fails."""
    say.show(f"tests of {len(faults)} faults, without one")
    names = sorted({name for fault in faults for name in fault.pytest})
    failure = tests.failed(tree, ":".join(dict.fromkeys(fault.gtest for fault in faults if fault.gtest)), names)
    if failure:
        raise Broken(f"fails without a fault: {failure}")


def try_fault(tree, fault):
    """{verdict, failure, seconds}"""
    start = time.monotonic()
    tree.put(fault)
    try:
        if fault.is_core:
            tree.build(tests.targets([fault]))
        failure = tests.failed(tree, fault.gtest, fault.pytest)
        verdict = "killed" if failure else "survived"
    except Broken as broken:
        verdict, failure = "broken", str(broken)
    finally:
        tree.take_back(fault)
    return {"verdict": verdict, "failure": failure or "", "seconds": time.monotonic() - start}


def try_all(tree, faults, digest, figures, say):
    """Faults of one side, the add-on or the core."""
    fresh = []
    if faults[0].is_core:
        say.show("core and its tests")
        tree.build(tests.targets(faults))
    else:
        tree.take_library()

    def attempt(fault):
        if not fresh:
            try_without(tree, faults, say)
            fresh.append(True)
        say.show(f"{len(figures['faults']) + 1} of {figures['count']} {fault.name}")
        return try_fault(tree, fault)

    for fault in faults:
        key = {"tree": digest, **asdict(fault), "pytest": list(fault.pytest)}
        found = kept(OUTPUT / "kept" / f"{fault.name}.json", key, lambda fault=fault: attempt(fault))
        figures["faults"].append({**asdict(fault), **found})
        say(f"{len(figures['faults'])} of {figures['count']} {fault.name}: {found['verdict']}, {found['seconds']:.1f} s")
        if found["verdict"] != "killed":
            say(f"  {fault.file}: {fault.find} -> {fault.put}\n{found['failure']}".rstrip())
        page.write(figures, OUTPUT)


def main():
    arguments, say = read_arguments(), Progress()
    chosen = [fault for fault in read_faults() if wanted(arguments.only, fault.name, fault.room, fault.file)]
    sides = [[fault for fault in chosen if fault.is_core == side] for side in (False, True)]
    if arguments.quick:
        sides[1] = []
    figures = {**header(arguments.quick), "count": sum(map(len, sides)), "faults": []}
    if not figures["count"]:
        sys.exit(f"no fault is called {arguments.only}")
    tree = Tree(OUTPUT, arguments.jobs)
    digest = tree.fill()
    try:
        for faults in filter(None, sides):
            try_all(tree, faults, digest, figures, say)
    except Broken as broken:
        sys.exit(str(broken))
    print(page.sentence(figures["faults"]))
    print((OUTPUT / "index.html").relative_to(ROOT))
    return int(any(row["verdict"] != "killed" for row in figures["faults"]))


if __name__ == "__main__":
    sys.exit(main())
