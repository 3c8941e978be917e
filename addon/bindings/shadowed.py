"""The picture of shadow catchers from its parts: lancer_compose_catchers."""

from typing import NamedTuple

import numpy as np

from . import abi
from .enums import Catchers, Pass, PassKind
from .numbered_pass import NumberedPass


class Parts(NamedTuple):
    """The parts of Pass.COMBINED with Settings.catchers, linear float32."""

    catchers: Catchers  # APART or SHADOWS

    matte: np.ndarray  # (height, width, 4): the picture without shadow catchers, premultiplied
    catcher: np.ndarray  # (height, width, 3): the factor of their light that other objects leave
    environment: np.ndarray | None  # (height, width, 3); None for a transparent film


def parts_of(session):
    """Return the Parts of a session's current picture."""
    matte, catcher = (session.read(NumberedPass(kind)) for kind in (PassKind.CATCHER_MATTE, PassKind.SHADOW_CATCHER))
    catchers = Catchers(session.settings.catchers)
    over_environment = catchers == Catchers.SHADOWS and not session.settings.film_transparent
    return Parts(catchers, matte, catcher, session.read(Pass.ENVIRONMENT) if over_environment else None)


def compose(parts, library=None):
    """Return the picture, (height, width, 4) float32. Raise LancerError for other shapes."""
    if parts.catchers == Catchers.APART:
        return parts.matte
    library = library or abi.load_library()
    height, width, _ = np.shape(parts.matte)
    arrays = [None if part is None else np.ascontiguousarray(part, np.float32) for part in parts[1:]]
    shapes = [None if array is None else array.shape for array in arrays]
    if shapes[:2] != [(height, width, 4), (height, width, 3)] or shapes[2] not in (None, (height, width, 3)):
        raise abi.LancerError(f"compose: parts of shapes {', '.join(map(str, shapes))}")
    picture = np.empty((height, width, 4), np.float32)
    pointers = [None if array is None else array.ctypes.data for array in arrays]
    abi.check(library.lancer_compose_catchers(height * width, *pointers, picture.ctypes.data), library)
    return picture
