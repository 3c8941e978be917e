"""Passes of which a picture has several of a kind, or that need no setting; all others are members of enums.Pass. No bpy."""

from typing import NamedTuple

from .enums import PASS_SPAN, PassKind

# The kinds of mattes, by the bits of Settings.mattes.
MATTES = (PassKind.OBJECT_MATTES, PassKind.MATERIAL_MATTES, PassKind.ASSET_MATTES)


class NumberedPass(NamedTuple):
    """One pass of a kind; of mattes number n has the mattes 2 n and 2 n + 1 of each pixel."""

    kind: PassKind
    number: int = 0

    @property
    def channels(self):
        return self.kind.channels

    @property
    def address(self):
        """The number of the pass in the interface."""
        return self.kind * PASS_SPAN + self.number


def extras(passes):
    """Return the Settings that a render of these passes needs for those of them that are NumberedPasses."""
    numbered = [item for item in passes if isinstance(item, NumberedPass)]

    def count(kind):
        return max((item.number + 1 for item in numbered if item.kind == kind), default=0)

    return {
        "mattes": sum(1 << bit for bit, kind in enumerate(MATTES) if count(kind)),
        "light_groups": count(PassKind.LIGHT_GROUP),
        "aov_colors": count(PassKind.AOV_COLOR),
        "aov_values": count(PassKind.AOV_VALUE),
    }
