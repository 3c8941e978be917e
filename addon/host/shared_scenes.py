"""The library's scenes of this process, so that views and renders of one scene share its objects."""

import threading
import weakref

from ..bindings.abi import load_library
from ..bindings.enums import ObjectKind
from ..bindings.stock import Stock

stock = Stock()


class Ahead:
    """Meshes that the library gets while the export still reads others: it builds their trees meanwhile.

    threads: the most that build a tree; 0 = all.
    """

    def __init__(self, threads):
        self._threads = threads
        # Finding the library reads folders, which takes as long as a small mesh.
        self._library = load_library()
        self._parts = []
        self._made = []

    def mesh(self, record):
        part, made = stock.part(self._library, ObjectKind.MESH, record, threads=self._threads)
        (self._made if made else self._parts).append(part)

    def end(self):
        """Let the records go, once a scene has the objects."""
        for part in self._made:
            part.record = None
        self._parts, self._made = [], []


_committed = weakref.WeakSet()
_lock = threading.Lock()  # the render thread and the main thread add and look for scenes


def remember(scene):
    """Let later scenes take over parts of this committed Scene, as long as it is open."""
    with _lock:
        _committed.add(scene)


def nearest(snapshot):
    """Return an open Scene that may differ little from the snapshot; None if there is none."""
    with _lock:
        scenes = list(_committed)
    found = {scene: scene.likeness(snapshot) for scene in scenes if scene.is_open}
    best = max(found, key=found.get, default=None)
    return best if best is not None and found[best] > 0 else None
