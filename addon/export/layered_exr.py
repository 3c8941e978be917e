"""OpenEXR files of several layers, as files of the few channels that an image shows, which Blender gives to scripts.

Blender reads such a file into a render result, whose pixels scripts cannot read. The file's blocks of pixels do not depend on
the names of channels: a copy of the first part under the names A, B, G, R, in the order of the file, is a plain picture.
"""

import struct
from typing import NamedTuple

_MAGIC = struct.pack("<i", 20000630)
_LARGEST_HEADER = 1 << 20
_TILED, _LONG_NAMES, _DEEP, _PARTS = 0x200, 0x400, 0x800, 0x1000
_KEPT = (
    "channels", "compression", "dataWindow", "displayWindow", "lineOrder", "pixelAspectRatio", "screenWindowCenter",
    "screenWindowWidth", "tiles",
)  # fmt: skip
_LAST_WITHOUT_NAMES = 7  # of the compressions: later ones choose a method by the names of channels
# OpenImageIO's order of the channels of a layer; a layer with X and Y or Z has another one.
_SHADES = "r red g green b blue y real imag a alpha ar ra ag ga ab ba z depth zback".split()
_AXES = "r red g green b blue x y z real imag a alpha ar ra ag ga ab ba depth zback".split()
# Names by number of channels, in alphabetical order, as Blender reads them into the columns red, green, blue and alpha.
_NAMES = {1: ("Y",), 2: ("A", "Y"), 3: ("B", "G", "R"), 4: ("A", "B", "G", "R")}
_COLUMNS = {"R": 0, "Y": 0, "G": 1, "B": 2, "A": 3}


class Plain(NamedTuple):
    data: bytes  # of the file
    columns: tuple  # of Blender's four: the channels in the order in which they are shown


def has_layers(path):
    """Whether a file has several parts or named layers. Blender need not read it, which may crash with a damaged one."""
    with open(path, "rb") as file:
        start = file.read(8)
        if start[:4] != _MAGIC:
            return False
        data = start + file.read(_LARGEST_HEADER)
    try:
        parts, _ = _headers(data, struct.unpack_from("<i", data, 4)[0] & _PARTS)
        return len(parts) > 1 or "multiView" in parts[0] or any("." in name for name, _ in _channels(parts[0]["channels"][1]))
    except (IndexError, KeyError, ValueError, struct.error):
        return False


def shown_by_cycles(data):
    """Return the Plain of the channels that Cycles reads from a file: the first four of the first part, in its own order."""
    return _plain(data, lambda names, _: _in_order(names)[:4])


def combined_pass(data):
    """Return the Plain of the first layer's pass Combined, or of its only pass: what a packed file shows."""
    return _plain(data, _of_first_pass)


def _plain(data, choose):
    """Return the Plain of the channels whose numbers choose(names, count of parts) returns, up to four of the first part.

    Raise ValueError if the file cannot be read in this way.
    """
    try:
        return _rewritten(data, choose)
    except (IndexError, KeyError, UnicodeDecodeError, struct.error) as error:
        raise ValueError("not a valid OpenEXR file") from error


def _rewritten(data, choose):
    if data[:4] != _MAGIC:
        raise ValueError("not an OpenEXR file")
    (flags,) = struct.unpack_from("<i", data, 4)
    parts, at = _headers(data, flags & _PARTS)
    part = parts[0]
    kind = part.get("type", (b"", b"tiledimage" if flags & _TILED else b"scanlineimage"))[1]
    if flags & _DEEP or kind not in (b"scanlineimage", b"tiledimage"):
        raise ValueError("deep pixels")
    channels = _channels(part["channels"][1])
    names = [name for name, _ in channels]
    wanted = choose(names, len(parts))
    chosen, order = sorted(wanted), {}
    for number, name in zip(chosen, _NAMES[len(chosen)], strict=True):
        order[number] = name
    renamed = _renamed(len(names), order)
    depends_on_names = part["compression"][1][0] > _LAST_WITHOUT_NAMES
    if depends_on_names and [name.rpartition(".")[2] for name in names] != renamed:
        raise ValueError("compressed by the names of its channels")
    listed = b"".join(name.encode() + b"\0" + rest for name, (_, rest) in zip(renamed, channels, strict=True)) + b"\0"
    part["channels"] = part["channels"][0], listed
    head = _MAGIC + struct.pack("<i", 2 | (_TILED if kind == b"tiledimage" else 0) | _LONG_NAMES)
    head += b"".join(
        name.encode() + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
        for name, (kind, value) in part.items()
        if name in _KEPT
    )
    blocks = list(_blocks(data, part, at, kind, flags & _PARTS))
    return Plain(_joined(head + b"\0", blocks), tuple(_COLUMNS[order[number]] for number in wanted))


