"""Records of snapshot.py as structs of lancer.h.

A struct holds addresses of the record's own arrays, so the record must outlive the call; the library copies.
"""

import ctypes

import numpy as np

from . import abi
from .shading import NodeRef

INSTANCE = np.dtype(abi.Instance)


def _address(array):
    return None if array is None else array.ctypes.data


def _row_major(matrix):
    return (ctypes.c_double * 12)(*matrix.ravel().tolist())


def _text(text):
    """UTF-8 that ends where C sees its end; half a character, which Python's text can hold, becomes a question mark."""
    return text.replace("\0", " ").encode("utf-8", "replace")


def _parameter(value):
    """A number, three numbers or a NodeRef; the number of a node stands in for a value."""
    if isinstance(value, NodeRef):
        return abi.Parameter((ctypes.c_float * 3)(), value.node)
    vector = tuple(value) if isinstance(value, (tuple, list)) else (value, 0.0, 0.0)
    return abi.Parameter((ctypes.c_float * 3)(*vector), -1)


def _parameters(record):
    return {name: _parameter(getattr(record, name)) for name in record.PARAMETERS}


def _many(kind, structs):
    """A C array of structs, or NULL for none."""
    structs = list(structs)
    return (kind * len(structs))(*structs) if structs else None


def mesh(m):
    domain = abi.NormalDomain.NONE
    if m.normals is not None:
        domain = abi.NormalDomain.VERTEX if m.normals.ndim == 2 else abi.NormalDomain.CORNER
    return abi.Mesh(
        name=_text(m.name),
        positions=_address(m.positions),
        triangles=_address(m.triangles),
        normals=_address(m.normals),
        uvs=_address(m.uvs),
        colors=_address(m.colors),
        material_slots=_address(m.material_slots),
        polygons=_address(m.polygons),
        attributes=_many(abi.Attribute, map(_attribute, m.attributes)),
        vertex_count=len(m.positions),
        triangle_count=len(m.triangles),
        normal_domain=domain,
        attribute_count=len(m.attributes),
    )


def _attribute(a):
    return abi.Attribute(name=_text(a.name), values=_address(a.values), domain=int(a.domain), channels=a.values.shape[1])


def instances(table):
    """The arguments of lancer_scene_add_instances after the scene."""
    encoded = [_text(name) + b"\0" for name in table.names]
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
    rows["hidden_from"] = table.hidden_from
    rows["terminator"] = table.terminators
    rows["flags"] = table.flags
    # data_as keeps the array alive for as long as the pointer lives; a bare address would not.
    pointer = rows.ctypes.data_as(ctypes.c_void_p)
    return len(rows), pointer, len(table.slots), _address(table.slots), names, len(names)


_TEXELS = {
    np.dtype(np.uint8): abi.TexelKind.U8,
    np.dtype(np.uint16): abi.TexelKind.U16,
    np.dtype(np.float32): abi.TexelKind.FLOAT,
}


def image(i):
    height, width, channels = i.texels.shape
    return abi.Image(
        name=_text(i.name),
        texels=_address(i.texels),
        width=width,
        height=height,
        channels=channels,
        kind=_TEXELS[i.texels.dtype],
        transfer=int(i.transfer),
        alpha=int(i.alpha),
        tile=i.tile,
        matrix=i.matrix,
    )


def _node(n):
    # What a node leaves unsaid is 0, and no reference.
    inputs = (abi.Parameter * 5)(*map(_parameter, n.inputs + (0.0,) * (5 - len(n.inputs))))
    return abi.Node(
        kind=int(n.kind),
        option=int(n.option),
        flags=int(n.flags),
        image=n.image,
        image_count=n.image_count,
        first=n.first,
        name=_text(n.name),
        inputs=inputs,
        matrix=n.matrix,
    )


def _principled(p):
    return abi.Principled(rules=int(p.rules), distribution=int(p.distribution), option=int(p.option), **_parameters(p))


def _lobe(lobe):
    principled = None if lobe.principled is None else ctypes.pointer(_principled(lobe.principled))
    return abi.Lobe(
        kind=int(lobe.kind),
        distribution=int(lobe.distribution),
        option=int(lobe.option),
        rules=int(lobe.rules),
        principled=principled,
        **_parameters(lobe),
    )


def material(m):
    return abi.Material(
        name=_text(m.name),
        lobes=_many(abi.Lobe, map(_lobe, m.lobes)),
        nodes=_many(abi.Node, map(_node, m.nodes)),
        lobe_count=len(m.lobes),
        node_count=len(m.nodes),
        material_index=m.material_index,
        flags=int(m.flags),
        **_parameters(m),
    )


def world(w):
    return abi.World(
        nodes=_many(abi.Node, map(_node, w.nodes)),
        node_count=len(w.nodes),
        hidden_from=int(w.hidden_from),
        radiance=_parameter(w.radiance),
        ambient=(0.0, 0.0, 0.0) if w.ambient is None else w.ambient,
        use_ambient=w.ambient is not None,
        map_resolution=w.map_resolution,
    )


def light(li):
    return abi.Light(
        name=_text(li.name),
        matrix=_row_major(li.matrix),
        kind=int(li.kind),
        emission=li.emission,
        radius=li.radius,
        soft_falloff=int(li.soft_falloff),
        spot_angle=li.spot_angle,
        spot_blend=li.spot_blend,
        spot_cosine=li.spot_cosine,
        sun_angle=li.sun_angle,
        sun_flat=li.sun_flat,
        size=li.size,
        shape=int(li.shape),
        spread=li.spread,
        hidden_from=int(li.hidden_from),
        no_shadow=int(li.no_shadow),
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
        aperture_blades=c.aperture_blades,
        window=c.window,
        panorama=c.panorama,
        clip_start=c.clip_start,
        clip_end=c.clip_end,
        lens_radius=c.lens_radius,
        focal_distance=c.focal_distance,
        aperture_rotation=c.aperture_rotation,
        aperture_ratio=c.aperture_ratio,
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
        transparent_glass=int(s.transparent_glass),
        glass_roughness=s.glass_roughness,
        transparent_bounces=s.transparent_bounces,
        transparent_shadows=s.transparent_shadows,
        alpha_threshold=s.alpha_threshold,
        environment_reflections=int(s.environment_reflections),
        occlusion_distance=s.occlusion_distance,
        mist_start=s.mist_start,
        mist_depth=s.mist_depth,
        mist_falloff=s.mist_falloff,
        blended_features=int(s.blended_features),
        features=int(s.features),
        passes=sum(1 << p for p in set(s.passes)),
        threads=s.threads,
        tile_size=s.tile_size,
        refines=int(s.refines),
    )
