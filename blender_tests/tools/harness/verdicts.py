"""Goals, each with its measurement in a run: for the terminal, the page and the tables."""

from dataclasses import asdict, dataclass

NOT_MEASURED = "not measured"
_WORDS = {True: ("reached", "yes"), False: ("missed", "no"), None: (NOT_MEASURED, "absent")}


@dataclass(frozen=True)
class Verdict:
    what: str
    goal: str
    measured: str
    reached: bool | None  # None: not measured

    def as_dict(self):
        return asdict(self)


HEAD = ["goal", "asked", "measured", ""]


def words(reached, open_=NOT_MEASURED):
    """Return a cell of a page; open_: the word for None."""
    word, kind = _WORDS[reached]
    return (open_ if reached is None else word), kind


def row(goal):
    """Return the cells of a goal on a page; goal: as_dict of a Verdict."""
    return [goal["what"], goal["goal"], goal["measured"], words(goal["reached"])]


def plain_row(goal):
    """Return the cells of a goal in a table of Markdown."""
    return [*row(goal)[:3], words(goal["reached"], "")[0]]


def tell(goals):
    for goal in goals:
        what, asked, measured, state = plain_row(goal)
        print(f"{state:8} {what}: {measured} (asked: {asked})")
