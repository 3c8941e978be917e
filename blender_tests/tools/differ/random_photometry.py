"""Random photometric files for the IES Texture."""

from .record import Record

# Horizontal angles that the files of a type may have: of a circle, a half, a quadrant or one alone, of both sides or one.
_ROUND = ([0, 90, 180, 270, 360], [0, 60, 180], [0, 30, 90], [0], [90, 180, 270], [0, 120, 240])
_SIDES = ([0, 30, 90], [-90, 0, 40, 90])
_DOWN = ([0, 30, 60, 90], [0, 45, 120, 180], [90, 120, 180], [0, 90])


def luminaire(dice, number):
    """The record of a file of type C, B or A; of a strength near 1."""
    kind = dice.pick({1: 4, 2: 1, 3: 1})
    across = dice.pick(_ROUND if kind == 1 else _SIDES)
    down = dice.pick(_DOWN if kind == 1 else _SIDES)
    values = [[dice.whole(0, 40) for _ in down] for _ in across]
    return Record("photometry", f"Luminaire {number}", {"type": kind, "across": across, "down": down, "values": values})
