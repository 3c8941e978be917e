"""The features that a scene uses, with counts and names; and the scene without one of them.

A feature that can be removed has a sentence about the scene without it. Only instanced objects and their materials count, as in
the core: an unused material costs nothing.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..bindings.enums import InstanceFlag, InstanceKind, LightKind, Pass
from ..bindings.parameters import is_zero
from ..bindings.session import Scene
from ..bindings.shading import NodeRef
from ..bindings.snapshot import SceneSnapshot
from . import simpler_materials, simpler_scene

_MOST_OWNERS = 8  # number of names listed; the count includes all owners


@dataclass(frozen=True)
class Feature:
    name: str
    text: str  # "3 materials use refraction"
    count: int
    owners: tuple  # names of the first owners
    without: str  # a description of the scene without it; "" if it cannot be removed
    pronoun: str  # "without it", "without them"


@dataclass(frozen=True)
class _Kind:
    name: str
    one: str  # with {n}, for one owner
    many: str
    owners: Callable  # (snapshot, its shown materials) -> (count, names of the first owners)
    take: Callable | None = None  # (snapshot, library) -> the snapshot without it
    without: str = ""
    pronoun: str = "it"


# ---- uses of a feature ----


def _named(names):
    return len(names), tuple(names[:_MOST_OWNERS])


def _number(of):
    """Return an owners function for a property of the scene, without names."""
    return lambda snapshot, shown: (int(of(snapshot)), ())


def shown_materials(snapshot):
    """Return the numbers of the materials that instances use."""
    table = snapshot.instances
    if not len(table):
        return []
    shown = np.zeros(len(snapshot.materials), bool)
    # Instances with equal slots share a range of slots: few distinct ranges for many instances.
    for both in np.unique(table.first_slots.astype(np.uint64) << np.uint64(32) | table.slot_counts).tolist():
        first, count = both >> 32, both & 0xFFFFFFFF
        shown[table.slots[first : first + count]] = True
    return np.flatnonzero(shown).tolist()


def _materials_that(uses):
    def owners(snapshot, shown):
        return _named([material.name for material in shown if uses(material)])

    return owners


def _changed_by(plain):
    return _materials_that(lambda material: plain(material) is not material)


def _objects_where(mask):
    def owners(snapshot, shown):
        table = snapshot.instances
        found = table.name_indices[mask(snapshot)]
        return len(found), tuple(table.names[number] for number in found[:_MOST_OWNERS])

    return owners


def _lamps_that(uses):
    return lambda snapshot, shown: _named([light.name for light in snapshot.lights if not light.opening and uses(light)])


def _lamps_of(kind):
    return _lamps_that(lambda light: light.kind == kind)


def _objects_of(kind):
    return _objects_where(lambda snapshot: snapshot.instances.kinds == kind)


def _is_copy(snapshot):
    table = snapshot.instances
    on_mesh = table.kinds == InstanceKind.MESH
    placed = np.bincount(table.meshes[on_mesh], minlength=len(snapshot.meshes) + 1)
    return on_mesh & (placed[np.where(on_mesh, table.meshes, 0)] > 1)


def _is_hole(material):
    return not is_zero(material.holdout)


def _sky_varies(snapshot):
    return isinstance(snapshot.world.radiance, NodeRef)


# ---- removal of a feature ----


def _each_material(plain):
    def take(snapshot, library):
        shown = set(shown_materials(snapshot))
        materials = tuple(plain(m) if i in shown else m for i, m in enumerate(snapshot.materials))
        return dataclasses.replace(snapshot, materials=materials)

    return take


def _of_snapshot(plain):
    return lambda snapshot, library: plain(snapshot)


_GRID = (np.stack(np.meshgrid(*[(np.arange(32) + 0.5) / 32] * 2), axis=-1)).reshape(-1, 2)


def _as_means(numbers_of):
    """Return a take function that replaces nodes by constants: their means over a unit square with the material."""

    def take(snapshot, library):
        wanted = {number: nodes for number in shown_materials(snapshot) if (nodes := numbers_of(snapshot.materials[number]))}
        probed = SceneSnapshot(materials=snapshot.materials, images=snapshot.images)
        materials = list(snapshot.materials)
        with Scene.upload(probed, library) as scene:
            for number, nodes in wanted.items():
                means = {node: scene.node(number, node, _GRID)[:, :3].mean(axis=0, dtype=float).tolist() for node in nodes}
                materials[number] = simpler_materials.with_constants(materials[number], means)
        return dataclasses.replace(snapshot, materials=tuple(materials))

    return take


def _even_sky(snapshot, library):
    probed = SceneSnapshot(images=snapshot.images, world=snapshot.world)
    with Scene.upload(probed, library) as scene:
        return simpler_scene.even_sky(snapshot, lambda directions: scene.world(directions)[0])


def _material(name, what, plain, without, pronoun="it"):
    one, many = f"{{n}} material uses {what}", f"{{n}} materials use {what}"
    return _Kind(name, one, many, _changed_by(plain), _each_material(plain), without, pronoun)


# In the order of display and measurement, from the most expensive on.
_KINDS = (
    _material("glass", "refraction", simpler_materials.opaque_glass, "they are opaque, in the same colour"),
    _material("transparency", "transparency", simpler_materials.opaque, "they are opaque"),
    _Kind(
        "textures", "{n} material uses pictures", "{n} materials use pictures",
        _materials_that(simpler_materials.pictured_nodes), _as_means(simpler_materials.pictured_nodes),
        "each has the mean of its pictures; what a picture cuts out stays", "them",
    ),
    _material("bumps", "bumps or normal maps", simpler_materials.even_normals, "surfaces are even", "them"),
    _Kind(
        "emission", "{n} material glows", "{n} materials glow",
        _changed_by(simpler_materials.dark), _each_material(simpler_materials.dark), "they are dark", "that",
    ),
    _Kind(
        "soft-lamps", "{n} lamp has an extent", "{n} lamps have an extent", _lamps_that(simpler_scene.has_extent),
        _of_snapshot(simpler_scene.point_lamps), "lamps shine from a point, and shadows are sharp",
    ),
    _Kind(
        "lamps", "", "{n} lamps to choose from", _lamps_that(lambda light: True),
        _of_snapshot(simpler_scene.one_lamp), "the strongest lamp shines alone", "all but the strongest",
    ),
    _Kind(
        "environment-map", "The sky varies", "The sky varies", _number(_sky_varies), _even_sky,
        "the sky has its mean colour everywhere", "that",
    ),
    _Kind(
        "lens", "The camera has depth of field", "", _number(lambda snapshot: snapshot.camera.lens_radius > 0.0),
        _of_snapshot(simpler_scene.pinhole), "everything is sharp",
    ),
    _Kind(
        "bounces", "", "Light is followed for {n} bounces",
        _number(lambda snapshot: snapshot.settings.max_bounces), _of_snapshot(simpler_scene.few_bounces),
        f"it is followed for {simpler_scene.FEW_BOUNCES}", f"those after number {simpler_scene.FEW_BOUNCES}",
    ),
    _Kind(
        "passes", "{n} pass is kept beside the picture", "{n} passes are kept beside the picture",
        _number(lambda snapshot: len(set(snapshot.settings.passes) - {Pass.COMBINED})),
        _of_snapshot(simpler_scene.picture_alone), "the picture is kept alone", "them",
    ),
    _material("coat", "a clear coat", simpler_materials.without_coat, "they have none"),
    _material("metal", "mirrors or metal", simpler_materials.matt_metal, "they are matt, in the same colour", "them"),
    _material("gloss", "gloss", simpler_materials.without_gloss, "they are matt"),
    _material("sheen", "sheen", simpler_materials.without_sheen, "they have none"),
    _material("translucency", "translucency", simpler_materials.without_translucency, "light stays on its side of them"),
    _material("stretched", "stretched highlights", simpler_materials.round_highlights, "highlights are round", "them"),
    _material("rough-matt", "rough matt surfaces", simpler_materials.smooth_matt, "they are matt by Lambert's law", "them"),
    _material(
        "multiscatter", "light between facets", simpler_materials.single_scattering, "it is lost, and rough metal is darker",
    ),
    _Kind(
        "nodes", "{n} material computes values with nodes", "{n} materials compute values with nodes",
        _materials_that(simpler_materials.computed_nodes), _as_means(simpler_materials.computed_nodes),
        "each value is a constant, as seen from the front", "that",
    ),
    _Kind(
        "smooth", "{n} object has smooth normals", "{n} objects have smooth normals",
        _objects_where(simpler_scene.is_smooth), _of_snapshot(simpler_scene.flat), "faces are flat", "them",
    ),
    _Kind(
        "exact-shapes", "{n} object is an exact shape", "{n} objects are exact shapes",
        _objects_where(simpler_scene.is_exact), _of_snapshot(simpler_scene.shapes_as_meshes),
        "they are meshes of 48 sides", "that",
    ),
    _material("displacement", "displacement", simpler_materials.undisplaced, "their meshes are as modelled"),
    # Features that are only listed.
    _Kind("triangles", "{n} object is a mesh", "{n} objects are meshes", _objects_of(InstanceKind.MESH)),
    _Kind("instances", "{n} object shares a mesh", "{n} objects share meshes", _objects_where(_is_copy)),
    _Kind("spheres", "{n} exact sphere", "{n} exact spheres", _objects_of(InstanceKind.SPHERE)),
    _Kind("planes", "{n} plane without end", "{n} planes without end", _objects_of(InstanceKind.PLANE)),
    _Kind("cylinders", "{n} exact cylinder", "{n} exact cylinders", _objects_of(InstanceKind.CYLINDER)),
    _Kind("cones", "{n} exact cone", "{n} exact cones", _objects_of(InstanceKind.CONE)),
    _Kind("point-lights", "{n} point lamp", "{n} point lamps", _lamps_of(LightKind.POINT)),
    _Kind("spot-lights", "{n} spot lamp", "{n} spot lamps", _lamps_of(LightKind.SPOT)),
    _Kind("sun-lights", "{n} sun", "{n} suns", _lamps_of(LightKind.SUN)),
    _Kind("area-lights", "{n} area lamp", "{n} area lamps", _lamps_of(LightKind.AREA)),
    _Kind(
        "openings", "{n} portal guides samples of the sky", "{n} portals guide samples of the sky",
        lambda snapshot, shown: _named([light.name for light in snapshot.lights if light.opening]),
    ),
    _Kind("environment", "The sky shines", "The sky shines", _number(lambda snapshot: not is_zero(snapshot.world.radiance))),
    _Kind("holdout-materials", "{n} material cuts holes", "{n} materials cut holes", _materials_that(_is_hole)),
    _Kind(
        "holdouts", "{n} object is a hole", "{n} objects are holes",
        _objects_where(lambda snapshot: (snapshot.instances.flags & InstanceFlag.HOLDOUT) != 0),
    ),
    _Kind(
        "shadow-catchers", "{n} object catches shadows", "{n} objects catch shadows",
        _objects_where(lambda snapshot: (snapshot.instances.flags & InstanceFlag.CATCHER) != 0),
    ),
    _Kind(
        "visibility", "{n} object is hidden from some rays", "{n} objects are hidden from some rays",
        _objects_where(lambda snapshot: snapshot.instances.hidden_from != 0),
    ),
)  # fmt: skip


def used_features(snapshot):
    """Return the features of a snapshot, those that can be removed first."""
    found = []
    shown = [snapshot.materials[number] for number in shown_materials(snapshot)]
    for kind in _KINDS:
        count, names = kind.owners(snapshot, shown)
        # A single lamp needs no choice among lamps, and few bounces cannot be reduced.
        least = {"lamps": 2, "bounces": simpler_scene.FEW_BOUNCES + 1}.get(kind.name, 1)
        if count >= least:
            text = (kind.one if count == 1 else kind.many or kind.one).format(n=f"{count:,}".replace(",", " "))
            found.append(Feature(kind.name, text, count, names, kind.without, kind.pronoun))
    return found


def without(snapshot, name, library=None):
    """Return the snapshot without that feature; both share the unchanged parts."""
    kind = next(kind for kind in _KINDS if kind.name == name)
    return kind.take(snapshot, library)


_KERNELS = {
    "path": "paths in vector registers, sorted by the code of the surfaces that they hit",
    "classic": "Classic ray tracing",
    "normals": "directions of surfaces",
}


def kernel_in_words(kernel):
    """Return a description of the kernel with that name in the statistics."""
    return _KERNELS.get(kernel, kernel)
