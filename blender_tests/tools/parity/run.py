"""Render the parity scenes with Lancer and Cycles, and compare the pictures: `make parity`.

Runs under a Python that has bpy, and inside Blender.
"""

import contextlib
import os
import sys
import tempfile

import bpy

from scenes.parity import catalogue, figures
from scenes.render import captured_output
from tools.harness.f12 import registered
from tools.harness.terminal import Progress, make_parser

from . import contest, page

# Samples of each half in `make test`: the limits then allow for the noise.
QUICK_SAMPLES = 32


def read_arguments():
    patterns = "comma-separated patterns of scene names or subjects, as 'lights*'"
    quick = "few samples; what their noise explains is no failure, as long as that is at most three limits"
    parser = make_parser(__doc__, quick=quick, only=patterns, output="parity")
    parser.add_argument("--subset", action="store_true", help="the scenes of `make test` alone")
    parser.add_argument("--most-samples", type=int, default=1024, help="of each half of each engine")
    parser.add_argument("--self-check", action="store_true", help="Cycles against Cycles: the judge must find no difference")
    parser.add_argument("--list", action="store_true", help="name the scenes and render none")
    return parser.parse_args()


@contextlib.contextmanager
def errors_in(path):
    """A context that redirects standard error, also that of Blender, into a file."""
    saved = os.dup(2)
    with open(path, "w", encoding="utf-8") as log:
        os.dup2(log.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(saved, 2)
            os.close(saved)


def line(outcome):
    worst = outcome.worst
    text = f"{outcome.verdict:6} {outcome.case.name:38}"
    if worst is not None:
        limit = outcome.case.limits
        numbers = figures.decisive(outcome.parts[worst][0], limit)
        text += (
            f" mean {numbers.mean:8.3%} of {limit.mean:.2%} (noise {numbers.noise_mean:.3%})"
            f"  p99 {numbers.p99:8.3%} of {limit.p99:.2%} (noise {numbers.noise_p99:.3%})"
            f"  {outcome.samples} samples, {sum(outcome.seconds.values()):.1f} s"
        )
        if list(outcome.parts) != ["Combined", "Alpha"] or worst != "Combined":
            text += f"  [{worst}]"
    return " ".join(filter(None, (text, outcome.note, f"({len(outcome.messages)} messages)" if outcome.messages else "")))


def main():
    arguments = read_arguments()
    cases = catalogue.select(arguments.only, arguments.subset)
    if not cases:
        sys.exit(f"no scene is called {arguments.only}")
    if arguments.list:
        sys.stdout.write("".join(f"{case.kind_name:8} {case.subject:24} {case.name}\n" for case in cases))
        return 0
    arguments.output.mkdir(parents=True, exist_ok=True)
    pair = ("CYCLES", "CYCLES") if arguments.self_check else ("LANCER", "CYCLES")
    title = f"{pair[0].title()} and {pair[1].title()} in Blender {bpy.app.version_string}"
    outcomes = []
    log = errors_in(arguments.output / "console.log")
    with captured_output() as (terminal, _), log, tempfile.TemporaryDirectory() as folder:
        say = Progress(terminal)
        say(f"{title}: {len(cases)} scenes")
        for case in cases:
            say.show(case.name)
            if arguments.quick:
                case = catalogue.smaller(case)
            most = QUICK_SAMPLES if arguments.quick else arguments.most_samples
            outcome = contest.run(case, folder, pair, most, noise_aware=arguments.quick)
            outcomes.append(outcome)
            say(line(outcome))
            # A crash in a later scene must not take the page of the earlier ones with it.
            page.write(outcomes, arguments.output, title)
        terminal.write(f"{page.summary(outcomes)}\n{os.path.relpath(arguments.output / 'index.html')}\n")
    return int(any(outcome.verdict in ("fail", "noise", "error") for outcome in outcomes))


if __name__ == "__main__":
    sys.exit(registered(main))
