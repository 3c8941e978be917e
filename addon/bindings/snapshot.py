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
    Falloff,
    LightKind,
    Pass,
    PassKind,
    Ray,
)
from .geometry import (  # noqa: F401 - all records have one address
    Instance,
    InstanceMotion,
    InstanceTable,
    InstanceVectors,
    MeshAttribute,
    MeshData,
    ObjectAttribute,
)
from .npz import SnapshotError, load_npz, register, save_npz
from .numbered_pass import NumberedPass
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
    opening: bool = False
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
class NamedPass(Record):
    """A NumberedPass of a picture, with its name in files and the letters of its channels."""

    name: str = ""
    channels: str = ""
    kind: int = PassKind.SHADOW_CATCHER
    number: int = 0

    def __post_init__(self):
        if len(self.channels) != PassKind(self.kind).channels:
            raise ValueError(
                f"pass '{self.name}' has the channels '{self.channels}', and {PassKind(self.kind).channels} values"
            )

    @property
    def source(self):
        return NumberedPass(PassKind(self.kind), self.number)


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
    named_passes: tuple[NamedPass, ...] = ()  # those of settings.mattes, light_groups, aov_* and catchers that files have

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
