"""Meshes and instances of a snapshot: arrays in object space, and a column for each property of the instances. No bpy."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .enums import Domain, InstanceKind, Shading
from .npz import register
from .record import Record, array

_IDENTITY = np.eye(4)[:3]


@register
@dataclass(frozen=True, eq=False)
class MeshAttribute(Record):
    """values: (n, channels); n is the number of vertices, of triangles, or 3 times that of triangles, by domain."""

    name: str = ""
    values: np.ndarray = field(default_factory=lambda: np.empty((0, 1), np.float32))
    domain: int = Domain.CORNER

    def __post_init__(self):
        self.set("values", array(self.values, np.float32, (None, None), f"attribute '{self.name}'"))


@register
@dataclass(frozen=True, eq=False)
class MeshData(Record):
    """A triangle mesh in object space."""

    name: str = ""
    positions: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))
    triangles: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.uint32))
    normals: np.ndarray | None = None  # (V, 3) at vertices or (T, 3, 3) at corners
    uvs: np.ndarray | None = None  # (T, 3, 2)
    colors: np.ndarray | None = None  # (T, 3, 3), linear
    material_slots: np.ndarray | None = None  # (T,)
    polygons: np.ndarray | None = None  # (T,), each below T: the polygon of each triangle; None: one polygon per triangle
    attributes: tuple[MeshAttribute, ...] = ()
    moved_positions: np.ndarray | None = None  # (K, V, 3) of a mesh that changes its shape, at the keys of a Motion
    moved_normals: np.ndarray | None = None  # (K,) + those of normals; None: the normals keep
    vector_positions: np.ndarray | None = None  # (2, V, 3) one frame before and one after, for Pass.VECTOR

    def __post_init__(self):
        what = f"mesh '{self.name}': "
        self.set("positions", array(self.positions, np.float32, (None, 3), what + "positions"))
        self.set("triangles", array(self.triangles, np.uint32, (None, 3), what + "triangles"))
        vertices, count = len(self.positions), len(self.triangles)
        if self.normals is not None:
            shape = (vertices, 3) if np.ndim(self.normals) == 2 else (count, 3, 3)
            self.set("normals", array(self.normals, np.float32, shape, what + "normals"))
        if self.uvs is not None:
            self.set("uvs", array(self.uvs, np.float32, (count, 3, 2), what + "uvs"))
        if self.colors is not None:
            self.set("colors", array(self.colors, np.float32, (count, 3, 3), what + "colors"))
        if self.material_slots is not None:
            self.set("material_slots", array(self.material_slots, np.uint16, (count,), what + "material_slots"))
        if self.polygons is not None:
            self.set("polygons", array(self.polygons, np.uint32, (count,), what + "polygons"))
        if self.moved_positions is not None:
            shape = (None, vertices, 3)
            self.set("moved_positions", array(self.moved_positions, np.float32, shape, what + "moved_positions"))
        if self.moved_normals is not None:
            shape = (len(self.moved_positions), *np.shape(self.normals))
            self.set("moved_normals", array(self.moved_normals, np.float32, shape, what + "moved_normals"))
        if self.vector_positions is not None:
            shape = (2, vertices, 3)
            self.set("vector_positions", array(self.vector_positions, np.float32, shape, what + "vector_positions"))
        self.set("attributes", tuple(self.attributes))
        rows = {Domain.VERTEX: vertices, Domain.FACE: count, Domain.CORNER: 3 * count}
        for attribute in self.attributes:
            if len(attribute.values) != rows.get(attribute.domain):
                where = f"domain {int(attribute.domain)}"
                raise ValueError(f"{what}attribute '{attribute.name}' has {len(attribute.values)} rows in {where}")

    @classmethod
    def from_trimesh(cls, mesh, name="mesh", smooth=False):
        """Convert a trimesh.Trimesh; smooth uses its vertex normals."""
        normals = mesh.vertex_normals if smooth else None
        uv = getattr(mesh.visual, "uv", None)
        uvs = None if uv is None else np.asarray(uv)[mesh.faces]
        return cls(name=name, positions=mesh.vertices, triangles=mesh.faces, normals=normals, uvs=uvs)


@dataclass(frozen=True)
class Instance:
    """One instance, for InstanceTable.build; matrix is 3 x 4 or 4 x 4."""

    mesh: int = 0
    matrix: np.ndarray = field(default_factory=lambda: _IDENTITY)
    kind: int = InstanceKind.MESH
    materials: tuple = (0,)
    object_index: int = 0
    shading: int = Shading.AS_MESH
    name: str = ""
    hidden_from: int = 0  # Ray bits
    flags: int = 0  # InstanceFlag bits
    terminator: float = 0.0  # cosine; 0 = shadow rays start on the triangle
    object_matte: int = 0  # ids of its mattes; 0 = none
    asset_matte: int = 0
    light_group: int = 0  # of its own light, 1 is the first; 0 = none
    links: tuple = (0, 0, 0, 0)  # see InstanceTable


@register
@dataclass(frozen=True, eq=False)
class ObjectAttribute(Record):
    """values: (instances, 4), for OBJECT_INFO nodes with this name."""

    name: str = ""
    values: np.ndarray = field(default_factory=lambda: np.empty((0, 4), np.float32))

    def __post_init__(self):
        self.set("values", array(self.values, np.float32, (None, 4), f"object attribute '{self.name}'"))


@register
@dataclass(frozen=True, eq=False)
class InstanceMotion(Record):
    """Instances that move: their numbers (n,), and their matrices (n, K, 3, 4) at the keys of a Motion."""

    instances: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    matrices: np.ndarray = field(default_factory=lambda: np.empty((0, 3, 3, 4)))

    def __post_init__(self):
        self.set("instances", array(self.instances, np.uint32, (None,), "moving instances"))
        shape = (len(self.instances), None, 3, 4)
        self.set("matrices", array(self.matrices, np.float64, shape, "matrices of moving instances"))


@register
@dataclass(frozen=True, eq=False)
class InstanceVectors(Record):
    """Instances that move from frame to frame: their numbers (n,), and their matrices (n, 2, 3, 4) before and after."""

    instances: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    matrices: np.ndarray = field(default_factory=lambda: np.empty((0, 2, 3, 4)))

    def __post_init__(self):
        self.set("instances", array(self.instances, np.uint32, (None,), "instances with vectors"))
        shape = (len(self.instances), 2, 3, 4)
        self.set("matrices", array(self.matrices, np.float64, shape, "matrices of instances with vectors"))


_INSTANCE_COLUMNS = (
    "kinds", "meshes", "first_slots", "slot_counts", "object_indices", "shadings", "name_indices", "hidden_from", "flags",
)  # fmt: skip


@register
@dataclass(frozen=True, eq=False)
class InstanceTable(Record):
    """All instances, a column for each property; materials are slots[first_slot : first_slot + slot_count]."""

    matrices: np.ndarray = field(default_factory=lambda: np.empty((0, 3, 4)))
    kinds: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    meshes: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    first_slots: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    slot_counts: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    object_indices: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    shadings: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    name_indices: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    hidden_from: np.ndarray | None = None  # zeros if not given
    flags: np.ndarray | None = None
    terminators: np.ndarray | None = None  # float
    # Ids of mattes and numbers of light groups, see Instance; None: none of any instance.
    object_mattes: np.ndarray | None = None
    asset_mattes: np.ndarray | None = None
    light_groups: np.ndarray | None = None
    infos: np.ndarray | None = None  # (n, 5): colour, alpha and random number for OBJECT_INFO; None: white and 0
    links: np.ndarray | None = None  # (n, 4): receiver_set, blocker_set, unlit_sets, clear_sets; None: all 0
    fast_distances: np.ndarray | None = None  # (n,), of Fast GI; None: all 0
    attributes: tuple[ObjectAttribute, ...] = ()
    names: tuple[str, ...] = ()
    asset_names: tuple[str, ...] = ()  # of which asset_mattes has the ids
    slots: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    motions: tuple[InstanceMotion, ...] = ()  # one for each number of keys
    vectors: InstanceVectors | None = None  # for Pass.VECTOR; None: all stand still

    def __post_init__(self):
        count = len(self.matrices)
        self.set("matrices", array(self.matrices, np.float64, (count, 3, 4), "matrices"))
        for name in ("hidden_from", "flags"):
            if getattr(self, name) is None:
                self.set(name, np.zeros(count, np.uint32))
        if self.terminators is None:
            self.set("terminators", np.zeros(count, np.float32))
        self.set("terminators", array(self.terminators, np.float32, (count,), "terminators"))
        if self.infos is not None:
            self.set("infos", array(self.infos, np.float32, (count, 5), "infos"))
        for name in ("object_mattes", "asset_mattes", "light_groups"):
            if getattr(self, name) is not None:
                self.set(name, array(getattr(self, name), np.uint32, (count,), name))
        if self.fast_distances is not None:
            self.set("fast_distances", array(self.fast_distances, np.float32, (count,), "fast_distances"))
        if self.links is not None:
            self.set("links", array(self.links, np.uint64, (count, 4), "links"))
        for name in _INSTANCE_COLUMNS:
            self.set(name, array(getattr(self, name), np.uint32, (count,), name))
        self.set("slots", array(self.slots, np.uint32, (None,), "slots"))
        self.set("names", tuple(self.names))
        self.set("asset_names", tuple(self.asset_names))
        self.set("attributes", tuple(self.attributes))
        self.set("motions", tuple(self.motions))
        for motion in (*self.motions, *([] if self.vectors is None else [self.vectors])):
            if len(motion.instances) and int(motion.instances.max()) >= count:
                raise ValueError(f"moving instance {int(motion.instances.max())} >= {count} instances")
        for attribute in self.attributes:
            if len(attribute.values) != count:
                raise ValueError(f"object attribute '{attribute.name}' has {len(attribute.values)} rows for {count} instances")
        if count and int(self.name_indices.max()) >= len(self.names):
            raise ValueError(f"name index {int(self.name_indices.max())} >= {len(self.names)} names")

    def __len__(self):
        return len(self.matrices)

    @classmethod
    def build(cls, instances):
        """Build the table from Instances, or dicts of their fields; equal names and slots are stored once."""
        instances = [Instance(**i) if isinstance(i, dict) else i for i in instances]
        names, slot_starts, slots = {}, {}, []
        for instance in instances:
            names.setdefault(instance.name, len(names))
            key = tuple(instance.materials)
            if key not in slot_starts:
                slot_starts[key] = len(slots)
                slots.extend(key)
        return cls(
            matrices=np.array([np.asarray(i.matrix, float)[:3] for i in instances]).reshape(-1, 3, 4),
            kinds=[i.kind for i in instances],
            meshes=[i.mesh for i in instances],
            first_slots=[slot_starts[tuple(i.materials)] for i in instances],
            slot_counts=[len(i.materials) for i in instances],
            object_indices=[i.object_index for i in instances],
            shadings=[i.shading for i in instances],
            name_indices=[names[i.name] for i in instances],
            hidden_from=[i.hidden_from for i in instances],
            flags=[i.flags for i in instances],
            terminators=[i.terminator for i in instances],
            object_mattes=[i.object_matte for i in instances],
            asset_mattes=[i.asset_matte for i in instances],
            light_groups=[i.light_group for i in instances],
            links=np.array([i.links for i in instances], np.uint64) if any(any(i.links) for i in instances) else None,
            names=tuple(names),
            slots=slots,
        )
