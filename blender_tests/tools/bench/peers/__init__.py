"""Adapters: the snapshot of a scene for each of the other renderers.

Each module of this folder that renders has

    check(snapshot)                     raises Cannot if the renderer has no equivalent of a feature of the scene
    version()                           returns the renderer's version as text; fails if it is not installed
    Renderer(snapshot, threads, option) loads the scene
        .render(samples, seed)          returns (linear picture (height, width, 3), row 0 at the bottom; seconds; which clock)
"""


class Cannot(Exception):
    """The feature that the adapter cannot express, as the end of a sentence."""
