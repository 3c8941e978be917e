"""The chapters of the report, in the order of chapters.toml, which holds their texts; the modules measure and render."""

from pathlib import Path

import tomllib

from . import acceleration, intersections, lighting, sampling, shading, textures, tracing
from .chapter import Chapter

_MODULES = (intersections, lighting, tracing, shading, textures, acceleration, sampling)
_MAKERS = {make.__name__: make for module in _MODULES for make in module.CHAPTERS}

PROSE = tomllib.loads(Path(__file__).with_name("chapters.toml").read_text(encoding="utf-8"))
if set(PROSE) != set(_MAKERS):
    raise LookupError(f"these chapters lack their text or their figures: {set(PROSE) ^ set(_MAKERS)}")


def make_chapter(name, quick):
    """Measures, renders and returns a chapter."""
    return Chapter.of(PROSE[name], *_MAKERS[name](quick))
