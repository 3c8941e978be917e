"""Renders that continue from a file beside the output: what was rendered survives Esc, a crash, and the end of Blender."""

from pathlib import Path
from urllib.parse import quote

import numpy as np

from ..bindings.abi import LancerError
from ..bindings.digest import scene_digest
from ..measure.schedule import TimeShare
from ..messages.messages import Messages
from ..messages.severity import Severity
from . import resume_file

# Share of the time for writing the file, and least seconds between two writings.
_SHARE, _EVERY = 0.03, 10.0


def wanted(scene, layer):
    """Return the Resume of a view layer by its scene's settings; None if its samples are not kept, or rendered elsewhere."""
    own = scene.lancer
    return Resume(path_of(scene, layer)) if own.use_resume and not own.use_many_machines else None


def path_of(scene, layer, frame=None):
    """Return the path of the file of a view layer, by default of the scene's frame: the picture's, with another ending.

    Raise LancerError if the output path has a fault.
    """
    try:
        picture = Path(scene.render.frame_path(frame=scene.frame_current if frame is None else frame))
    except RuntimeError:
        # Since 5.0 paths have variables.
        raise LancerError(f"Resume is on, but the output path '{scene.render.filepath}' has a fault") from None
    return picture.with_name(f"{picture.stem}.{quote(layer, safe=' ')}{resume_file.ENDING}")


def digest_of(snapshot):
    """Return the digest of a snapshot's scene without normals that follow from the faces.

    Blender 5.0 sums them in any order: their last bits differ from export to export.
    """

    def plain(mesh):
        return mesh.replaced(normals=np.zeros(0)) if mesh.normals is not None and mesh.normals.ndim == 2 else mesh

    return scene_digest(snapshot.replaced(meshes=tuple(map(plain, snapshot.meshes))))


class Resume:
    """The file of one view layer's render: load() its samples into a SteppedSession, then follow() its Schedule."""

    def __init__(self, path):
        self._path = path
        self._session = self._schedule = self._loaded = None
        self._writing = TimeShare(_SHARE, _EVERY)
        self._failure = ""

    @property
    def is_continued(self):
        """Whether the session has samples of the file."""
        return self._loaded is not None

    def load(self, session):
        """Add the samples of the file, if there is one, to a session; return Messages about it."""
        self._session = session
        try:
            found = resume_file.read(self._path)
            if found is None:
                return Messages()
            facts, ranges, part = found
            session.add(part)
        except (LancerError, OSError) as error:
            why = str(error).removeprefix("part: ")
            return Messages([f"resume file '{self._path.name}': {why}; the picture is rendered anew"])
        session.seconds_before = facts["seconds"]
        self._loaded = facts, ranges
        text = f"resume file '{self._path.name}': the picture continues from {facts['mean']:.4g} samples per pixel"
        return Messages([text], Severity.HINT)

    def follow(self, schedule):
        """Let a schedule continue where the file ends, and write the file now and then from here on."""
        self._schedule = schedule
        if self._loaded is not None:
            schedule.continue_from(*self._loaded)
        # The first file is due after some seconds.
        self._writing.spend(lambda: None)
        self._session.between = self._write_if_due

    def finish(self):
        """Write the file once more at the end of the render; return Messages about files that could not be written."""
        # Write no file of a part of a step, and none again that is there.
        if self._session.is_whole and self._session.statistics().samples > 0:
            self._write()
        return Messages([self._failure] if self._failure else [], Severity.WASTE)

    def _write_if_due(self):
        if self._writing.due and self._session.statistics().samples > 0:
            self._writing.spend(self._write)

    def _write(self):
        session, rest = self._session, self._session.rest
        statistics = session.statistics()
        facts = {
            **self._schedule.state(len(rest) > 0),
            "seconds": float(statistics.render_seconds),
            "mean": statistics.samples / self._schedule.pixels,
        }
        try:
            resume_file.write(self._path, facts, rest, session.export())
        except OSError as error:
            self._failure = f"resume file '{self._path}' cannot be written: {error.strerror}"
