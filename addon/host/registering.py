"""Things given to Blender all or none."""

import contextlib


def add_all(things, add, remove):
    """Adds one after the other. Where one fails, those before it are removed again, and its error is raised."""
    with contextlib.ExitStack() as added:
        for thing in things:
            add(thing)
            added.callback(remove, thing)
        added.pop_all()
