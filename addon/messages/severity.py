"""Severity of messages and findings: the harm to the picture."""

from enum import IntEnum


class Severity(IntEnum):
    """Rising severity; the highest is reported first."""

    HINT = 0  # no fault, or possibly intended: shown in panels, without a warning after the render
    WASTE = 1  # costs time, or light behaves differently from what the setting suggests
    DIFFERENT = 2  # differs from Cycles
    LEFT_OUT = 3  # a part of the scene is missing in the picture
    WRONG = 4  # the picture shows a fault
    FAILED = 5  # there is no picture
