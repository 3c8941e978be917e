"""Measure competitors by turns, so that a slow minute of the machine affects all; figures are medians over the rounds."""

import statistics


def by_turns(rounds, competitors, measure):
    """Return {competitor: [measure(competitor, number of the round)]}; each is measured once per round."""
    found = {competitor: [] for competitor in competitors}
    for number in range(rounds):
        for competitor, answers in found.items():
            answers.append(measure(competitor, number))
    return found


def middle(values):
    """Return the median, smallest and largest value."""
    values = list(values)
    return {"median": statistics.median(values), "min": min(values), "max": max(values)}


def middles(answers, names=None):
    """Return {name: median, smallest, largest} of the named numbers, or all, in several answers of one kind."""
    names = names or [name for name, value in answers[0].items() if isinstance(value, (int, float))]
    return {name: middle(answer[name] for answer in answers) for name in names}


def ratio(ours, theirs):
    """Return the median, smallest and largest of ours over theirs, round by round."""
    return middle(a / b for a, b in zip(ours, theirs, strict=True))
