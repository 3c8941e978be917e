"""What the simulation knows: costs as measured, and what is assumed about machines and their network."""

import dataclasses
import json
import math
from dataclasses import dataclass
from typing import NamedTuple


class Spent(NamedTuple):
    """Seconds of the processors of the client, the scheduler and a worker."""

    client: float
    scheduler: float
    worker: float


@dataclass(frozen=True)
class PartCosts:
    """Of the parts of a picture with some passes. Seconds are those of one thread; bytes, but for the head, are per pixel."""

    head_bytes: int  # of a part without tiles
    sum_bytes: int  # of a sum of samples
    tile_bytes: int  # of a tile with any samples
    first_bytes: int  # of a tile with the first sample
    join_seconds_per_byte: float  # at the client: check and add
    worker_join_seconds_per_byte: float  # at a worker: check, add, export
    export_seconds_per_byte: float
    statistics_seconds_per_tile: float
    error_seconds_per_pixel: float
    plan_seconds_per_pixel: float
    read_seconds_per_pixel: float
    start_seconds: float  # of a worker's session, for the least range


@dataclass(frozen=True)
class Costs:
    """All that is measured."""

    connect_seconds: float
    submit: Spent  # a task, until its end is known
    fetch: Spent  # a part, if the client asks for one after another
    gather: Spent  # a part, if the client asks for many at once
    release: Spent  # a part that the client has
    ask: Spent  # a question of the client
    scene: Spent  # a worker's fetching of the scene
    list_seconds_per_worker: float  # of the client, for a look at its list of workers
    fetch_seconds_per_byte: float  # from another process of this machine
    scene_bytes: int
    encode_seconds: float
    prepare_seconds: float  # to read and build the scene
    pilot_samples: float  # pixel samples that take as long as the pilot
    parts: dict  # PartCosts by kind of passes
    cost_map: list  # rows of squares: the cost of a sample, relative to the mean
    noise_map: list  # rows of squares: the relative variance of a sample

    def write(self, path):
        path.write_text(json.dumps(dataclasses.asdict(self), indent=1) + "\n", encoding="utf-8")

    @classmethod
    def of(cls, told):
        """Return the costs of a dict as asdict makes it, or JSON."""
        spent = {field.name: Spent(*told[field.name]) for field in dataclasses.fields(cls) if field.type is Spent}
        return cls(**told | spent | {"parts": {name: PartCosts(**one) for name, one in told["parts"].items()}})


@dataclass(frozen=True)
class Assumed:
    """All that is assumed."""

    threads: int = 16  # of a worker
    spread: float = 0.2  # standard deviation of the logarithm of workers' speeds
    slow_share: float = 0.01  # of the workers
    slowness: float = 5.0  # how many times as long a slow worker takes
    lost_per_second: float = 0.001 / 60.0  # probability that a worker is lost
    bytes_per_second: float = 125e6  # of each machine's link
    latency: float = 1e-4  # seconds from machine to machine
    in_turn: bool = True  # whether the client waits for a part before it asks for the next


# Terms of the time. Without one of them, the simulation tells what it costs.
SCENE, NETWORK, CLIENT, SCHEDULER, THREADS, WORKERS = (
    "scene and pilot", "network", "client", "scheduler", "threads without a tile", "uneven workers",
)  # fmt: skip
TERMS = (SCENE, NETWORK, CLIENT, SCHEDULER, THREADS, WORKERS)
_OF_CALLS = ("submit", "fetch", "gather", "release", "ask", "scene")
_JUDGING = ("join_seconds_per_byte", "statistics_seconds_per_tile", "error_seconds_per_pixel", "plan_seconds_per_pixel",
            "read_seconds_per_pixel")  # fmt: skip


def without(term, costs, assumed):
    """Return (costs, assumed) where a term takes no time."""
    free = dataclasses.replace
    calls = {name: getattr(costs, name) for name in _OF_CALLS}
    if term == SCENE:
        return free(costs, scene_bytes=0, encode_seconds=0.0, prepare_seconds=0.0, pilot_samples=0.0), assumed
    if term == NETWORK:
        return costs, free(assumed, bytes_per_second=math.inf, latency=0.0)
    if term == CLIENT:
        parts = {name: free(one, **dict.fromkeys(_JUDGING, 0.0)) for name, one in costs.parts.items()}
        own = {name: one._replace(client=0.0) for name, one in calls.items()}
        own |= {"connect_seconds": 0.0, "list_seconds_per_worker": 0.0, "fetch_seconds_per_byte": 0.0}
        return free(costs, parts=parts, **own), free(assumed, in_turn=False)
    if term == SCHEDULER:
        return free(costs, **{name: one._replace(scheduler=0.0) for name, one in calls.items()}), assumed
    if term == THREADS:
        return costs, free(assumed, threads=1)
    if term == WORKERS:
        return costs, free(assumed, spread=0.0, slow_share=0.0, lost_per_second=0.0)
    raise ValueError(term)
