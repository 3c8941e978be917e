"""How long each room of the tests took, and the tests over the budget of their room. Reported, never judged."""

import collections

# Seconds that one test may take, on a machine with nothing else to do.
BUDGETS = {"physics": 5, "abi": 5, "farm": 12, "blender": 12, "tools": 12}


class RoomTimes:
    """A pytest plugin; with several workers, that of the process which collects their reports."""

    def __init__(self):
        self.seconds = collections.Counter()

    def pytest_runtest_logreport(self, report):
        self.seconds[report.nodeid] += report.duration

    def pytest_terminal_summary(self, terminalreporter):
        rooms, late = summary(self.seconds)
        if self.seconds:
            terminalreporter.write_line("seconds of tests: " + ", ".join(f"{room} {took:.0f}" for room, took in rooms.items()))
        for test, took in late:
            terminalreporter.write_line(f"over its room's budget of {BUDGETS[room_of(test)]} s: {test} took {took:.1f} s")


def room_of(test):
    return test.partition("blender_tests/")[2].partition("/")[0]


def summary(seconds):
    """({room: seconds}, [(test, seconds) over the budget, the slowest first])."""
    rooms = collections.Counter()
    for test, took in seconds.items():
        rooms[room_of(test)] += took
    late = [(test, took) for test, took in seconds.items() if took > BUDGETS.get(room_of(test), took)]
    return dict(rooms.most_common()), sorted(late, key=lambda item: -item[1])
