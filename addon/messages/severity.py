"""How much something that is told hurts the picture."""

from enum import IntEnum


class Severity(IntEnum):
    """In rising order: what hurts most is told first."""

    HINT = 0  # no fault, or one that may be meant so: panels show it, and no render warns of it
    WASTE = 1  # costs time, or light does not do what the setting promises
    DIFFERENT = 2  # shown otherwise than Cycles shows it
    LEFT_OUT = 3  # a thing of the scene is not in the picture
    WRONG = 4  # the picture shows a fault
    FAILED = 5  # there is no picture
