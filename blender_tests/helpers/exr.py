"""Reader of Blender's OpenEXR files without compression: all layers and passes, exactly as stored."""

import struct

import numpy as np

_MULTIPART = 0x1000
_TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
# The file sorts a pass's channels by name; read() returns them in this order.
_ORDER = "RGBAXYZWUVrgba"


def write_settings(scene, path):
    """Let the next render write such a file to path."""
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format = "OPEN_EXR_MULTILAYER"
    image.color_mode, image.color_depth, image.exr_codec = "RGBA", "32", "NONE"
    scene.render.filepath = path


def read(path, layer=None):
    """Return {pass name: array (height, width, channels)} of a view layer, by default the first; row 0 is the top row."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version = struct.unpack_from("<ii", data)
    if magic != 20000630:
        raise ValueError(f"{path}: not an OpenEXR file")
    parts, at = _headers(data, bool(version & _MULTIPART))
    chunks = 0
    for part in parts:
        x0, y0, x1, y1 = struct.unpack("<4i", part["dataWindow"])
        if part["compression"] != b"\0":
            raise ValueError(f"{path}: compressed")
        part["width"], part["height"], part["y0"] = x1 - x0 + 1, y1 - y0 + 1, y0
        part["list"] = _channels(part["channels"])
        part["planes"] = {name: np.empty((part["height"], part["width"]), kind) for name, kind in part["list"]}
        chunks += part["height"]
    at += 8 * chunks
    # One chunk is one row of one part.
    for _ in range(chunks):
        number = 0
        if version & _MULTIPART:
            (number,) = struct.unpack_from("<i", data, at)
            at += 4
        y, size = struct.unpack_from("<ii", data, at)
        at += 8
        part, begin = parts[number], at
        for name, kind in part["list"]:
            part["planes"][name][y - part["y0"]] = np.frombuffer(data, kind, part["width"], begin)
            begin += part["width"] * kind.itemsize
        at += size
    return _passes(parts, layer)


def attributes(path):
    """Return the texts of the file's first header, by name."""
    with open(path, "rb") as file:
        data = file.read()
    _, version = struct.unpack_from("<ii", data)
    header = _headers(data, bool(version & _MULTIPART))[0][0]
    texts = {}
    for name, value in header.items():
        try:
            texts[name] = value.decode()
        except UnicodeDecodeError:
            continue
    return texts


def _headers(data, multipart):
    parts, at = [], 8
    while True:
        part = {}
        while data[at]:
            name, at = _text(data, at)
            _, at = _text(data, at)
            (size,) = struct.unpack_from("<i", data, at)
            part[name] = data[at + 4 : at + 4 + size]
            at += 4 + size
        at += 1
        if part:
            parts.append(part)
        if not multipart or not part:
            return parts, at


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _channels(data):
    result, at = [], 0
    while data[at]:
        name, at = _text(data, at)
        result.append((name, _TYPES[struct.unpack_from("<i", data, at)[0]]))
        at += 16
    return result


def _passes(parts, layer):
    """Group channels by pass. Their names are LAYER.PASS.CHANNEL, in some files with LAYER.PASS as the name of the part.

    With stereoscopy the view is the end of a pass's name, also where the part has it as an attribute.
    """
    groups = {}
    for part in parts:
        prefix = part.get("name", b"").decode()
        for name, plane in part["planes"].items():
            words = name.split(".") if "." in name else [*prefix.split("."), name]
            view = part.get("view", b"").decode()
            if view and view not in words[:-1]:
                words.insert(-1, view)
            if layer is not None and words[0] != layer:
                continue
            if len(words) >= 3 or words[0] != "Composite":
                groups.setdefault(".".join(words[1:-1]) or words[0], {}).setdefault(words[-1], plane)
    return {
        name: np.stack([planes[c] for c in sorted(planes, key=lambda c: _ORDER.find(c[0]))], axis=-1)
        for name, planes in groups.items()
    }
