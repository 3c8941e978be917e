"""Cryptomatte as compositors read it: the mattes of a file by the names of its manifest."""

import numpy as np

_FIELDS = ("name", "hash", "conversion", "manifest")


def fields(attributes, layer):
    """Return the fields of one of the metadata's cryptomattes, by the layer that its field name tells."""
    for key, value in attributes.items():
        if key.startswith("cryptomatte/") and key.endswith("/name") and value == layer:
            start = key[: -len("name")]
            return {name: attributes[start + name] for name in _FIELDS}
    raise KeyError(layer)


def mattes(pictures, title, manifest):
    """Return {name: matte (height, width)}. title: of the passes, such as CryptoObject; manifest: {name: id in hexadecimal}."""
    ranks = [pictures[name] for name in sorted(pictures) if name.startswith(title)]
    found = {}
    for name, key in manifest.items():
        matte = np.zeros(ranks[0].shape[:2])
        for rank in ranks:
            for pair in (0, 2):
                ids = np.ascontiguousarray(rank[..., pair]).view(np.uint32)
                matte += np.where(ids == int(key, 16), rank[..., pair + 1], 0.0)
        found[name] = matte
    return found
