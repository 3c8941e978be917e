"""Costs of simulated machines in round numbers."""

import dataclasses

from tools.scaling.costs import Assumed, Costs, PartCosts, Spent

NOTHING = PartCosts(0, 40, 0, 0, *[0.0] * 8)
FREE = Costs(
    0.0, *[Spent(0.0, 0.0, 0.0)] * 6, 0.0, 0.0, 0, 0.0, 0.0, 0.0, {"combined": NOTHING}, [[1.0]], [[1.0]]
)  # fmt: skip
PARTS = PartCosts(500, 36, 4, 0, 1e-9, 2e-9, 1e-9, 1e-7, 2e-7, 4e-7, 5e-8, 1e-3)
DEAR = dataclasses.replace(
    FREE,
    submit=Spent(1e-3, 2e-3, 2e-3),
    fetch=Spent(2e-3, 5e-4, 1e-3),
    gather=Spent(2e-4, 5e-5, 2e-4),
    ask=Spent(1e-3, 5e-4, 0.0),
    fetch_seconds_per_byte=1e-9,
    scene_bytes=10_000_000,
    prepare_seconds=1.0,
    pilot_samples=1e5,
    parts={"combined": PARTS},
    cost_map=[[0.5, 1.0], [1.5, 1.0]],
    noise_map=[[0.2, 1.0], [4.0, 1.0]],
)
EQUAL = Assumed(threads=1, spread=0.0, slow_share=0.0, lost_per_second=0.0, bytes_per_second=1e15, latency=0.0)
