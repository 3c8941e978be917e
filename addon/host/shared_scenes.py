"""The library's scenes of this process, so that views and renders of one scene share its objects."""

import weakref

from ..bindings.abi import load_library
from ..bindings.enums import ObjectKind
from ..bindings.stock import Stock

stock = Stock(prepares=True)


class Ahead:
    """Meshes that the library gets while the export still reads others: it builds their trees meanwhile."""

    def __init__(self):
        self._parts = []
        self._made = []

    def mesh(self, record):
        part, made = stock.part(load_library(), ObjectKind.MESH, record)
        (self._made if made else self._parts).append(part)

    def end(self):
        """Let the records go, once a scene has the objects."""
        for part in self._made:
            part.record = None
        self._parts, self._made = [], []


_committed = weakref.WeakSet()


def remember(scene):
    """Let later scenes take over parts of this committed Scene, as long as it is open."""
    _committed.add(scene)


def nearest(snapshot):
    """Return an open Scene that may differ little from the snapshot; None if there is none."""

    def likeness(scene):
        return scene.likeness(snapshot)

    return max((scene for scene in list(_committed) if scene.is_open and likeness(scene) > 0), key=likeness, default=None)
