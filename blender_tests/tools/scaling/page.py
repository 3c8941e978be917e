"""The page of `make scaling`: figures, where it ends and why, what was measured, and what is assumed."""

import shutil

from tools.harness import page
from tools.harness.page import element, markdown
from tools.harness.places import ROOT

from . import cases, findings, study
from .costs import Assumed, Costs, Spent
from .simulate import HOUR

PLACE, CHART = ROOT / "addon" / "farm" / "SCALING.md", ROOT / "scenes" / "scaling.png"
_TITLE = "A still on up to a thousand machines, by simulation"
_HEAD = (
    "workers",
    "time",
    "speedup",
    "efficiency",
    "MB to the client",
    "parts",
    "tasks",
    "messages",
    "most time, and its share",
)


def intro(figures):
    yield (
        f"The samples of each still take one machine {HOUR / 60:.0f} minutes. The simulation runs the farm's own code, from "
        "the schedule to the pool of Dask's workers, with simulated machines, network, film and time. Its costs were measured "
        "on one machine:"
    )
    yield where(figures)
    yield (
        "The speedup is against one machine without a farm; the efficiency is the speedup divided by the number of workers. "
        "The share of a term is the part of the time that the picture saves if the term takes no time. Shares overlap."
    )


def where(figures):
    machine = figures["machine"]
    text = f"{machine['processor']}, {machine['processors']} processors, load {machine['load']} at the start; "
    return f"{text}commit {figures['commit']}" + (". A short run." if figures["quick"] else ".")


def rows_of(rows):
    for row in rows:
        yield [
            str(row["workers"]),
            findings.seconds(row["seconds"]),
            f"{row['speedup']:.1f}",
            page.percent(row["efficiency"], 0),
            f"{row['fetched'] / 1e6:.0f}",
            str(row["parts"]),
            str(row["tasks"]),
            str(row["messages"]),
            study.limit(row),
        ]


def measured(costs, told):
    """Yield rows of a cost and its value."""

    def spent(one):
        return ", ".join(f"{1000 * value:.2f} ms" for value in one)

    yield "scene", f"{told['scene']}: {costs.scene_bytes / 1e6:.1f} MB; encoded in {costs.encode_seconds:.2f} s"
    yield "reading and building the scene", f"{costs.prepare_seconds:.2f} s"
    yield "pilot", f"{told['pilot_seconds']:.2f} s, as long as {costs.pilot_samples:.0f} samples of a pixel"
    yield "a sample of a pixel", f"{1e6 * told['sample_seconds']:.2f} us with {told['threads']} threads"
    yield "connecting to the scheduler", f"{costs.connect_seconds:.2f} s"
    yield "a task: client, scheduler, worker", spent(costs.submit)
    yield f"the same among {told['many_workers']} workers", spent(Spent(*told["submit_of_many"]))
    yield "its part, fetched after another", spent(costs.fetch)
    yield "its part, fetched with many", spent(costs.gather)
    yield "its part, released", spent(costs.release)
    yield "a question of the client", spent(costs.ask)
    yield "a worker's question for the scene, at the scheduler", f"{1000 * costs.scene.scheduler:.2f} ms"
    yield "a part from another process", f"{1e9 * costs.fetch_seconds_per_byte:.2f} s/GB"
    for kind, part in costs.parts.items():
        yield (
            f"{kind}: a pixel in a part, for each sum, each tile, and each first sample",
            (f"{part.sum_bytes} bytes, {part.tile_bytes} bytes, {part.first_bytes} bytes"),
        )
        yield f"{kind}: export at the worker", f"{1e9 * part.export_seconds_per_byte:.2f} s/GB"
        yield f"{kind}: check and join at the client", f"{1e9 * part.join_seconds_per_byte:.2f} s/GB"
        yield f"{kind}: join two parts at a worker", f"{1e9 * part.worker_join_seconds_per_byte:.2f} s/GB"
        yield (
            f"{kind}: error, plan of a round, reading",
            ", ".join(
                f"{1e6 * value:.2f} s/megapixel"
                for value in (part.error_seconds_per_pixel, part.plan_seconds_per_pixel, part.read_seconds_per_pixel)
            ),
        )
        yield f"{kind}: least task of a worker", f"{1000 * part.start_seconds:.2f} ms"


