"""Records of snapshot.py as structs of lancer.h.

A struct holds addresses of the record's own arrays, so the record must outlive the call; the library copies.
"""

import ctypes

import numpy as np

from . import abi

INSTANCE = np.dtype(abi.Instance)


def _address(array):
    return None if array is None else array.ctypes.data


def _row_major(matrix):
    return (ctypes.c_double * 12)(*matrix.ravel().tolist())


def _parameter(value):
    vector = tuple(value) if isinstance(value, (tuple, list)) else (value, 0.0, 0.0)
    return abi.Parameter((ctypes.c_float * 3)(*vector), -1)


def mesh(m):
    domain = abi.NormalDomain.NONE
    if m.normals is not None:
        domain = abi.NormalDomain.VERTEX if m.normals.ndim == 2 else abi.NormalDomain.CORNER
    return abi.Mesh(
        name=m.name.encode("utf-8"),
        positions=_address(m.positions),
        triangles=_address(m.triangles),
        normals=_address(m.normals),
        uvs=_address(m.uvs),
        colors=_address(m.colors),
        material_slots=_address(m.material_slots),
        vertex_count=len(m.positions),
        triangle_count=len(m.triangles),
        normal_domain=domain,
    )


def instances(table):
    """The arguments of lancer_scene_add_instances after the scene."""
    encoded = [name.replace("\0", " ").encode("utf-8") + b"\0" for name in table.names]
    offsets = np.cumsum([0] + [len(name) for name in encoded]).astype(np.uint32)
    names = b"".join(encoded)
    rows = np.zeros(len(table), INSTANCE)
    rows["matrix"] = table.matrices.reshape(-1, 12)
    rows["kind"] = table.kinds
    rows["mesh"] = table.meshes
    rows["first_slot"] = table.first_slots
    rows["slot_count"] = table.slot_counts
    rows["object_index"] = table.object_indices
    rows["shading"] = table.shadings
    rows["name"] = offsets[table.name_indices]
    # data_as keeps the array alive for as long as the pointer lives; a bare address would not.
    pointer = rows.ctypes.data_as(ctypes.c_void_p)
    return len(rows), pointer, len(table.slots), _address(table.slots), names, len(names)


def material(m):
    lobes = (abi.Lobe * len(m.lobes))()
    for target, lobe in zip(lobes, m.lobes, strict=True):
        target.kind = int(lobe.kind)
        target.color = _parameter(lobe.color)
        target.roughness = _parameter(lobe.roughness)
        target.ior = _parameter(lobe.ior)
        target.shininess = _parameter(lobe.shininess)
    return abi.Material(
        name=m.name.encode("utf-8"),
        lobes=ctypes.cast(lobes, ctypes.POINTER(abi.Lobe)),
        lobe_count=len(m.lobes),
        material_index=m.material_index,
        emission=_parameter(m.emission),
        opacity=_parameter(m.opacity),
        ambient=_parameter(m.ambient),
    )


def light(li):
    return abi.Light(
        name=li.name.encode("utf-8"),
        matrix=_row_major(li.matrix),
        kind=int(li.kind),
        emission=li.emission,
        radius=li.radius,
        soft_falloff=int(li.soft_falloff),
        spot_angle=li.spot_angle,
        spot_blend=li.spot_blend,
        spot_cosine=li.spot_cosine,
        sun_angle=li.sun_angle,
        size=li.size,
        shape=int(li.shape),
        spread=li.spread,
        falloff=int(li.falloff),
        falloff_radius=li.falloff_radius,
        ambient_color=li.ambient_color,
        diffuse_color=li.diffuse_color,
        specular_color=li.specular_color,
    )


def camera(c):
    return abi.Camera(
        matrix=_row_major(c.matrix),
        kind=int(c.kind),
        width=c.width,
        height=c.height,
        x=c.x,
        y=c.y,
        region_width=c.region_width,
        region_height=c.region_height,
        window=c.window,
        clip_start=c.clip_start,
        clip_end=c.clip_end,
        lens_radius=c.lens_radius,
        focal_distance=c.focal_distance,
    )


def settings(s):
    return abi.Settings(
        integrator=int(s.integrator),
        samples=s.samples,
        seed=s.seed,
        max_bounces=s.max_bounces,
        contribution_threshold=s.contribution_threshold,
        clamp_indirect=s.clamp_indirect,
        pixel_filter=int(s.pixel_filter),
        filter_width=s.filter_width,
        film_transparent=int(s.film_transparent),
        features=int(s.features),
        passes=sum(1 << p for p in set(s.passes)),
        threads=s.threads,
        tile_size=s.tile_size,
    )
