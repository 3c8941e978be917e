"""`make differ`: random small scenes by Lancer and by Cycles; what differs without a message is shrunk and kept.

build/differ/faults holds a script for each fault, build/differ/differ.json the verdict of every seed.
"""

import os
import re
import shlex
import sys

from tools.harness.kept import kept
from tools.harness.places import ROOT, digest_of_files, digest_of_library
from tools.harness.terminal import Progress, make_parser
from tools.harness.workers import START

from . import generator, record
from .hunt import FAULTS, Hunt

_NOT_FREED = re.compile(rb"[Nn]ot freed memory blocks: \d+.*")


def read_arguments():
    parser = make_parser(__doc__, quick="32 samples of each half of each engine at most", output="differ")
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1, help="the first one")
    parser.add_argument("--most-samples", type=int, default=128, help="of each half of each engine")
    parser.add_argument(
        "--blender", default="", help="a Blender program, or a Python that has bpy, in place of this Python's module"
    )
    parser.add_argument("--feature", action="append", default=[], choices=generator.FEATURES, help="in every scene")
    parser.add_argument("--keep-size", action="store_true", help="faults are not shrunk")
    return parser.parse_args()


def worker_command(blender):
    """A Blender, or a Python that has bpy, with a worker in it."""
    words = shlex.split(blender) or [sys.executable]
    if "python" in os.path.basename(words[0]):
        return [*words, START, "differ.worker"]
    return [*words, "-b", "--factory-startup", "--python-exit-code", "3", "-P", START, "--", "differ.worker"]


def environment(folder):
    home = folder / "home"
    home.mkdir(parents=True, exist_ok=True)
    keep = {name: value for name, value in os.environ.items() if not name.startswith(("BLENDER_", "XDG_", "DISPLAY"))}
    return {**keep, "HOME": str(home)}


def examine(hunt, seed, arguments, say):
    """The verdict of a seed, as it is kept."""
    scene = generator.describe(seed, arguments.feature)
    answer = hunt.verdict(scene)
    if answer["verdict"] in FAULTS:
        scene = answer.pop("scene", scene)
        say(f"seed {seed}: {answer['verdict']}: {answer['text']}")
        if not arguments.keep_size:
            scene, answer = hunt.shrink(scene, answer, lambda text: say.show(f"seed {seed} shrinks: {text}"))
        text = record.to_python(scene, f"seed {seed}: {answer['verdict']}: {answer['text']}")
        path = arguments.output / "faults" / f"{seed}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        say(f"{os.path.relpath(path)}\n{text}")
    return {name: answer[name] for name in ("verdict", "text", "seconds", "engines", "told") if name in answer}


def main():
    arguments = read_arguments()
    arguments.output.mkdir(parents=True, exist_ok=True)
    log = arguments.output / "console.log"
    log.write_bytes(b"")
    sources = [*(ROOT / "addon").rglob("*.py"), *(ROOT / "blender_tests" / "tools" / "differ").glob("*.py")]
    key = {"library": digest_of_library(), "sources": digest_of_files(sources), "blender": arguments.blender}
    if arguments.feature:
        key["asked"] = sorted(arguments.feature)
    say, counts = Progress(), {}
    most_samples = 32 if arguments.quick else arguments.most_samples
    with Hunt(worker_command(arguments.blender), log, environment(arguments.output), most_samples) as hunt:
        for seed in range(arguments.seed, arguments.seed + arguments.scenes):
            say.show(f"seed {seed}: {counts}")
            path = arguments.output / "seeds" / f"{seed}.json"
            result = kept(path, key, lambda seed=seed: examine(hunt, seed, arguments, say))
            counts.setdefault(result["verdict"], []).append(seed)
        code = hunt.end()
    said = _NOT_FREED.findall(log.read_bytes())
    for verdict, seeds in sorted(counts.items()):
        say(f"{len(seeds)} {verdict}" + (f": seeds {', '.join(map(str, seeds))}" if verdict not in ("pass", "told") else ""))
    if said or code:
        say(f"the last worker ended with {code}; {said[0].decode() if said else 'all blocks are freed'}")
    return int(bool(said) or bool(code) or any(verdict in FAULTS for verdict in counts))


if __name__ == "__main__":
    sys.exit(main())
