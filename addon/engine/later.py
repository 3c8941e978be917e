"""Work on a whole snapshot that need not be done before the first picture: it runs while the library renders."""

import contextlib
import dataclasses

from ..bindings.blocks import Sampled
from ..bindings.session import Cancelled
from ..measure.scene_features import used_features
from .quick_check import quick_check

# Bytes of a snapshot that may stay in memory until the first picture is shown.
_MOST_KEPT = 1 << 24
# Bytes of indices, half a vertex, normals and a UV map.
_BYTES_OF_TRIANGLE = 48


class Later:
    """The list of features and the quick checks of a snapshot, and other work by add().

    uses: the features, as dicts; empty until they are listed. tell(messages) gets the findings of the checks.
    """

    def __init__(self, scene, snapshot, is_kept, is_over, tell):
        """is_kept: whether the snapshot stays in memory anyway; else the work of a large one is done at once.

        Raise Cancelled if the user cancels the work.
        """
        self.uses = []
        # The upload takes the records out of the snapshot. Checks read a sample of the texels.
        images = tuple(image.replaced(texels=Sampled(image.texels)) for image in snapshot.images)
        whole = snapshot.replaced(images=images)
        self._work = [lambda: self._look(scene, whole, is_over, tell)]
        if not is_kept and _size(snapshot) > _MOST_KEPT:
            self._run()

    def add(self, work):
        self._work.append(work)

    def run(self):
        """Do all work that is left, unless the user cancels."""
        with contextlib.suppress(Cancelled):
            self._run()

    def _run(self):
        work, self._work = self._work, []
        for step in work:
            step()

    def _look(self, scene, snapshot, is_over, tell):
        self.uses = [dataclasses.asdict(feature) for feature in used_features(snapshot)]
        tell(quick_check(scene, snapshot, is_over))


def _size(snapshot):
    """Return about the bytes of a snapshot's triangles and instances: there may be 100 000 meshes."""
    return sum(len(mesh.triangles) for mesh in snapshot.meshes) * _BYTES_OF_TRIANGLE + snapshot.instances.matrices.nbytes
