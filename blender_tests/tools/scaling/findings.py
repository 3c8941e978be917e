"""What the figures say: how many workers pay off, where more of them end to help, and why.

Each sentence is made of measured or simulated figures, and stays true if they change.
"""

from addon.measure.schedule import FIRST_LOOK

from . import study
from .cases import GIGABIT
from .costs import THREADS, Assumed
from .simulate import HOUR

# A worker pays off while the efficiency is at least this.
PAYS = 0.5
SUMMARY_HEAD = (
    "still", f"workers of at least {100 * PAYS:.0f} % efficiency", "time", "fastest number", "time", "speedup",
    "most time, and its share",
)  # fmt: skip
BUSY_HEAD = (
    "still", "workers", "workers render", "scheduler", "client: tasks", "client: fetching", "client: waiting for parts",
    "client: joining", "client: error and plan",
)  # fmt: skip
# Kinds of work of the client, in the columns of BUSY_HEAD.
_BUSY = (("submit", "ask", "look"), ("fetch",), ("wait for a part",), ("join",), ("judge",))


def fastest(rows):
    return min(rows, key=lambda row: row["seconds"])


def paying(rows):
    """Return the row of the most workers that pay off, or None."""
    return max((row for row in rows if row["efficiency"] >= PAYS), key=lambda row: row["workers"], default=None)


def summary(stills):
    """Yield a row for each still: (letter, rows)."""
    for letter, rows in stills:
        pays, best = paying(rows), fastest(rows)
        yield [
            letter,
            *((str(pays["workers"]), seconds(pays["seconds"])) if pays else ("none", "")),
            str(best["workers"]),
            seconds(best["seconds"]),
            f"{best['speedup']:.1f}",
            study.limit(best),
        ]


def busy(stills):
    """Yield rows of how busy all are, with the fastest and with the largest number of workers."""
    for letter, rows in stills:
        for row in {row["workers"]: row for row in (fastest(rows), rows[-1])}.values():
            own = [sum(row["client"].get(kind, 0.0) for kind in kinds) / row["seconds"] for kinds in _BUSY]
            shares = (row["workers_busy"], row["scheduler_busy"], *own)
            yield [letter, str(row["workers"]), *(f"{100 * share:.0f} %" for share in shares)]


def of_still(rows):
    """Yield sentences about one still."""
    pays, best, most = paying(rows), fastest(rows), rows[-1]
    up_to = f"up to {pays['workers']} workers" if pays else "with none of these numbers of workers"
    yield (
        f"The efficiency is at least {100 * PAYS:.0f} % {up_to}. {best['workers']} workers are the fastest: "
        f"{seconds(best['seconds'])}, {best['speedup']:.1f} times as fast as one machine. {_terms(best)}"
    )
    if most is not best:
        yield (
            f"{most['workers']} workers take {seconds(most['seconds'])}. {_terms(most)} They render for "
            f"{100 * most['workers_busy']:.0f} % of that time."
        )


def _terms(row):
    found = [f"{term} {100 * row['gains'][term]:.0f} %" for term in study.limits(row)]
    least = f"{100 * study.LEAST_GAIN:.0f} %"
    return f"Shares of that time: {', '.join(found)}." if found else f"No term has a share of {least} of that time."


def of_costs(costs, stills):
    """Yield (name, text) for each reason; stills: [(Still, rows)]."""
    yield "The client", _client(costs, stills)
    yield "The scheduler", _scheduler(stills)
    yield "Threads", _threads(stills)
    yield "Rounds", _rounds(stills)
    yield "The network", _network(costs, stills)
    yield "The scene", _scene(costs, stills)
    lost = _most(stills, lambda row: row["lost"])
    yield (
        "Lost workers",
        f"A picture loses at most {_workers(lost[0])} ({lost[1]}). The probability is for each minute of a worker, and a "
        f"picture with an efficiency of 100 % takes {HOUR / 60:.0f} minutes of workers, whatever their number.",
    )


def _most(stills, value):
    """Return the largest value of all rows, and where it is."""
    _, row, still = max(
        ((value(row), row, still) for still, rows in stills for row in rows), key=lambda one: (one[0], -one[1]["workers"])
    )
    return value(row), f"{still.letter}, {_workers(row['workers'])}"


def _workers(count):
    return f"{count} worker{'s' * (count != 1)}"


def part_seconds(row):
    """Return the seconds that a worker renders for each part."""
    return row["workers_busy"] * row["seconds"] * row["workers"] / row["parts"]


