"""Bug reports: one .zip with a scene's snapshot and facts about the render, which renders again without Blender.

A report may come from any source: load() returns a snapshot that is safe to render, or raises SnapshotError.
"""

import json
import os
import shutil
import tempfile
import zipfile

from .npz import SnapshotError
from .snapshot import SceneSnapshot

_FACTS, _SNAPSHOT = "report.json", "snapshot.npz"
_CHUNK = 1 << 20


def save(path, facts, snapshot=None, tell=None):
    """Write the report to a temporary file beside path and rename it when it is complete.

    facts: a dict for JSON. snapshot: a SceneSnapshot or None. tell(fraction) is called during the writing.
    """
    folder, name = os.path.split(os.path.abspath(path))
    with tempfile.TemporaryDirectory(prefix=f".{name}.", dir=folder) as place:
        whole = os.path.join(place, name)
        with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
            archive.writestr(_FACTS, json.dumps(facts, indent=2))
            if snapshot is not None:
                inner = os.path.join(place, _SNAPSHOT)
                snapshot.save(inner)
                with open(inner, "rb") as file, archive.open(_SNAPSHOT, "w", force_zip64=True) as packed:
                    _copy(file, packed, os.path.getsize(inner), tell)
        os.replace(whole, path)


def _copy(source, target, size, tell):
    done = 0
    while chunk := source.read(_CHUNK):
        target.write(chunk)
        done += len(chunk)
        if tell is not None:
            tell(done / size)


def load(path):
    """Return (SceneSnapshot, facts) of a report; facts is {} for a plain snapshot. Raise SnapshotError or OSError."""
    path = os.fspath(path)
    if not zipfile.is_zipfile(path):
        with open(path, "rb"):
            raise SnapshotError(f"{path} holds no scene snapshot: it is no .zip or .npz")
    try:
        with zipfile.ZipFile(path) as archive, tempfile.TemporaryDirectory() as folder:
            names = archive.namelist()
            if _FACTS not in names:
                return SceneSnapshot.load(path), {}
            if _SNAPSHOT not in names:
                raise SnapshotError(f"{path} is a report without a scene")
            facts = json.loads(archive.read(_FACTS))
            inner = os.path.join(folder, _SNAPSHOT)
            with archive.open(_SNAPSHOT) as packed, open(inner, "wb") as file:
                shutil.copyfileobj(packed, file)
            return SceneSnapshot.load(inner), facts if isinstance(facts, dict) else {}
    except SnapshotError:
        raise
    except Exception as error:
        # A damaged archive can raise any exception.
        raise SnapshotError(f"{path} holds no scene snapshot: {type(error).__name__}: {error}") from error
