"""`make corpus`: files as their authors left them, by Lancer and by Cycles: build/corpus/index.html.

Two processes open every file, one for each engine, with limits of time and memory, so that a crash or a hang is a row.
The figures of each file are kept, so that an interrupted run continues where it ended.
"""

import argparse
import datetime
import os
import shlex
import sys
from dataclasses import asdict, replace
from pathlib import Path

from tools.harness.conversation import Conversation
from tools.harness.kept import kept
from tools.harness.places import ROOT, digest_of_file, digest_of_files, digest_of_library, header, machine
from tools.harness.terminal import Progress, make_parser
from tools.harness.workers import START

from . import measure, page, sources, verdicts

# Share of the machine's memory for one process; two processes have a file open at a time.
_SHARE_OF_MEMORY = 0.4
# Modules on which a row depends; the rest of this folder writes pages.
_MEASURING = ("alike", "framing", "measure", "noise", "worker")


def read_arguments():
    patterns = "comma-separated patterns of names, file names or kinds, as 'donut*'"
    settings = {"only": patterns, "threads": os.cpu_count(), "readme": True, "output": "corpus"}
    parser = make_parser(__doc__, quick="few samples: some seconds a file", **settings)
    parser.add_argument("--folder", type=Path, help="whose .blend files are rendered; default: those of scenes/corpus.toml")
    parser.add_argument("--clones", type=Path, help="folder of clones, owner+name or owner/name, that the list is taken out of")
    parser.add_argument("--list", type=Path, default=ROOT / "scenes" / "corpus.toml", help="in place of scenes/corpus.toml")
    parser.add_argument("--pixels", type=int, default=320, help="of the longer side")
    parser.add_argument("--denoised", action="store_true", help="compare denoised pictures of files with equal pictures, too")
    parser.add_argument("--budget", type=float, help="seconds for the renders of a file")
    parser.add_argument("--limit", type=float, help="seconds after which one render counts as hung")
    parser.add_argument("--memory", type=float, help="GB that one process may take; default: 40 %% of the machine's")
    parser.add_argument("--blender", default="", help="a Blender program in place of this Python's module")
    parser.add_argument("--worker", type=Path, help=argparse.SUPPRESS)
    return parser.parse_args()


def make_plan(arguments):
    plan = measure.QUICK if arguments.quick else measure.Plan()
    memory = 1e9 * arguments.memory if arguments.memory else _SHARE_OF_MEMORY * machine()["memory_gib"] * 2**30
    given = {"budget": arguments.budget, "limit": arguments.limit}
    given = {name: value for name, value in given.items() if value is not None}
    given["denoised"] = arguments.denoised
    return replace(plan, pixels=arguments.pixels, threads=arguments.threads, memory=memory, **given)


class Workers:
    """Starts workers in a Blender with factory settings."""

    def __init__(self, arguments):
        self.output = arguments.output
        blender = shlex.split(arguments.blender)
        script, *module = [arguments.worker] if arguments.worker else [START, "corpus.worker"]
        settings = ["-b", "--factory-startup", "--python-exit-code", "3", "-P", script, "--"]
        self.command = [*blender, *settings, *module] if blender else [sys.executable, script, *module]
        home = str(self.output / "home")
        keep = {name: value for name, value in os.environ.items() if not name.startswith(("BLENDER_", "XDG_", "DISPLAY"))}
        self.environment = {**keep, "HOME": home}
        os.makedirs(home, exist_ok=True)

    def start(self, _engine):
        return Conversation(self.command, self.output / "console.log", self.environment)


def find_files(arguments):
    if arguments.folder:
        files = sources.in_folder(arguments.folder.resolve())
    else:
        clones = arguments.clones.resolve() if arguments.clones else None
        files = sources.in_list(arguments.list, clones, arguments.output.resolve() / "files")
    return sources.chosen(files, arguments.only)


class Kept:
    """Results that are kept, with a key of everything that they depend on."""

    def __init__(self, arguments, plan):
        own = {"library": digest_of_library()}
        own |= {"addon": digest_of_files((ROOT / "addon").rglob("*.py"))}
        own |= {"corpus": digest_of_files(Path(__file__).with_name(f"{name}.py") for name in _MEASURING)}
        self.own = {**own, "plan": asdict(plan), "blender": arguments.blender}
        self.folder = arguments.output / "results"
        self.suffix = "-quick" if arguments.quick else ""

    def row(self, file, work):
        if file.missing:
            return work()
        key = {**self.own, "file": digest_of_file(file.path), "kind": file.kind, "note": file.note}
        return kept(self.folder / f"{file.slug}{self.suffix}.json", key, work)


class Place:
    """The progress of the run, and its remaining time."""

    def __init__(self, count):
        self.say, self.count, self.number, self.measured = Progress(), count, 0, []

    def begin(self, file):
        self.number += 1
        self.name = file.name

    def show(self, text):
        left = ""
        if self.measured:
            seconds = sum(self.measured) / len(self.measured) * (self.count - self.number + 1)
            left = f", {datetime.timedelta(seconds=round(seconds))} left"
        self.say.show(f"file {self.number} of {self.count}{left}: {self.name[-60:]}: {text}")

    def end(self, row, fresh):
        if fresh:
            self.measured.append(row["seconds"])
        told = f"{verdicts.words(row['verdict'])}{'' if fresh else ' (kept)'}; {row['sentence']}"
        if "efficiency" in row:
            told += f"; speed {row['speed']:.2f}x, efficiency {row['efficiency']:.2f}x"
        self.say(f"{self.number}/{self.count} {self.name}: {told}")


def measure_all(files, arguments, plan, figures):
    workers, results, place = Workers(arguments), Kept(arguments, plan), Place(len(files))
    for file in files:
        place.begin(file)
        fresh = []

        def work(file=file, fresh=fresh):
            fresh.append(True)
            return measure.Measurement(file, plan, workers.start, arguments.output / "pictures", place.show).run()

        row = results.row(file, work)
        place.end(row, bool(fresh))
        figures["files"].append(row)
        # A run takes long: the page has the rows so far.
        write(figures, arguments.output)


def write(figures, folder):
    figures["summary"] = verdicts.summary(figures["files"])
    blenders = sorted({row["blender"] for row in figures["files"] if "blender" in row})
    figures["blender"] = ", ".join(blenders) or "unknown"
    page.write(figures, folder)


def main():
    arguments = read_arguments()
    plan = make_plan(arguments)
    arguments.output.mkdir(parents=True, exist_ok=True)
    files = find_files(arguments)
    if not files:
        sys.exit(f"no .blend file{f' is called {arguments.only}' if arguments.only else ' is there'}")
    figures = {"date": datetime.date.today().isoformat(), **header(arguments.quick), "plan": asdict(plan), "files": []}
    measure_all(files, arguments, plan, figures)
    print(verdicts.sentence(figures["summary"]))
    for key in ("equal", "all"):
        found = figures["summary"]["means"][key]
        if found["files"]:
            title = {"equal": "files with equal pictures", "all": "all files"}[key]
            told = ", ".join(f"{name} {found[name]:.2f}x" for name in ("speed", "variance", "efficiency", "least_efficiency"))
            print(f"{title}: {told.replace('_', ' ')}")
    for row in figures["summary"]["missing"]:
        print(f"{row['key']}: {row['completes']} files made right, {row['total']} in total; {row['files']} files use it")
    if arguments.readme:
        page.update_tables(figures)
    print(os.path.relpath(arguments.output / "index.html"))
    return int(any(row["verdict"] in verdicts.FAULTS for row in figures["files"]))


if __name__ == "__main__":
    sys.exit(main())
