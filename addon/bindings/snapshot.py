"""A scene as frozen dataclasses of C-contiguous arrays: test fixture, benchmark input, bug report and farm job in one.

Units and frames are those of lancer.h. Snapshots compare with == (NaN equals NaN: it is the same data) and know no bpy.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field

import numpy as np

from .enums import (
    Accelerator,
    AreaShape,
    CameraKind,
    Falloff,
    Features,
    InstanceKind,
    Integrator,
    LightKind,
    LobeKind,
    Pass,
    PixelFilter,
    Shading,
)
from .npz import load_npz, register, save_npz

_IDENTITY = np.eye(4)[:3]


def _array(value, dtype, shape, what):
    """value as a read-only C-contiguous array; shape may hold None for any length."""
    array = np.ascontiguousarray(value, dtype).view()
    if array.ndim != len(shape) or any(want is not None and want != got for want, got in zip(shape, array.shape, strict=True)):
        raise ValueError(f"{what} has shape {array.shape}, expected {shape}")
    array.flags.writeable = False
    return array


def _same(a, b):
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        if not (isinstance(a, np.ndarray) and isinstance(b, np.ndarray)):
            return False
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(_same(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, float) and isinstance(b, float) and math.isnan(a):
        return math.isnan(b)
    return a == b


class _Record:
    """Equality that understands arrays."""

    __hash__ = None

    def __eq__(self, other):
        if type(self) is not type(other):
            return NotImplemented
        return all(_same(getattr(self, f.name), getattr(other, f.name)) for f in dataclasses.fields(self))

    def _set(self, name, value):
        object.__setattr__(self, name, value)

    def _vectors(self, **lengths):
        for name, length in lengths.items():
            value = tuple(float(x) for x in getattr(self, name))
            if len(value) != length:
                raise ValueError(f"{type(self).__name__}.{name} has {len(value)} values, expected {length}")
            self._set(name, value)


@register
@dataclass(frozen=True, eq=False)
class MeshData(_Record):
    """A triangle mesh in object space."""

    name: str = ""
    positions: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))
    triangles: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.uint32))
    normals: np.ndarray | None = None  # (V, 3) at vertices or (T, 3, 3) at corners
    uvs: np.ndarray | None = None  # (T, 3, 2)
    colors: np.ndarray | None = None  # (T, 3, 3), linear
    material_slots: np.ndarray | None = None  # (T,)

    def __post_init__(self):
        what = f"mesh '{self.name}': "
        self._set("positions", _array(self.positions, np.float32, (None, 3), what + "positions"))
        self._set("triangles", _array(self.triangles, np.uint32, (None, 3), what + "triangles"))
        vertices, count = len(self.positions), len(self.triangles)
        if self.normals is not None:
            shape = (vertices, 3) if np.ndim(self.normals) == 2 else (count, 3, 3)
            self._set("normals", _array(self.normals, np.float32, shape, what + "normals"))
        if self.uvs is not None:
            self._set("uvs", _array(self.uvs, np.float32, (count, 3, 2), what + "uvs"))
        if self.colors is not None:
            self._set("colors", _array(self.colors, np.float32, (count, 3, 3), what + "colors"))
        if self.material_slots is not None:
            self._set("material_slots", _array(self.material_slots, np.uint16, (count,), what + "material_slots"))

    @classmethod
    def from_trimesh(cls, mesh, name="mesh", smooth=False):
        """A trimesh.Trimesh; smooth takes its vertex normals."""
        normals = mesh.vertex_normals if smooth else None
        uv = getattr(mesh.visual, "uv", None)
        uvs = None if uv is None else np.asarray(uv)[mesh.faces]
        return cls(name=name, positions=mesh.vertices, triangles=mesh.faces, normals=normals, uvs=uvs)


@dataclass(frozen=True)
class Instance:
    """One placed object as a convenience for InstanceTable.build; matrix is 3 x 4 or 4 x 4."""

    mesh: int = 0
    matrix: np.ndarray = field(default_factory=lambda: _IDENTITY)
    kind: int = InstanceKind.MESH
    materials: tuple = (0,)
    object_index: int = 0
    shading: int = Shading.AS_MESH
    name: str = ""


@register
@dataclass(frozen=True, eq=False)
class InstanceTable(_Record):
    """All placed objects, a column for each property; materials are slots[first_slot : first_slot + slot_count]."""

    matrices: np.ndarray = field(default_factory=lambda: np.empty((0, 3, 4)))
    kinds: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    meshes: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    first_slots: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    slot_counts: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    object_indices: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    shadings: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    name_indices: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))
    names: tuple = ()
    slots: np.ndarray = field(default_factory=lambda: np.empty(0, np.uint32))

    def __post_init__(self):
        count = len(self.matrices)
        self._set("matrices", _array(self.matrices, np.float64, (count, 3, 4), "matrices"))
        for name in ("kinds", "meshes", "first_slots", "slot_counts", "object_indices", "shadings", "name_indices"):
            self._set(name, _array(getattr(self, name), np.uint32, (count,), name))
        self._set("slots", _array(self.slots, np.uint32, (None,), "slots"))
        self._set("names", tuple(self.names))
        if count and int(self.name_indices.max()) >= len(self.names):
            raise ValueError(f"name index {int(self.name_indices.max())} >= {len(self.names)} names")

    def __len__(self):
        return len(self.matrices)

    @classmethod
    def build(cls, instances):
        """From a list of Instance (or of dicts with its fields); equal names and slots are kept once."""
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
            names=tuple(names),
            slots=slots,
        )


@register
@dataclass(frozen=True, eq=False)
class Lobe(_Record):
    kind: int = LobeKind.LAMBERT
    color: tuple = (0.8, 0.8, 0.8)
    roughness: float = 0.5  # alpha itself
    ior: float = 1.5
    shininess: float = 50.0

    def __post_init__(self):
        self._vectors(color=3)


@register
@dataclass(frozen=True, eq=False)
class Material(_Record):
    name: str = ""
    lobes: tuple = (Lobe(),)
    emission: tuple = (0.0, 0.0, 0.0)
    opacity: float = 1.0
    ambient: tuple = (0.0, 0.0, 0.0)
    material_index: int = 0

    def __post_init__(self):
        self._set("lobes", tuple(self.lobes))
        self._vectors(emission=3, ambient=3)


@register
@dataclass(frozen=True, eq=False)
class Light(_Record):
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
    size: tuple = (1.0, 1.0)
    shape: int = AreaShape.RECTANGLE
    spread: float = math.pi
    falloff: int = Falloff.PHYSICAL
    falloff_radius: float = 10.0
    ambient_color: tuple = (1.0, 1.0, 1.0)
    diffuse_color: tuple = (1.0, 1.0, 1.0)
    specular_color: tuple = (1.0, 1.0, 1.0)

    def __post_init__(self):
        self._set("matrix", _array(np.asarray(self.matrix, float)[:3], np.float64, (3, 4), f"light '{self.name}': matrix"))
        self._vectors(emission=3, size=2, ambient_color=3, diffuse_color=3, specular_color=3)


@register
@dataclass(frozen=True, eq=False)
class Camera(_Record):
    """window: left, right, bottom, top at z = -1 (perspective). The region is the whole image where not given."""

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

    def __post_init__(self):
        self._set("matrix", _array(np.asarray(self.matrix, float)[:3], np.float64, (3, 4), "camera matrix"))
        self._vectors(window=4)
        if self.region_width is None:
            self._set("region_width", self.width - self.x)
        if self.region_height is None:
            self._set("region_height", self.height - self.y)


@register
@dataclass(frozen=True, eq=False)
class Settings(_Record):
    integrator: int = Integrator.PATH
    samples: int = 16
    seed: int = 0
    max_bounces: int = 10
    contribution_threshold: float = 0.0
    clamp_indirect: float = 0.0
    pixel_filter: int = PixelFilter.BOX
    filter_width: float = 1.0
    film_transparent: bool = False
    features: int = Features.SCENE
    passes: tuple = (Pass.COMBINED,)
    threads: int = 0
    tile_size: int = 0
    accelerator: int = Accelerator.BVH

    def __post_init__(self):
        self._set("passes", tuple(int(p) for p in self.passes))


@register
@dataclass(frozen=True, eq=False)
class SceneSnapshot(_Record):
    meshes: tuple = ()
    instances: InstanceTable = field(default_factory=InstanceTable)
    materials: tuple = ()
    lights: tuple = ()
    world: tuple = (0.0, 0.0, 0.0)
    camera: Camera = field(default_factory=Camera)
    settings: Settings = field(default_factory=Settings)

    def __post_init__(self):
        for name in ("meshes", "materials", "lights"):
            self._set(name, tuple(getattr(self, name)))
        self._vectors(world=3)

    def save(self, path):
        save_npz(self, path)

    @classmethod
    def load(cls, path):
        snapshot = load_npz(path)
        if not isinstance(snapshot, cls):
            raise ValueError(f"{path} holds no scene snapshot")
        return snapshot
