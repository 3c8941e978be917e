"""Adapters: the snapshot of a scene for each of the other renderers.

A module of this folder that renders offers

    check(snapshot)                     raises Cannot where the renderer has no equal for what the scene holds
    version()                           of the renderer, as text; fails where it is not installed
    Renderer(snapshot, threads, option) loads the scene
        .render(samples, seed)          (picture (height, width, 3) linear with row 0 below, seconds, which clock)
"""


class Cannot(Exception):
    """What the adapter cannot express, as the end of a sentence."""