def assumptions():
    given = Assumed()
    yield f"Workers have {given.threads} threads. Their speeds are log-normal, with mean 1 and sigma {given.spread}."
    yield f"{100 * given.slow_share:.0f} % of the workers take {given.slowness:.0f} times as long."
    lost = f"{6000 * given.lost_per_second:.1f} %"
    yield f"A worker is lost with a probability of {lost} in each minute, unless it keeps a copy of the scene."
    yield f"A message takes {1000 * given.latency:.1f} ms. All links of a still are equal; only their sender's end is busy."
    yield "Parts, tasks and messages cost the same with any number of workers; processors are as fast as this one."
    yield "The cost of samples and their noise vary over the picture as in the measured scene, at 480 x 270 pixels."
    yield "The estimated error of a picture is exact: no round follows a wrong guess."
    yield "Blender's pipe to the client, the memory of the client, and Dask's dashboard are left out."


def parts(figures):
    """Yield (title, sentences, head, rows) of each section."""
    yield "", list(intro(figures)), None, None
    costs = Costs.of(figures["costs"])
    lettered = [(still["letter"], still["rows"]) for still in figures["stills"]]
    yield "How many workers pay off", [], findings.SUMMARY_HEAD, list(findings.summary(lettered))
    for still in figures["stills"]:
        yield f"{still['letter']}: {still['name']}", list(findings.of_still(still["rows"])), _HEAD, list(rows_of(still["rows"]))
    stills = [(cases.BY_LETTER[letter], rows) for letter, rows in lettered]
    reasons = [f"**{name}.** {text}" for name, text in findings.of_costs(costs, stills)]
    yield "Where it ends, and why", reasons, findings.BUSY_HEAD, list(findings.busy(lettered))
    compared = [
        [
            str(row["workers"]),
            *(f"{row[name]:.1f} s" for name in ("seconds", "predicted")),
            f"{row['tasks']:.0f}",
            f"{row['predicted_tasks']:.0f}",
        ]
        for row in figures["compared"]
    ]
    head = ("workers of one thread", "measured", "simulated", "parts", "parts, simulated")
    told = ["The simulation gets the seconds that workers rendered, and predicts all others."]
    yield "Measured beside simulated", told, head, compared
    yield "Measured", [], ("", "cost"), [list(row) for row in measured(costs, figures["told"])]
    yield "Assumed", [f"- {line}" for line in assumptions()], None, None


def write(figures, folder):
    """Write scaling.json, index.html and scaling.md."""
    shown, text = (
        [element("img", None, src="scaling.png", width=900)],
        [f"# {_TITLE}", "![Speedup against workers](scaling.png)"],
    )
    for title, sentences, head, rows in parts(figures):
        if title:
            shown.append(element("h2", title))
            text.append(f"## {title}")
        shown += [sentence.replace("**", "") for sentence in sentences]
        between = "\n" if sentences and sentences[0].startswith("- ") else "\n\n"
        text.append(between.join(sentences))
        if rows:
            shown.append(page.table(head, rows))
            text.append(markdown(head, rows))
    page.write(folder, "scaling", figures, _TITLE, shown)
    (folder / "scaling.md").write_text("\n\n".join(part for part in text if part) + "\n", encoding="utf-8")


def publish(folder):
    """Put the page beside the farm's others, and the chart beside the pictures of the README."""
    told = (folder / "scaling.md").read_text(encoding="utf-8")
    PLACE.write_text(told.replace("](scaling.png)", "](../../scenes/scaling.png)"), encoding="utf-8")
    shutil.copyfile(folder / "scaling.png", CHART)
