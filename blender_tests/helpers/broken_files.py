"""Random corruption of snapshot files: loading raises only SnapshotError, and rendering only LancerError.

    python broken_files.py SEEDS.txt FOLDER FIRST COUNT [SECONDS]

writes each seed into SEEDS.txt before its test, so that after a crash the last seed there is the faulty one. Each seed gives
one corrupted file.
"""

import dataclasses
import io
import json
import os
import random
import sys
import time

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
for folder in (ROOT, HERE):
    if folder not in sys.path:
        sys.path.insert(0, folder)

from rich_snapshot import rich  # noqa: E402

from addon.bindings.abi import load_library  # noqa: E402
from addon.bindings.enums import Pass  # noqa: E402
from addon.bindings.npz import SnapshotError  # noqa: E402
from addon.bindings.session import LancerError, Session  # noqa: E402
from addon.bindings.snapshot import SceneSnapshot  # noqa: E402

# The library under test, or another build of it.
LIBRARY = load_library(os.environ.get("LANCER_LIBRARY"))
NUMBERS = (0, 1, -1, 2, 3, 7, 255, 2**16, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**63, -(2**31), 10**400)
FLOATS = (
    0.0,
    -0.0,
    0.5,
    -1.0,
    1e-45,
    1e-30,
    1e-7,
    1e7,
    1e19,
    1e30,
    3.4e38,
    1e39,
    1e300,
    float("inf"),
    float("-inf"),
    float("nan"),
)
OTHERS = (None, True, "", "text", "a\0b", "\ud800", "x" * 5000, [], [0.5], [1, 2, 3], [[1], [2]], {}, {"array": "array_0"})
OTHERS += (
    {"array": "none"},
    {"type": "Lobe", "fields": {}},
    {"type": "NodeRef", "fields": {"node": 99}},
    {"type": 5, "fields": 5},
)
DTYPES = ("f4", "f8", "u4", "u2", "u1", "i8", "?", "c8", "U3", "M8[s]", ">f4", "S2")
# Limits of inputs that would take long and have tests elsewhere: the sky's map, threads, pixels.
WIDEST_MAP, MOST_THREADS, MOST_PIXELS = 64, 8, 64 * 64


def spoil_bytes(data, chance):
    data = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 10))):
        at = chance.randrange(len(data))
        kind = chance.randrange(4)
        if kind == 0:
            data[at] ^= 1 << chance.randrange(8)
        elif kind == 1:
            data[at : at + chance.randrange(1, 64)] = bytes(chance.randrange(256) for _ in range(chance.randrange(64)))
        elif kind == 2:
            del data[at:]
            data += b"\0"
        else:
            other = chance.randrange(len(data))
            data[at : at + 32] = data[other : other + 32]
    return bytes(data)


def places(tree, found):
    """Return (container, key) of every value in the tree."""
    keys = tree if isinstance(tree, dict) else range(len(tree)) if isinstance(tree, list) else ()
    for key in keys:
        found.append((tree, key))
        places(tree[key], found)
    return found


def spoil_value(value, chance):
    kind = chance.randrange(4)
    if kind == 0 and isinstance(value, (int, float)):
        return chance.choice(FLOATS)
    return chance.choice((NUMBERS, NUMBERS, FLOATS, OTHERS)[kind])


def spoil_tree(tree, chance):
    container, key = chance.choice(places(tree, []))
    kind = chance.randrange(8)
    if kind == 0:
        container.pop(key)
    elif kind == 1 and isinstance(container, dict):
        container[chance.choice(("name", "unknown", "type", "fields", "array"))] = container[key]
    elif kind == 2 and isinstance(container, list):
        container.append(container[key])
    else:
        container[key] = spoil_value(container[key], chance)


def spoil_array(arrays, chance):
    name = chance.choice([name for name in arrays if name != "tree"])
    array = arrays[name]
    kind = chance.randrange(5)
    if kind == 0:
        array = array[: chance.randrange(len(array) + 1)] if array.ndim else array[None]
    elif kind == 1:
        array = array.reshape(chance.choice([(-1,), (1, -1), (-1, 1), (1, 1, 1, -1)]))
    elif kind == 2:
        array = np.zeros(array.shape, chance.choice(DTYPES))
    elif kind == 3:
        array = arrays[chance.choice(list(arrays))]
    elif array.size and array.dtype.kind in "fu":
        array = array.copy()
        for _ in range(chance.choice((1, 3, array.size))):
            at = chance.randrange(array.size)
            value = chance.choice(FLOATS) if array.dtype.kind == "f" else chance.choice(NUMBERS[:11]) % 2**32
            array.reshape(-1)[at] = np.array(value).astype(array.dtype)
    arrays[name] = array


def spoiled(data, seed):
    """Return the file's bytes, corrupted by the seed's random numbers."""
    chance = random.Random(seed)
    if chance.randrange(4) == 0:
        return spoil_bytes(data, chance)
    with np.load(io.BytesIO(data)) as archive:
        arrays = dict(archive)
    tree = json.loads(arrays["tree"].tobytes())
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        if chance.randrange(2):
            spoil_tree(tree, chance)
        else:
            spoil_array(arrays, chance)
    arrays["tree"] = np.frombuffer(json.dumps(tree).encode(), np.uint8)
    out = io.BytesIO()
    with np.errstate(all="ignore"):
        np.savez(out, **arrays)
    return out.getvalue()


def try_file(path):
    """Load and render a file; return "refused file", "refused scene", "session" or "picture"."""
    try:
        with np.errstate(all="ignore"):
            snapshot = SceneSnapshot.load(path)
    except SnapshotError as error:
        assert os.path.basename(path) in str(error)
        return "refused file"
    settings, camera = snapshot.settings, snapshot.camera
    threads = min(settings.threads or 2, MOST_THREADS)
    world = dataclasses.replace(snapshot.world, map_resolution=min(snapshot.world.map_resolution or 16, WIDEST_MAP))
    snapshot = dataclasses.replace(snapshot, settings=dataclasses.replace(settings, threads=threads), world=world)
    try:
        with Session.upload(snapshot, LIBRARY) as session:
            session.messages()
            if camera.region_width * camera.region_height > MOST_PIXELS or settings.max_bounces > 64:
                return "session"
            assert session.render_all(1)
            # The pass ERROR is infinite while the error is unknown.
            assert all(np.isfinite(session.read(which)).all() for which in settings.passes if which != Pass.ERROR)
            return "picture"
    except LancerError as error:
        assert str(error)
        return "refused scene"


def main(log, folder, first, count, seconds=0.0):
    good, path = os.path.join(folder, "good.npz"), os.path.join(folder, "spoiled.npz")
    rich().save(good)
    with open(good, "rb") as file:
        data = file.read()
    outcomes, seed, end = {}, int(first), time.monotonic() + float(seconds)
    while seed < int(first) + int(count) or time.monotonic() < end:
        with open(log, "w", encoding="utf-8") as file:
            file.write(f"{seed}\n")
        with open(path, "wb") as file:
            file.write(spoiled(data, seed))
        outcome = try_file(path)
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
        seed += 1
    with open(log, "w", encoding="utf-8") as file:
        json.dump(outcomes, file)


if __name__ == "__main__":
    main(*sys.argv[1:])
