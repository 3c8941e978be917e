"""Trees of registered dataclasses to and from one .npz without pickle: the arrays as they are, the rest as JSON beside them."""

import dataclasses
import json
import os

import numpy as np

_TYPES = {}
_TREE = "tree"


def register(cls):
    """Class decorator: this dataclass may be saved and loaded."""
    _TYPES[cls.__name__] = cls
    return cls


def save_npz(record, path):
    arrays = {}

    def encode(value):
        if isinstance(value, np.ndarray):
            key = f"array_{len(arrays)}"
            arrays[key] = value
            return {"array": key}
        if dataclasses.is_dataclass(value):
            fields = {f.name: encode(getattr(value, f.name)) for f in dataclasses.fields(value)}
            return {"type": type(value).__name__, "fields": fields}
        if isinstance(value, tuple):
            return [encode(item) for item in value]
        if isinstance(value, np.generic):
            return value.item()
        return value

    tree = json.dumps(encode(record)).encode("utf-8")
    with open(os.fspath(path), "wb") as file:
        np.savez(file, **{_TREE: np.frombuffer(tree, np.uint8)}, **arrays)


def load_npz(path):
    with np.load(os.fspath(path), allow_pickle=False) as archive:
        if _TREE not in archive:
            raise ValueError(f"{path} holds no scene snapshot")

        def decode(value):
            if isinstance(value, list):
                return tuple(decode(item) for item in value)
            if isinstance(value, dict):
                if "array" in value:
                    return archive[value["array"]]
                fields = {name: decode(item) for name, item in value["fields"].items()}
                return _TYPES[value["type"]](**fields)
            return value

        return decode(json.loads(bytes(archive[_TREE]).decode("utf-8")))
