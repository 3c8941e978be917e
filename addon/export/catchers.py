"""Shadow catchers: objects that stand for those in footage, of which the picture shows the shadows alone."""

import bpy
import numpy as np

from ..bindings.enums import Catchers, InstanceFlag, Integrator, PassKind
from ..bindings.numbered_pass import NumberedPass

SOURCE = NumberedPass(PassKind.SHADOW_CATCHER)
TITLE = "Shadow Catcher"
# Find out once: a failing getattr per object takes as long as all other reads.
_HAS_CATCHER = "is_shadow_catcher" in bpy.types.Object.bl_rna.properties


def is_catcher(thing):
    return _HAS_CATCHER and thing.is_shadow_catcher


def has_pass(view_layer):
    """Whether a view layer asks for the pass. The switch belongs to Cycles, an add-on that may be disabled."""
    return getattr(getattr(view_layer, "cycles", None), "use_pass_shadow_catcher", False)


def has_catchers(instances):
    """Whether an InstanceTable has any."""
    return bool(np.any(instances.flags & int(InstanceFlag.CATCHER)))


def tell_of_aovs(instances, aovs, messages):
    """Report that the AOVs of a layer are others than Cycles', whose two paths from a catcher both add to them."""
    if aovs and has_catchers(instances):
        text = "where the camera sees shadow catchers, AOVs count surfaces and sky once, in Cycles twice"
        messages.add(text, "feature:AOVs at shadow catchers")


def catchers_of(instances, view_layer, integrator):
    """Return Settings.catchers for the objects of an InstanceTable: with the pass, Combined leaves them out."""
    if has_pass(view_layer):
        return Catchers.APART
    has_any = integrator == Integrator.PATH and has_catchers(instances)
    return Catchers.SHADOWS if has_any else Catchers.OBJECTS
