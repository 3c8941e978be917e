"""A scene as frozen dataclasses of C-contiguous arrays, for rendering, tests, benchmarks and bug reports. No bpy.

lancer.h defines units and frames. Snapshots compare by value; NaN equals NaN.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, make_dataclass

import numpy as np

from . import structs
from .enums import (
    Accelerator,
    AreaShape,
    CameraKind,
    Domain,
    Falloff,
    InstanceKind,
    LightKind,
    Pass,
    Ray,
    Shading,
)
from .npz import SnapshotError, load_npz, register, save_npz
from .record import Record, Sets, array
from .shading import (  # noqa: F401 - all records have one address
    Image,
    Lobe,
    Material,
    Node,
    NodeRef,
    Output,
    Parameters,
    Portal,
    Principled,
    World,
)
from .structs import SETTINGS

_IDENTITY = np.eye(4)[:3]
_ZEROS = np.zeros((3, 4))


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


@register
@dataclass(frozen=True, eq=False)
class Light(Parameters, struct=structs.Light):
    name: str = ""
    matrix: np.ndarray = field(default_factory=lambda: _IDENTITY)
    kind: int = LightKind.POINT
    emission: tuple = (1.0, 1.0, 1.0)
    radius: float = 0.0
    soft_falloff: bool = True
    spot_angle: float = math.radians(45.0)
    spot_blend: float = 0.15
    spot_cosine: bool = False
    sun_angle: float = 0.0
    sun_flat: bool = False
    size: tuple = (1.0, 1.0)
    shape: int = AreaShape.RECTANGLE
    spread: float = math.pi
    falloff: int = Falloff.PHYSICAL
    falloff_radius: float = 10.0
    ambient_color: tuple = (1.0, 1.0, 1.0)
    diffuse_color: tuple = (1.0, 1.0, 1.0)
    specular_color: tuple = (1.0, 1.0, 1.0)
    hidden_from: int = Ray.CAMERA  # bits; by default lamps are invisible to the camera
    no_shadow: bool = False
    no_catchers: bool = False
    light_group: int = 0  # 1 is the first; 0 = none
    lit_surfaces: int = 0  # 0: all
    unlit_sets: Sets = 0
    clear_sets: Sets = 0
    strength: object
    nodes: tuple[Node, ...] = ()

    def __post_init__(self):
        super().__post_init__()
        self.set("nodes", tuple(self.nodes))
        self.set("matrix", array(np.asarray(self.matrix, float)[:3], np.float64, (3, 4), f"light '{self.name}': matrix"))
        self.vectors(emission=3, size=2, ambient_color=3, diffuse_color=3, specular_color=3)


@register
@dataclass(frozen=True, eq=False)
class Camera(Record):
    """window: left, right, bottom, top at z = -1 (perspective). The region is the whole image if not given."""

    matrix: np.ndarray = field(default_factory=lambda: _IDENTITY)
    kind: int = CameraKind.PERSPECTIVE
    width: int = 64
    height: int = 64
    x: int = 0
    y: int = 0
    region_width: int | None = None
    region_height: int | None = None
    window: tuple = (-0.5, 0.5, -0.5, 0.5)
    clip_start: float = 1e-3
    clip_end: float = 1e6
    lens_radius: float = 0.0
    focal_distance: float = 1.0
    aperture_blades: int = 0
    aperture_rotation: float = 0.0
    aperture_ratio: float = 1.0
    panorama: tuple = (0.0,) * 8  # parameters of the panoramic kinds
    # Spherical stereo
    eye_offset: float = 0.0
    convergence_distance: float = 0.0
    pole_merge_from: float = 0.0
    pole_merge_to: float = 0.0
    # One frame before and one after, for Pass.VECTOR; a matrix of zeros: those of the picture
    matrix_before: np.ndarray = field(default_factory=lambda: _ZEROS)
    matrix_after: np.ndarray = field(default_factory=lambda: _ZEROS)
    window_before: tuple = (0.0,) * 4
    window_after: tuple = (0.0,) * 4

    def __post_init__(self):
        for name in ("matrix", "matrix_before", "matrix_after"):
            self.set(name, array(np.asarray(getattr(self, name), float)[:3], np.float64, (3, 4), f"camera {name}"))
        self.vectors(window=4, panorama=8, window_before=4, window_after=4)
        if self.region_width is None:
            self.set("region_width", self.width - self.x)
        if self.region_height is None:
            self.set("region_height", self.height - self.y)


@register
@dataclass(frozen=True, eq=False)
class Motion(Record):
    """The shutter, and the camera at keys, at equal steps from its opening to its closing; see lancer_motion."""

    shutter: np.ndarray | None = None  # how far it is open, at equal steps; None: all samples are of the middle time
    keys: tuple[Camera, ...] = ()  # none: the camera stands still
    rolling: bool = False
    rolling_duration: float = 0.1

    def __post_init__(self):
        if self.shutter is not None:
            self.set("shutter", array(self.shutter, np.float32, (None,), "shutter"))
        self.set("keys", tuple(self.keys))


# The members of lancer_settings with their defaults; refines follows from the other settings.
_CoreSettings = make_dataclass(
    "_CoreSettings",
    [(name, type(given), given) for name, (_, given) in SETTINGS.items() if name != "refines"],
    bases=(Record,),
    frozen=True,
    eq=False,
)


@register
@dataclass(frozen=True, eq=False)
class Settings(_CoreSettings):
    """The settings of lancer.h under the same names, and when a render ends."""

    passes: tuple = (Pass.COMBINED,)  # of enums.Pass
    target_error: float = 0.0  # relative; 0 = off
    time_limit: float = 0.0  # s; 0 = off
    accelerator: int = Accelerator.BVH
    in_parts: bool = False  # whether sessions render or join parts of the picture

    def __post_init__(self):
        self.set("passes", tuple(int(Pass(p)) for p in self.passes))

    @property
    def refines(self):
        """Whether pixels may get different numbers of samples."""
        return self.target_error > 0.0 or self.time_limit > 0.0 or self.in_parts


@register
@dataclass(frozen=True, eq=False)
class SceneSnapshot(Record):
    meshes: tuple[MeshData, ...] = ()
    instances: InstanceTable = field(default_factory=InstanceTable)
    materials: tuple[Material, ...] = ()
    lights: tuple[Light, ...] = ()
    images: tuple[Image, ...] = ()
    world: World = field(default_factory=World)  # or its constant radiance
    camera: Camera = field(default_factory=Camera)
    settings: Settings = field(default_factory=Settings)
    motion: Motion | None = None  # None: everything is shown as it stands

    def __post_init__(self):
        for name in ("meshes", "materials", "lights", "images"):
            self.set(name, tuple(getattr(self, name)))
        if not isinstance(self.world, World):
            self.set("world", World(radiance=self.world))

    def save(self, path):
        """Write the snapshot to a path or an open binary file."""
        save_npz(self, path)

    @classmethod
    def load(cls, path):
        """Return the snapshot in a path or an open binary file; raise SnapshotError if it holds no valid one."""
        snapshot = load_npz(path)
        if not isinstance(snapshot, cls):
            raise SnapshotError(f"{path} holds no scene snapshot: it holds a {type(snapshot).__name__}")
        return snapshot
