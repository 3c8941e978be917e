"""A reader of parts of pictures that follows the description in lancer.h alone, byte by byte, and XXH64 from its definition."""

import dataclasses
import struct

import numpy as np

from addon.bindings import abi
from addon.bindings.abi import Pass

# Passes of sample 0, passes that follow from others, and the pass that each pass of halves compares.
_OF_SAMPLE_0 = (Pass.DEPTH, Pass.POSITION, Pass.OBJECT_INDEX, Pass.MATERIAL_INDEX)
_HALVED = {Pass.HALVES: Pass.COMBINED, Pass.ALBEDO_HALVES: Pass.ALBEDO, Pass.NORMAL_HALVES: Pass.DENOISING_NORMAL}
COMPONENTS = range(Pass.DIFFUSE_DIRECT, Pass.TRANSMISSION_COLOR + 1)
# Side of the squares of a picture in parts.
SQUARE = 16

_PRIMES = 0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5
_ALL = (1 << 64) - 1


def xxh64(data):
    """Return XXH64 with seed 0 by the steps of its specification (doc/xxhash_spec.md of xxHash, section XXH64)."""
    first, second, third, fourth, fifth = _PRIMES

    def turned(number, bits):
        return (number << bits | number >> 64 - bits) & _ALL

    def rounded(sum_, lane):
        return turned(sum_ + lane * second & _ALL, 31) * first & _ALL

    # Step 1 to 3: four sums of stripes of 32 bytes; shorter data have none.
    stripes = len(data) // 32
    if stripes:
        sums = [first + second & _ALL, second, 0, -first & _ALL]
        for lanes in struct.iter_unpack("<4Q", data[: 32 * stripes]):
            sums = [rounded(sum_, lane) for sum_, lane in zip(sums, lanes, strict=True)]
        result = sum(turned(sum_, bits) for sum_, bits in zip(sums, (1, 7, 12, 18), strict=True)) & _ALL
        for sum_ in sums:
            result = ((result ^ rounded(0, sum_)) * first + fourth) & _ALL
    else:
        result = fifth
    # Step 4 and 5: the length, and the rest of the bytes.
    result = result + len(data) & _ALL
    rest = data[32 * stripes :]
    words = len(rest) // 8
    for (lane,) in struct.iter_unpack("<Q", rest[: 8 * words]):
        result = (turned(result ^ rounded(0, lane), 27) * first + fourth) & _ALL
    rest = rest[8 * words :]
    if len(rest) >= 4:
        (lane,) = struct.unpack_from("<I", rest)
        result = (turned(result ^ lane * first & _ALL, 23) * second + third) & _ALL
        rest = rest[4:]
    for byte in rest:
        result = turned(result ^ byte * fifth & _ALL, 11) * first & _ALL
    # Step 6: the avalanche.
    result = (result ^ result >> 33) * second & _ALL
    result = (result ^ result >> 29) * third & _ALL
    return result ^ result >> 32


def by_hand(kind):
    """Return the dtype of a struct of lancer.h without padding."""
    return np.dtype([(name, by_hand(member) if hasattr(member, "_fields_") else member) for name, member in kind._fields_])


@dataclasses.dataclass
class Sums:
    """The sums of the samples start to start + 2^level - 1."""

    start: int
    level: int
    channels: np.ndarray  # (pixels, channels), double; those of light groups and AOVs last
    difference: np.ndarray  # (pixels,)
    halves: np.ndarray  # (pixels, channels of the passes of halves)
    mattes: list  # for each kind a list of {id: sum} of each pixel


@dataclasses.dataclass
class Tile:
    number: int
    sums: list
    brightest: np.ndarray
    first: np.ndarray | None  # (pixels, channels): sample 0
    dropped: tuple
    first_dropped: tuple

    @property
    def count(self):
        return sum(1 << sums.level for sums in self.sums)


