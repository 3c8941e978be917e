"""Passes that a view layer names itself or of which it asks for several: AOVs, light groups, mattes, Shadow Catcher."""

from ..bindings.enums import PassKind
from ..bindings.numbered_pass import NumberedPass
from ..bindings.pass_names import CRYPTOMATTE_CHANNELS, CRYPTOMATTES
from ..bindings.snapshot import NamedPass
from . import catchers
from .light_groups import light_groups_of
from .outputs import aovs_of

# Suffix of the view layer's switch use_pass_cryptomatte_*.
_CRYPTOMATTES = (
    ("object", PassKind.OBJECT_MATTES),
    ("material", PassKind.MATERIAL_MATTES),
    ("asset", PassKind.ASSET_MATTES),
)


def named_passes(view_layer):
    """Yield a snapshot.NamedPass for each of them that a view layer requests."""
    if catchers.has_pass(view_layer):
        yield _named(catchers.TITLE, "RGB", catchers.SOURCE)
    # Each pass has two levels.
    levels = range((min(16, view_layer.pass_cryptomatte_depth) + 1) // 2)
    for switch, kind in _CRYPTOMATTES:
        for level in levels if getattr(view_layer, "use_pass_cryptomatte_" + switch) else ():
            yield _named(f"{CRYPTOMATTES[kind]}{level:02d}", CRYPTOMATTE_CHANNELS, NumberedPass(kind, level))
    for aov in aovs_of(view_layer):
        yield _named(aov.name, "RGBA" if aov.is_color else "X", aov.source)
    for name, source in light_groups_of(view_layer):
        yield _named(f"Combined_{name}", "RGB", source)


def _named(name, channels, source):
    return NamedPass(name, channels, int(source.kind), source.number)
