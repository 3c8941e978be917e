"""The Subdivision modifiers that Cycles replaces by adaptive subdivision, and the meshes before them."""

import contextlib
from typing import NamedTuple

import bpy

from ..mesh import read_positions

# Since 4.5 Cycles divides the mesh before the modifier; until then, the mesh that the modifier has divided already.
_DIVIDES_CAGE = bpy.app.version >= (4, 5)
# The modifiers that move the vertices of a mesh without a change of its faces; Blender's coordinates before deformation ignore
# them.
_DEFORMING = {
    "ARMATURE", "CAST", "CLOTH", "CORRECTIVE_SMOOTH", "CURVE", "DISPLACE", "HOOK", "LAPLACIANDEFORM", "LAPLACIANSMOOTH",
    "LATTICE", "MESH_CACHE", "MESH_DEFORM", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "SOFT_BODY", "SURFACE_DEFORM", "WARP",
    "WAVE",
}  # fmt: skip


class Adaptive(NamedTuple):
    """The settings of adaptive subdivision of an object."""

    smooth: bool  # Catmull-Clark, or flat faces
    rate: float  # in pixels, or in units of the object
    in_pixels: bool
    offscreen_scale: float
    most_levels: int
    creased: bool
    sharp_corners: bool  # of boundaries
    uv_smooth: str  # as of the modifier; NONE for linear


def adaptive(thing, scene, in_view):
    """Return the Adaptive of an evaluated object; None if Cycles shows its mesh as Blender divides it."""
    last = thing.modifiers[-1] if thing.modifiers else None
    if last is None or last.type != "SUBSURF" or not (last.show_viewport if in_view else last.show_render):
        return None
    settings = getattr(scene, "cycles", None)
    rate = getattr(settings, "preview_dicing_rate" if in_view else "dicing_rate", 8.0 if in_view else 1.0)
    in_pixels = True
    if hasattr(last, "use_adaptive_subdivision"):
        if not last.use_adaptive_subdivision:
            return None
        in_pixels = last.adaptive_space == "PIXEL"
        rate *= last.adaptive_pixel_size if in_pixels else last.adaptive_object_edge_length
    else:
        # Before 5.0 adaptive subdivision is an experimental feature of the Cycles add-on, which may be disabled.
        if getattr(settings, "feature_set", "") != "EXPERIMENTAL" or not thing.cycles.use_adaptive_subdivision:
            return None
        rate *= thing.cycles.dicing_rate
    return Adaptive(
        smooth=last.subdivision_type == "CATMULL_CLARK",
        rate=max(0.1, rate) if in_pixels else max(1e-6, rate),
        in_pixels=in_pixels,
        offscreen_scale=getattr(settings, "offscreen_dicing_scale", 4.0),
        most_levels=getattr(settings, "max_subdivisions", 12),
        creased=last.use_creases or not _DIVIDES_CAGE,
        sharp_corners=_DIVIDES_CAGE and last.boundary_smooth == "PRESERVE_CORNERS",
        uv_smooth=last.uv_smooth if _DIVIDES_CAGE else "NONE",
    )


def may_make_instances(thing):
    """Whether an object's modifiers may make instances of meshes that are not its own."""
    return any(modifier.type == "NODES" for modifier in thing.modifiers)


@contextlib.contextmanager
def cage_of(owner, depsgraph):
    """Yield the mesh of an evaluated object that Cycles divides.

    The last modifier of the evaluated copy is off meanwhile. Blender evaluates the copy's modifiers again if all layers are
    wanted.
    """
    if not _DIVIDES_CAGE:
        yield owner.data
        return
    with _evaluated_without(owner, depsgraph, {len(owner.modifiers) - 1}) as mesh:
        yield mesh


def undeformed_cage(owner, depsgraph):
    """Return the positions of the mesh of cage_of() without deformation, (vertices, 3); None if nothing deforms it.

    A mesh that Blender evaluates again has no layer of them.
    """
    if not _DIVIDES_CAGE:
        return None
    modifiers = owner.modifiers
    deforming = {number for number, modifier in enumerate(modifiers) if modifier.type in _DEFORMING}
    keys = owner.original.data.shape_keys
    if not deforming and keys is None:
        return None
    keys = None if keys is None else keys.evaluated_get(depsgraph)
    # Keys that the depsgraph does not have are the user's.
    blocks = keys.key_blocks if keys is not None and keys.is_evaluated else ()
    muted = [False] * len(blocks)
    if blocks:
        blocks.foreach_get("mute", muted)
        blocks.foreach_set("mute", [True] * len(blocks))
    try:
        with _evaluated_without(owner, depsgraph, {len(modifiers) - 1} | deforming) as mesh:
            return read_positions(mesh)
    finally:
        if blocks:
            blocks.foreach_set("mute", muted)


@contextlib.contextmanager
def _evaluated_without(owner, depsgraph, numbers):
    """Yield the mesh of an evaluated object as it is without the modifiers of those numbers."""
    switch = "show_render" if depsgraph.mode == "RENDER" else "show_viewport"
    before = [False] * len(owner.modifiers)
    owner.modifiers.foreach_get(switch, before)
    try:
        _set(owner.modifiers, switch, [is_on and number not in numbers for number, is_on in enumerate(before)])
        mesh = owner.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
        _set(owner.modifiers, switch, before)
        yield mesh
    finally:
        _set(owner.modifiers, switch, before)
        owner.to_mesh_clear()


def _set(modifiers, switch, values):
    """Set a switch of each modifier. foreach_set tells no one of the change, so that nothing else is evaluated."""
    modifiers.foreach_set(switch, values)
    found = [False] * len(values)
    modifiers.foreach_get(switch, found)
    # foreach_set ignores the modifiers of linked objects.
    for modifier, value, is_on in zip(modifiers, values, found, strict=True):
        if value != is_on:
            setattr(modifier, switch, value)