class ReadPart:
    """about: lancer_part as a record; rays: camera, bounce and shadow rays, and vertices; light: ten exact sums as integers
    in units of 2^-150; tiles: by number."""

    def __init__(self, data):
        self._data, self._at = bytes(data), 0
        mark, form, interface, size = self._take("<8sIIQ")
        assert (mark, form, interface, size) == (b"LANCERPT", 2, abi.ABI_VERSION, len(self._data))
        (self.about,) = self._array(by_hand(abi.Part), 1)
        self.rays = self._take("<4Q")
        self.light = [sum(digit << 8 * place for place, digit in enumerate(self._take("<32q"))) for _ in range(10)]
        self.summed, self.of_first, self.halves = self._passes()
        groups, colors, values, bits = (
            int(self.about["settings"][name]) for name in ("light_groups", "aov_colors", "aov_values", "mattes")
        )
        self.extra, self.matte_kinds = 3 * groups + 4 * colors + values, bin(bits).count("1")
        self.tiles = []
        while self._at < len(self._data) - 8:
            self.tiles.append(self._tile())
        (self.checksum,) = self._take("<Q")
        assert self._at == len(self._data)

    def _take(self, form):
        values = struct.unpack_from(form, self._data, self._at)
        self._at += struct.calcsize(form)
        return values

    def _array(self, kind, *shape):
        kind = np.dtype(kind)
        array = np.frombuffer(self._data, kind, int(np.prod(shape)), self._at).reshape(shape)
        self._at += array.nbytes
        return array

    def _passes(self):
        """Return the kept passes: summed ones, those of sample 0, and those of halves, each with its place among its kind."""
        wanted = {Pass.COMBINED, *(which for which in Pass if int(self.about["settings"]["passes"]) >> which & 1)}
        halves = [which for which in sorted(wanted) if which in _HALVED]
        kept = {_HALVED.get(which, which) for which in wanted} - {Pass.ERROR}
        # A component's light is kept with its colour.
        kept |= {color_of(which) for which in kept if which in COMPONENTS}
        return (
            _places([which for which in sorted(kept) if which not in _OF_SAMPLE_0]),
            _places([which for which in sorted(kept) if which in _OF_SAMPLE_0]),
            _places(halves),
        )

    def _tile(self):
        number, count, dropped, has_first = self._take("<4I")
        pixels = len(self.place(number)[0])
        heads = [self._take("<2I") for _ in range(count)]
        sums = [
            Sums(
                *head,
                self._array("<f8", pixels, _width(self.summed) + self.extra),
                self._array("<f4", pixels),
                self._array("<f4", pixels, _width(self.halves)),
                [self._mattes(pixels) for _ in range(self.matte_kinds)],
            )
            for head in heads
        ]
        brightest = self._array("<f4", pixels)
        first = self._array("<f4", pixels, _width(self.of_first)) if has_first else None
        counts = self._take(f"<{dropped}Q")
        return Tile(number, sums, brightest, first, counts, self._take("<3I") if dropped else ())

    def _mattes(self, pixels):
        ends = self._array("<u4", pixels).tolist()
        ids, sums = self._array("<u4", ends[-1]).tolist(), self._array("<f8", ends[-1]).tolist()
        return [dict(zip(ids[begin:end], sums[begin:end], strict=True)) for begin, end in zip([0, *ends], ends, strict=False)]

    def place(self, number):
        """Return (y, x) of the pixels of a tile: the cells of one colour of a square that is a chessboard, row by row."""
        camera = self.about["camera"]
        width, height = int(camera["region_width"]), int(camera["region_height"])
        squares = -(-width // SQUARE)
        row, column = divmod(number // 2, squares)
        y, x = np.mgrid[row * SQUARE : min(height, (row + 1) * SQUARE), column * SQUARE : min(width, (column + 1) * SQUARE)]
        mine = (x + y) % 2 == number % 2
        return y[mine], x[mine]

    def picture(self, which):
        """Return the means of a summed pass, or the values of sample 0, as (height, width, channels); 0 without any."""
        camera = self.about["camera"]
        image = np.zeros((int(camera["region_height"]), int(camera["region_width"]), which.channels), np.float32)
        for tile in self.tiles:
            if which in self.of_first:
                values = 0.0 if tile.first is None else tile.first[:, self.of_first[which]]
            else:
                # Smaller sums first, as the tree of all samples would.
                total = 0.0
                for sums in reversed(tile.sums):
                    total = sums.channels[:, self.summed[which]] + total
                count = tile.count
                if which is Pass.VECTOR:
                    total, count = total[:, :-1], np.maximum(total[:, -1:], 1.0)
                values = (total / count).astype(np.float32)
            image[self.place(tile.number)] = values
        return image


def color_of(which):
    """Return the colour of a component's pass: the last one of its three."""
    return Pass(which + 2 - (which - Pass.DIFFUSE_DIRECT) % 3)


def _places(passes):
    places, at = {}, 0
    for which in passes:
        # The number of samples with a vector follows the vectors.
        width = which.channels + (which is Pass.VECTOR)
        places[which] = slice(at, at + width)
        at += width
    return places


def _width(places):
    return sum(place.stop - place.start for place in places.values())
