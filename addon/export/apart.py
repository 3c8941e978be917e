"""Per-object values of the Object Info node: a colour and a random number for each object, equal to those of Cycles."""

import numpy as np

_WORD = 0xFFFFFFFF
# Final mix of Bob Jenkins' lookup3: the word that changes, the word mixed into it, and that word's rotation in bits.
_MIXING = ((2, 1, 14), (0, 2, 11), (1, 0, 25), (2, 1, 16), (0, 2, 4), (1, 0, 14), (2, 1, 24))


def random_of_name(name):
    """Return the 32-bit random number of an object that is not an instance: a hash of its name."""
    letters = 0
    for byte in name.encode("utf-8", "replace"):
        letters = (37 * letters + (byte if byte < 128 else byte - 256)) & _WORD
    words = [0xDEADBEEF + 4 * 2 + 13] * 3
    words[0] += letters
    for to, other, turn in _MIXING:
        turned = (words[other] << turn | (words[other] & _WORD) >> (32 - turn)) & _WORD
        words[to] = ((words[to] ^ words[other]) - turned) & _WORD
    return words[2]


def read_infos(walk, entries, poll_every, poll):
    """Return (rows, 5): colour, alpha and random number of the entries of a walk whose indices are in entries."""
    wanted, infos, row = set(entries.tolist()), np.empty((len(entries), 5), np.float32), 0
    for number, entry in enumerate(walk):
        if number % poll_every == 0:
            poll()
        if number not in wanted:
            continue
        # An instance has the colour of its instancer.
        shown = entry.parent if entry.is_instance else entry.object
        infos[row, :4] = shown.color
        infos[row, 4] = np.float32((entry.random_id if entry.is_instance else random_of_name(shown.name)) & _WORD)
        row += 1
    infos[:, 4] *= np.float32(2.0**-32)
    return infos
