"""Registration of all items or none."""

import contextlib


def add_all(things, add, remove):
    """Add all things in order. If one fails, remove those before it and raise its error."""
    with contextlib.ExitStack() as added:
        for thing in things:
            add(thing)
            added.callback(remove, thing)
        added.pop_all()
