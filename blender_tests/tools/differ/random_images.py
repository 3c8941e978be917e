"""Random images: bit depths, channels, alpha, colour spaces; sequences, movies and tiles; and pictures of skies."""

from .record import Record

_FORMATS = {
    "BYTE": 3, "FLOAT": 1, "PNG8": 2, "PNG16": 1, "TIFF": 1, "OPEN_EXR": 1, "EXR 16": 1, "EXR 32": 1, "HDR": 1, "JPEG": 1,
    "WEBP": 1, "BMP": 1, "TARGA": 1,
}  # fmt: skip
_SPACES = {
    "sRGB": 6, "Non-Color": 3, "Linear": 2, "Filmic sRGB": 1, "ACEScg": 1, "Display P3": 1, "AgX Base sRGB": 1, "Rec.1886": 1,
    "Linear Rec.2020": 1,
}  # fmt: skip
# Formats of which sequences and tiles are made, and the shares of sources.
_OF_MANY_FILES = ("PNG8", "PNG16", "TIFF", "EXR 32")
_SOURCES = {"FILE": 6, "SEQUENCE": 2, "TILED": 2}
# Formats that a single channel of grey is written to.
_GREY = ("TIFF", "EXR 16", "EXR 32")


def image(dice, number):
    kind = dice.pick(_FORMATS)
    fields = {"format": kind, "size": [dice.whole(1, 8), dice.whole(1, 8)], "space": dice.pick(_SPACES)}
    if kind in _GREY and dice.chance(0.3):
        fields["grey"] = True
    else:
        fields["alpha"] = dice.pick(("none", "none", "smooth", "cut"))
    if kind in _OF_MANY_FILES:
        fields["source"] = dice.pick(_SOURCES)
    elif kind == "BYTE" and dice.chance(0.2):
        fields["source"] = "MOVIE"
    fields["alpha_mode"] = dice.pick(("STRAIGHT", "STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"))
    return Record("image", f"Image {number}", {**fields, "seed": dice.whole(0, 99)})


def user(dice):
    """Which frame of a sequence or a movie a node shows: length, start, offset, cyclic, Auto Refresh."""
    return [dice.whole(0, 4), dice.whole(-3, 3), dice.whole(-2, 2), dice.chance(0.5), dice.chance(0.8)]


def sky(dice):
    """A smooth picture, with a small sun now and then."""
    fields = {"format": dice.pick(("FLOAT", "FLOAT", "OPEN_EXR", "BYTE")), "size": [16, 8], "space": "Linear"}
    return Record("image", "Sky", {**fields, "seed": dice.whole(0, 99), "peak": dice.pick((1.0, 1.0, 1.0, 4.0))})