def _client(costs, stills):
    task, many = costs.submit.client, costs.gather.client
    alone = costs.fetch.client + costs.fetch.scheduler + costs.fetch.worker + 4 * Assumed().latency
    told = []
    for still, row in _fastest(stills):
        tasks, rendering = row["tasks"] / row["parts"], part_seconds(row)
        busy_with = [rendering / (tasks * task + fetching) for fetching in (alone, many)]
        told.append(
            f"{still.letter}, {_workers(row['workers'])}: {row['parts'] / row['fetches']:.1f} parts at a time, "
            f"{tasks:.1f} tasks and {rendering:.2f} s of rendering for each, {busy_with[0]:.0f} or {busy_with[1]:.0f} workers"
        )
    return (
        f"One thread submits all tasks, fetches their parts and joins them. A task takes {_ms(task)} of this thread. A small "
        f"part takes {_ms(alone)} if the client fetches it alone, with the waiting for scheduler and worker, and {_ms(many)} "
        "if the client fetches many at a time. Parts of the fastest pictures, and the numbers of workers that keep the client "
        f"busy if it fetches parts alone or many at a time: {'; '.join(told)}."
    )


def _fastest(stills):
    return [(still, fastest(rows)) for still, rows in stills]


def _scheduler(stills):
    share, where = _most(stills, lambda row: row["scheduler_busy"])
    told = [
        f"{still.letter} {_ms(row['scheduler_busy'] * row['seconds'] / row['tasks'])} for each of {row['tasks']} tasks, "
        f"{row['workers'] / row['scheduler_busy']:.0f} workers"
        for still, row in _fastest(stills)
    ]
    return (
        "Each task takes time of the scheduler's one processor. That time in the fastest pictures, and the numbers of workers "
        f"whose tasks keep the scheduler busy at the same rate: {'; '.join(told)}. The scheduler is busy for at most "
        f"{100 * share:.0f} % of the time ({where})."
    )


def _threads(stills):
    threads = Assumed().threads
    gain, where = _most(stills, lambda row: row["gains"][THREADS])
    told = [
        f"{still.letter} {tiles_of(still.case) / threads / rows[-1]['workers']:.1f} with {_workers(rows[-1]['workers'])}"
        for still, rows in stills
    ]
    return (
        f"One thread of a worker renders the samples of a tile. A task of fewer tiles than the {threads} threads leaves "
        f"threads idle, and so do the last tiles of each task. Tiles for each thread: {', '.join(told)}. Threads without a "
        f"tile take at most {100 * gain:.0f} % of the time ({where})."
    )


def tiles_of(case):
    return 2 * -(-case.width // 16) * -(-case.height // 16)


def _rounds(stills):
    told = []
    for still, row in _fastest(stills):
        on_their_way = sum(tasks > 0 for _, _, tasks in row["rounds"][1:])
        text = f"{still.letter} {on_their_way} of {len(row['rounds'])}"
        for start, mean, _ in [one for one in row["rounds"] if one[1] >= FIRST_LOOK][:1]:
            time, samples = (start - row["prepared"]) / row["seconds"], mean / row["samples"]
            text += f", with {100 * samples:.1f} % of the samples after {100 * time:.0f} % of the time"
        told.append(text)
    return (
        "Workers are idle at the end of a round if the next round waits for the last parts. Rounds of the fastest pictures "
        "that begin while parts of the round before are on their way, and the samples at the start of the first round that "
        f"has at least {FIRST_LOOK} of a pixel: {'; '.join(told)}."
    )


def _network(costs, stills):
    told = [
        f"{still.letter} {row['fetched'] / 1e9:.1f} GB in {seconds(row['fetched'] / (still.gigabits * GIGABIT))}"
        for still, row in _fastest(stills)
    ]
    kinds = {still.case.passes: costs.parts[still.case.passes].join_seconds_per_byte for still, _ in stills}
    joining = ", ".join(f"{1e9 * each:.1f} s to check and join ({kind})" for kind, each in kinds.items())
    return (
        "A part has a sum for each pixel of its tiles, however few samples the sum is of: more rounds are more bytes. The "
        f"client's link brings the parts of the fastest pictures: {'; '.join(told)}. A GB takes another "
        f"{1e9 * costs.fetch_seconds_per_byte:.1f} s to read, and {joining}."
    )


def _scene(costs, stills):
    told = [f"{still.letter} {seconds(rows[-1]['scene_came'])} with {_workers(rows[-1]['workers'])}" for still, rows in stills]
    return (
        f"Some workers get the scene's {costs.scene_bytes / 1e6:.0f} MB at first, and send them to the others. "
        f"The last worker has them after: {', '.join(told)}."
    )


def seconds(value):
    return f"{value / 60:.0f} min" if value >= 600 else f"{value:.0f} s" if value >= 9.95 else f"{value:.1f} s"


def _ms(value):
    return f"{1000 * value:.1f} ms"
