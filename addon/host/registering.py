"""Registration of all items or none, and of handlers."""

import contextlib

import bpy


def add_all(things, add, remove):
    """Add all things in order. If one fails, remove those before it and raise its error."""
    with contextlib.ExitStack() as added:
        for thing in things:
            add(thing)
            added.callback(remove, thing)
        added.pop_all()


def add_handlers(handlers):
    """Add Blender's handlers, given as pairs of a list's name and a function."""
    for name, handler in handlers:
        getattr(bpy.app.handlers, name).append(handler)


def remove_handlers(handlers):
    """Remove the handlers that are there: scripts may have cleared a list."""
    for name, handler in handlers:
        known = getattr(bpy.app.handlers, name)
        if handler in known:
            known.remove(handler)
