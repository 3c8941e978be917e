"""Hashes by which Cycles makes random numbers of whole numbers: Bob Jenkins' lookup3 of one to three words."""

import numpy as np

WORD = 0xFFFFFFFF
# The final mix: the word that changes, the word mixed into it, and that word's rotation in bits.
_MIXING = ((2, 1, 14), (0, 2, 11), (1, 0, 25), (2, 1, 16), (0, 2, 4), (1, 0, 14), (2, 1, 24))


def hash_of(*words):
    """Return the 32-bit hash of whole numbers, or of arrays of them (int64)."""
    state = [0xDEADBEEF + 4 * len(words) + 13] * 3
    for i, word in enumerate(words):
        state[i] = state[i] + word
    for to, other, turn in _MIXING:
        turned = (state[other] << turn | (state[other] & WORD) >> (32 - turn)) & WORD
        state[to] = ((state[to] ^ state[other]) - turned) & WORD
    return state[2]


def unit(hashes):
    """Return hashes as numbers from 0 to 1 in single precision."""
    return np.asarray(hashes).astype(np.float32) * np.float32(2.0**-32)
