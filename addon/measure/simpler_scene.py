"""Objects, lamps, sky, camera and settings without one of their features, as an artist would simplify them.

Every function returns the same object if the snapshot lacks the feature.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from ..bindings.enums import InstanceKind, LightKind, Pass, Shading
from ..bindings.numbered_pass import extras
from ..bindings.shading import NodeRef, World
from ..bindings.snapshot import Light, MeshData

FEW_BOUNCES = 3
# Sides of the meshes that replace exact shapes.
_SIDES = 48
_DIRECTIONS = 4096


def _replaced(record, **values):
    return dataclasses.replace(record, **values)


# ---- objects ----


def is_smooth(snapshot):
    """Return (instances,) bool: whether the normals are interpolated."""
    table = snapshot.instances
    own = np.array([mesh.normals is not None for mesh in snapshot.meshes] + [False])
    on_mesh = table.kinds == InstanceKind.MESH
    as_mesh = own[np.where(on_mesh, table.meshes, len(own) - 1)]
    asked = np.isin(table.shadings, (int(Shading.GOURAUD), int(Shading.PHONG)))
    return on_mesh & (asked | (table.shadings == Shading.AS_MESH) & as_mesh)


def flat(snapshot):
    smooth = is_smooth(snapshot)
    if not smooth.any():
        return snapshot
    shadings = np.where(smooth, np.uint32(Shading.FLAT), snapshot.instances.shadings)
    return _replaced(snapshot, instances=_replaced(snapshot.instances, shadings=shadings))


_ROUND = (InstanceKind.SPHERE, InstanceKind.CYLINDER, InstanceKind.CONE)


def is_exact(snapshot):
    return np.isin(snapshot.instances.kinds, [int(kind) for kind in _ROUND])


def shapes_as_meshes(snapshot):
    if not is_exact(snapshot).any():
        return snapshot
    table, meshes = snapshot.instances, list(snapshot.meshes)
    kinds, numbers = table.kinds.copy(), table.meshes.copy()
    for kind in _ROUND:
        here = table.kinds == kind
        if here.any():
            numbers[here] = len(meshes)
            kinds[here] = InstanceKind.MESH
            meshes.append(_turned(kind))
    return _replaced(snapshot, meshes=tuple(meshes), instances=_replaced(table, kinds=kinds, meshes=numbers))


def _turned(kind):
    """Return the mesh of an exact shape in its unit frame: a surface of revolution about z. Only the sphere has normals."""
    if kind == InstanceKind.SPHERE:
        angles = np.linspace(0.0, math.pi, _SIDES // 2 + 1)
        outline = [(math.sin(a), math.cos(a)) for a in angles]
    elif kind == InstanceKind.CYLINDER:
        outline = [(0.0, 1.0), (1.0, 1.0), (1.0, -1.0), (0.0, -1.0)]
    else:
        outline = [(0.0, 1.0), (1.0, -1.0), (0.0, -1.0)]
    around = np.linspace(0.0, 2.0 * math.pi, _SIDES, endpoint=False)
    circle = np.stack([np.cos(around), np.sin(around)], axis=1)
    rings = [np.column_stack([r * circle, np.full(_SIDES, z)]) for r, z in outline]
    corner = np.arange(_SIDES)
    triangles = []
    for ring, ((r0, _), (r1, _)) in enumerate(zip(outline, outline[1:], strict=False)):
        a, b = ring * _SIDES + corner, ring * _SIDES + (corner + 1) % _SIDES
        # At the poles one of the two triangles of a face has no area: leave it out.
        if r1 > 1e-9:
            triangles.append(np.stack([a, a + _SIDES, b + _SIDES], axis=1))
        if r0 > 1e-9:
            triangles.append(np.stack([a, b + _SIDES, b], axis=1))
    positions = np.concatenate(rings)
    normals = positions if kind == InstanceKind.SPHERE else None
    return MeshData(kind.name.lower(), positions, np.concatenate(triangles), normals)


# ---- lamps ----


def has_extent(light):
    if light.kind == LightKind.SUN:
        return light.sun_angle > 0.0
    return (light.kind == LightKind.AREA and not light.opening) or light.radius > 0.0


def _as_point(light):
    if not has_extent(light):
        return light
    if light.kind == LightKind.SUN:
        return _replaced(light, sun_angle=0.0)
    if light.kind != LightKind.AREA:
        return _replaced(light, radius=0.0)
    # The lamp's power, pi radiance area, as radiant intensity that is equal in all directions of its half space.
    intensity = tuple(e * _area(light) / 2.0 for e in light.emission)
    spot = {"spot_angle": min(light.spread, math.pi), "spot_blend": 0.0, "size": (1.0, 1.0)}
    return _replaced(light, kind=LightKind.SPOT, emission=intensity, radius=0.0, **spot)


def _area(light):
    return light.size[0] * light.size[1] * (math.pi / 4.0 if light.shape else 1.0)


def point_lamps(snapshot):
    lights = tuple(_as_point(light) for light in snapshot.lights)
    changed = any(new is not old for new, old in zip(lights, snapshot.lights, strict=True))
    return _replaced(snapshot, lights=lights) if changed else snapshot


def _power(light: Light):
    """Return the power in watts; infinity for a sun."""
    level = sum(light.emission) / 3.0
    if light.kind == LightKind.SUN:
        return math.inf if level > 0.0 else 0.0
    return math.pi * level * (_area(light) if light.kind == LightKind.AREA else 4.0)


def one_lamp(snapshot):
    lamps = [light for light in snapshot.lights if not light.opening]
    if len(lamps) < 2:
        return snapshot
    brightest = max(lamps, key=_power)
    return _replaced(snapshot, lights=tuple(light for light in snapshot.lights if light is brightest or light.opening))


# ---- sky, camera, settings ----


def even_sky(snapshot, probe_world):
    """Return the snapshot with the mean radiance of its sky. probe_world(directions (count, 3)) returns radiance (count, 3)."""
    if not isinstance(snapshot.world.radiance, NodeRef):
        return snapshot
    # Each point of the spiral represents the same solid angle.
    i = np.arange(_DIRECTIONS) + 0.5
    z, turn = 1.0 - 2.0 * i / _DIRECTIONS, math.pi * (1.0 + math.sqrt(5.0)) * i
    r = np.sqrt(1.0 - z * z)
    mean = probe_world(np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)).mean(axis=0, dtype=float)
    return _replaced(snapshot, world=World(radiance=tuple(mean), hidden_from=snapshot.world.hidden_from))


def pinhole(snapshot):
    camera = snapshot.camera
    return _replaced(snapshot, camera=_replaced(camera, lens_radius=0.0)) if camera.lens_radius > 0.0 else snapshot


def few_bounces(snapshot):
    settings = snapshot.settings
    if settings.max_bounces <= FEW_BOUNCES:
        return snapshot
    return _replaced(snapshot, settings=_replaced(settings, max_bounces=FEW_BOUNCES))


def picture_alone(snapshot):
    settings, without = snapshot.settings, extras(())
    if not set(settings.passes) - {Pass.COMBINED} and not any(getattr(settings, name) for name in without):
        return snapshot
    return _replaced(snapshot, settings=_replaced(settings, passes=(Pass.COMBINED,), **without))
