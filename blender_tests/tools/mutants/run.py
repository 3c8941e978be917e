"""`make mutants`: one line of the code is made wrong at a time, and a test must fail: build/mutants/index.html.

Faults of the add-on are put into copies one after the other. Those of the core are compiled together, each behind a switch, so
that the core is built once. The tests of each fault run without it first. Verdicts are kept: a run that was broken off goes on
where it ended, as long as no file has changed. The exit code is 1 where a fault survives, or is broken: where it does not
compile, where its tests fail without it, or do not end.
"""

import contextlib
import os
import queue
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict

from tools.harness.kept import kept
from tools.harness.places import BUILD, ROOT, header
from tools.harness.terminal import Progress, make_parser, wanted

from . import page, tests
from .faults import read_faults, switched_files
from .tree import Broken, Tree, digest

OUTPUT = BUILD / "mutants"


def read_arguments():
    patterns = "comma-separated patterns of faults, rooms or files, as 'export*'"
    parser = make_parser(__doc__, quick="leave out the faults of the core, which are compiled", only=patterns)
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="tests and compilers at a time")
    return parser.parse_args()


class AddonTrees:
    """Copies of the project, of which each holds one fault at a time."""

    def __init__(self, count):
        self._free = queue.SimpleQueue()
        for number in range(count):
            tree = Tree(OUTPUT / f"addon-{number}")
            tree.fill()
            tree.take_library()
            self._free.put(tree)

    @contextlib.contextmanager
    def _borrowed(self):
        tree = self._free.get()
        try:
            yield tree
        finally:
            self._free.put(tree)

    def without(self, fault):
        with self._borrowed() as tree:
            return tests.failed(tree, fault)

    def with_it(self, fault):
        with self._borrowed() as tree:
            text = tree.put(fault)
            try:
                return tests.failed(tree, fault)
            finally:
                tree.take_back(fault, text)


class CoreTree:
    """One copy with all faults of the core, each behind its switch."""

    def __init__(self, faults, targets, jobs):
        self._tree = Tree(OUTPUT / "core")
        self._tree.fill(switched_files(faults, lambda file: (ROOT / file).read_text(encoding="utf-8")))
        self._tree.build(targets, jobs)

    def without(self, fault):
        return tests.failed(self._tree, fault)

    def with_it(self, fault):
        return tests.failed(self._tree, fault, fault.number)


def attempt(trees, fault):
    """{verdict, failure, seconds}"""
    start = time.monotonic()
    try:
        failure = trees.without(fault)
        if failure:
            raise Broken(f"fails without the fault: {failure}")
        failure = trees.with_it(fault)
        verdict = "killed" if failure else "survived"
    except Broken as broken:
        verdict, failure = "broken", str(broken)
    return {"verdict": verdict, "failure": failure or "", "seconds": time.monotonic() - start}


class Run:
    def __init__(self, count, quick, state):
        self.say, self.count, self.state = Progress(), count, state
        self.figures = {**header(quick), "count": count, "faults": []}
        self._lock = threading.Lock()

    def one(self, trees, fault):
        key = {"tree": self.state, **asdict(fault), "pytest": list(fault.pytest)}
        found = kept(OUTPUT / "kept" / f"{fault.name}.json", key, lambda: attempt(trees, fault))
        with self._lock:
            self.figures["faults"].append({**asdict(fault), **found})
            number = len(self.figures["faults"])
            self.say(f"{number} of {self.count} {fault.name}: {found['verdict']}, {found['seconds']:.1f} s")
            if found["verdict"] != "killed":
                self.say(f"  {fault.file}: {fault.find} -> {fault.put}\n{found['failure']}".rstrip())
            # A run takes long: what there is so far can be looked at.
            page.write(self.figures, OUTPUT)

    def all(self, trees, faults, jobs):
        with ThreadPoolExecutor(jobs) as pool:
            for _ in pool.map(lambda fault: self.one(trees, fault), faults):
                pass


def main():
    arguments = read_arguments()
    faults = read_faults()
    chosen = [fault for fault in faults if wanted(arguments.only, fault.name, fault.room, fault.file)]
    addon = [fault for fault in chosen if not fault.is_core]
    core = [fault for fault in chosen if fault.is_core and not arguments.quick]
    if not addon and not core:
        sys.exit(f"no fault is called {arguments.only}")
    run = Run(len(addon) + len(core), arguments.quick, digest())
    if addon:
        run.all(AddonTrees(min(arguments.jobs, len(addon))), addon, arguments.jobs)
    if core:
        run.say("core and its tests")
        try:
            trees = CoreTree(core, tests.targets(core), arguments.jobs)
        except Broken as broken:
            sys.exit(str(broken))
        run.all(trees, core, arguments.jobs)
    rows = run.figures["faults"]
    print(page.sentence(rows))
    print((OUTPUT / "index.html").relative_to(ROOT))
    return int(any(row["verdict"] != "killed" for row in rows))


if __name__ == "__main__":
    sys.exit(main())
