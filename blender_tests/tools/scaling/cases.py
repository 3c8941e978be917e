"""The stills that are simulated, and the networks between the machines."""

from typing import NamedTuple

from .measure import COMBINED, DENOISED
from .simulate import Case

WORKERS = (1, 2, 5, 10, 20, 60, 100, 200, 500, 1000)
QUICK_WORKERS = (1, 10, 60, 200)
GIGABIT = 125e6  # bytes per second


class Still(NamedTuple):
    letter: str
    name: str
    case: Case
    gigabits: int  # of each machine's link, per second


def _still(letter, width, height, samples, passes, gigabits, with_target=False):
    kind = "with passes for denoising" if passes == DENOISED else "Combined alone"
    ends = f"to the error of {samples} samples" if with_target else f"{samples} samples"
    name = f"{width} x {height}, {ends}, {kind}, {gigabits} Gbit/s"
    return Still(letter, name, Case(width, height, samples, passes, with_target), gigabits)


HD, UHD = (1920, 1080), (3840, 2160)
STILLS = (
    _still("A", *HD, 256, COMBINED, 10),
    _still("B", *HD, 4096, DENOISED, 1),
    _still("C", *HD, 1024, COMBINED, 10, with_target=True),
    _still("D", *UHD, 256, COMBINED, 10),
    _still("E", *UHD, 1024, DENOISED, 1),
    _still("F", *UHD, 256, DENOISED, 1, with_target=True),
)
BY_LETTER = {still.letter: still for still in STILLS}
# The stills of a short run.
QUICK = ("A", "E")
