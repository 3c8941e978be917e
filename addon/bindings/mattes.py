"""Cryptomatte: the ids of names, and the manifests by which compositors find the names again. No bpy.

An id is the MurmurHash3 of the name in UTF-8, with the bits of a float that is neither subnormal nor infinite nor NaN, as the
specification of Cryptomatte 1.0 asks.
"""

import json

import numpy as np

from .enums import PassKind
from .numbered_pass import MATTES, NumberedPass
from .pass_names import CRYPTOMATTES as TITLES

# As Cycles names the surface of objects without a material.
DEFAULT_SURFACE = "default_surface"
_MANTISSA, _SIGN = np.uint32(0x7FFFFF), np.uint32(0x80000000)


def hashes(names):
    """Return the MurmurHash3 (32 bits, seed 0) of each name in UTF-8 as uint32; names of one length are hashed at once."""
    encoded = [name.encode("utf-8", "surrogatepass") for name in names]
    found = np.zeros(len(encoded), np.uint32)
    lengths = np.array([len(text) for text in encoded], np.int64)
    for length in np.unique(lengths):
        rows = np.flatnonzero(lengths == length)
        block = b"".join(encoded[row] for row in rows.tolist())
        found[rows] = _hash(np.frombuffer(block, np.uint8).reshape(len(rows), int(length)))
    return found


def _hash(rows):
    """Return the hashes of rows of bytes. Products of uint32 arrays are modulo 2^32."""
    count, length = rows.shape
    padded = np.zeros((count, (length + 3) // 4 * 4), np.uint8)
    padded[:, :length] = rows
    words = padded.view("<u4")
    state = np.zeros(count, np.uint32)
    for word in range(words.shape[1]):
        state ^= _turned(words[:, word] * np.uint32(0xCC9E2D51), 15) * np.uint32(0x1B873593)
        # The bytes behind the last whole word end without these steps.
        if 4 * word + 4 <= length:
            state = _turned(state, 13) * np.uint32(5) + np.uint32(0xE6546B64)
    state ^= np.uint32(length)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        state = (state ^ state >> np.uint32(shift)) * np.uint32(factor)
    return state ^ state >> np.uint32(16)


def _turned(values, bits):
    return values << np.uint32(bits) | values >> np.uint32(32 - bits)


def ids(names):
    """Return the id of each name as the bits of its float, uint32."""
    hashed = hashes(names)
    exponents = np.clip(hashed >> np.uint32(23) & np.uint32(0xFF), 1, 254).astype(np.uint32)
    return hashed & _SIGN | exponents << np.uint32(23) | hashed & _MANTISSA


def manifest(names):
    """Return the manifest of names as JSON: the hash of each, in hexadecimal."""
    names = list(dict.fromkeys(names))
    pairs = zip(names, hashes(names).tolist(), strict=True)
    return "{" + ",".join(f'{json.dumps(name, ensure_ascii=False)}:"{key:08x}"' for name, key in pairs) + "}"


def metadata(view_layer, snapshot, passes):
    """Return the fields of a file's metadata, by name, that describe the mattes among the passes. view_layer: its name."""
    names = {
        PassKind.OBJECT_MATTES: snapshot.instances.names,
        PassKind.MATERIAL_MATTES: [material.name for material in snapshot.materials],
        PassKind.ASSET_MATTES: snapshot.instances.asset_names,
    }
    fields = {}
    for kind in MATTES:
        if NumberedPass(kind) not in passes:
            continue
        layer = f"{view_layer}.{TITLES[kind]}"
        # Readers look for seven digits.
        prefix = f"cryptomatte/{int(hashes([layer])[0]):08x}"[:-1]
        fields[f"{prefix}/name"] = layer
        fields[f"{prefix}/hash"] = "MurmurHash3_32"
        fields[f"{prefix}/conversion"] = "uint32_to_float32"
        fields[f"{prefix}/manifest"] = manifest(names[kind])
    return fields