def _headers(data, has_parts):
    """Return ([{name: (type, value)} of each part], the place behind the headers)."""
    parts, at = [], 8
    while True:
        part = {}
        while data[at]:
            name, at = _text(data, at)
            kind, at = _text(data, at)
            (size,) = struct.unpack_from("<i", data, at)
            part[name.decode()] = kind, data[at + 4 : at + 4 + size]
            at += 4 + size
        at += 1
        if part:
            parts.append(part)
        if not part or not has_parts:
            return parts, at


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end], end + 1


def _channels(value):
    """Return [(name, the 16 bytes that describe it)]."""
    channels, at = [], 0
    while value[at]:
        name, at = _text(value, at)
        if struct.unpack_from("<ii", value, at + 8) != (1, 1):
            raise ValueError("channels with fewer samples")
        channels.append((name.decode(), value[at : at + 16]))
        at += 16
    return channels


def _renamed(count, order):
    """Return names in alphabetical order, those in order by number, and others that Blender does not read."""
    names, last = [], ""
    for number in range(count):
        last = order.get(number, last)
        names.append(last if number in order else f"{last}{number:05}")
    return names


def _blocks(data, part, at, kind, has_parts):
    """Yield the bytes of each block of pixels of the first part, whose table of places is at `at`."""
    if "chunkCount" in part:
        (count,) = struct.unpack("<i", part["chunkCount"][1])
        places = struct.unpack_from(f"<{count}q", data, at)
    else:
        places = _places(data, at)
    numbers = 4 if kind == b"tiledimage" else 1
    for place in places:
        place += 4 if has_parts else 0
        (size,) = struct.unpack_from("<i", data, place + 4 * numbers)
        end = place + 4 * numbers + 4 + size
        if place < at or size < 0 or end > len(data):
            raise ValueError("incomplete")
        yield data[place:end]


def _places(data, at):
    """Return the table of places, which ends at the first block."""
    places, end = [], len(data)
    while at + 8 * len(places) < end:
        (place,) = struct.unpack_from("<q", data, at + 8 * len(places))
        places.append(place)
        end = min(end, place)
    return places


def _joined(head, blocks):
    at, places = len(head) + 8 * len(blocks), []
    for block in blocks:
        places.append(at)
        at += len(block)
    return head + struct.pack(f"<{len(places)}q", *places) + b"".join(blocks)


def _in_order(names):
    """Return the numbers of the channels in OpenImageIO's order: layer after layer, colours before others."""
    layers = {}
    for number, name in enumerate(names):
        layer, _, shade = name.rpartition(".")
        layers.setdefault(layer, []).append((shade.lower(), number))
    found = []
    for _, channels in sorted(layers.items()):
        shades = {shade for shade, _ in channels}
        first = _AXES if "x" in shades and shades & {"y", "z"} else _SHADES
        channels.sort(key=lambda item: (first.index(item[0]) if item[0] in first else len(first), item[1]))
        found += [number for _, number in channels]
    return found


def _of_first_pass(names, parts):
    passes = {}
    for number, name in enumerate(names):
        head, _, shade = name.rpartition(".")
        layer, _, title = head.rpartition(".")
        passes.setdefault(layer, {}).setdefault(title, []).append((shade, number))
    first = next(iter(passes.values()))
    found = first.get("Combined") or first.get("") or (next(iter(first.values())) if len(first) == parts == 1 else None)
    if found is None:
        raise ValueError("several passes without Combined")
    return [number for _, number in sorted(found, key=lambda item: ("RGBAXYZWUV".find(item[0].upper()[:1]), item[1]))][:4]
