"""Results that are kept: a run that was broken off goes on where it ended, and converged pictures serve every run."""

import json

import numpy as np


def kept(path, key, measure):
    """What measure() gives, or gave in an earlier run with the same key."""
    if path.exists():
        found = json.loads(path.read_text())
        if found["key"] == key:
            return found["result"]
    result = measure()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"key": key, "result": result}))
    return result


def kept_picture(path, render):
    """The array in a file, or what render() gives: the array, or None where it has written it to the path that it is given."""
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        # A render that is broken off leaves no reference.
        unfinished = path.with_suffix(".part.npy")
        picture = render(unfinished)
        if picture is not None:
            np.save(unfinished, picture)
        unfinished.rename(path)
    return np.load(path)
