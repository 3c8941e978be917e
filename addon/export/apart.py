"""Per-object values of the Object Info node: a colour and a random number for each object, equal to those of Cycles."""

import numpy as np

from .hashes import WORD, hash_of, unit


def random_of_name(name):
    """Return the 32-bit random number of an object that is not an instance: a hash of its name."""
    letters = 0
    for byte in name.encode("utf-8", "replace"):
        letters = (37 * letters + (byte if byte < 128 else byte - 256)) & WORD
    return hash_of(letters, 0)


def info_of(entry):
    """Return (colour, alpha, random number) of an entry of the depsgraph."""
    # An instance has the colour of its instancer.
    shown = entry.parent if entry.is_instance else entry.object
    number = entry.random_id & WORD if entry.is_instance else random_of_name(shown.name)
    return (*shown.color, float(unit(number)))


def read_infos(walk, entries, poll_every, poll):
    """Return (rows, 5): colour, alpha and random number of the entries of a walk whose indices are in entries."""
    wanted, infos, row = set(entries.tolist()), np.empty((len(entries), 5), np.float32), 0
    for number, entry in enumerate(walk):
        if number % poll_every == 0:
            poll()
        if number not in wanted:
            continue
        infos[row] = info_of(entry)
        row += 1
    return infos
