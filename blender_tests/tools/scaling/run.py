"""`make scaling`: a still on up to a thousand machines, simulated from costs measured here: build/scaling/index.html.

The measured costs are kept in build/scaling/costs.json, and measured anew in each run.
"""

import dataclasses
import os

from tools.harness.places import BUILD, ROOT, header
from tools.harness.terminal import Progress, make_parser, wanted

from . import cases, chart, compare, measure, page, study

OUTPUT = BUILD / "scaling"
_SAMPLES, _QUICK_SAMPLES = 64, 16
_RENDERS, _QUICK_RENDERS = 3, 1


def read_arguments():
    quick = "two stills, up to 200 workers: some minutes"
    parser = make_parser(__doc__, quick=quick, only="letters of stills, as 'A,D'")
    parser.add_argument("--readme", action="store_true", help="put page and chart into addon/farm and scenes")
    return parser.parse_args()


def main():
    arguments, say = read_arguments(), Progress()
    quick = arguments.quick
    told = header(quick)
    OUTPUT.mkdir(parents=True, exist_ok=True)
    costs, further = measure.measure(os.cpu_count(), quick, say)
    costs.write(OUTPUT / "costs.json")
    compared = compare.compare(costs, _QUICK_SAMPLES if quick else _SAMPLES, _QUICK_RENDERS if quick else _RENDERS, say)
    figures = {**told, "costs": dataclasses.asdict(costs), "told": further, "compared": compared, "stills": []}
    only = arguments.only or (",".join(cases.QUICK) if quick else "")
    for still in cases.STILLS:
        if wanted(only, still.letter):
            rows = study.study(still, cases.QUICK_WORKERS if quick else cases.WORKERS, costs, say)
            figures["stills"].append({"letter": still.letter, "name": still.name, "rows": rows})
            # A run takes long: the page has the figures so far.
            page.write(figures, OUTPUT)
            chart.write(figures, OUTPUT)
    if arguments.readme:
        page.publish(OUTPUT)
    print((OUTPUT / "index.html").relative_to(ROOT))


if __name__ == "__main__":
    main()
