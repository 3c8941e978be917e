"""Materials, nodes, images and the world as records of a snapshot. lancer.h defines meanings, units and frames.

A parameter is a number, three numbers, or a NodeRef: the result of a node of the same material or world.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from . import structs
from .blocks import Blocks
from .enums import AlphaMode, Distribution, LobeKind, NodeKind, Rules, Transfer
from .npz import register
from .record import Record, array

_TEXELS = (np.uint8, np.uint16, np.float32)


@register
@dataclass(frozen=True)
class NodeRef:
    """The result of node number `node`."""

    node: int


def _parameter(value):
    if isinstance(value, NodeRef):
        return value
    return tuple(float(x) for x in value) if isinstance(value, (tuple, list, np.ndarray)) else float(value)


class Parameters(Record):
    """A record with the parameters of a struct of lancer.h and their defaults."""

    PARAMETERS = ()

    def __init_subclass__(cls, struct):
        cls.PARAMETERS = tuple(structs.PARAMETERS[struct])
        for name, (_, default) in structs.PARAMETERS[struct].items():
            cls.__annotations__.setdefault(name, object)
            setattr(cls, name, default)

    def __post_init__(self):
        values = vars(self)
        for name in self.PARAMETERS:
            # Most parameters are floats, and a scene may have a hundred thousand.
            if type(values[name]) is not float:
                values[name] = _parameter(values[name])


@register
@dataclass(frozen=True, eq=False)
class Image(Record):
    """texels: (height, width, channels) of uint8, uint16 or float32, row 0 at the bottom; 1, 3 or 4 channels. Or Blocks."""

    name: str = ""
    texels: np.ndarray | Blocks = field(default_factory=lambda: np.zeros((1, 1, 4), np.uint8))
    transfer: int = Transfer.LINEAR
    alpha: int = AlphaMode.STRAIGHT
    tile: int = 0  # UDIM number; 0 for an image without tiles
    matrix: tuple = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)  # decoded RGB to the working space, row-major
    mipmaps: int = 0  # 1: a ray reads the level whose texels are as large as what it sees; Blocks are followed by the others

    def __post_init__(self):
        self.vectors(matrix=9)
        if isinstance(self.texels, Blocks):
            return
        texels = np.asarray(self.texels)
        if texels.dtype not in _TEXELS:
            raise ValueError(f"image '{self.name}': texels are {texels.dtype}, expected uint8, uint16 or float32")
        if texels.ndim != 3 or texels.shape[2] not in (1, 3, 4):
            raise ValueError(f"image '{self.name}': texels have shape {texels.shape}, expected (height, width, 1, 3 or 4)")
        self.set("texels", array(texels, texels.dtype, (None, None, None), f"image '{self.name}'"))


@register
@dataclass(frozen=True, eq=False)
class Node(Record):
    kind: int = NodeKind.COORDINATE
    option: int = 0
    flags: int = 0
    image: int = 0
    image_count: int = 0
    first: int = 0
    name: str = ""
    inputs: tuple[object, ...] = ()  # up to five parameters
    matrix: tuple = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)

    def __post_init__(self):
        self.set("inputs", tuple(_parameter(value) for value in self.inputs))
        if len(self.inputs) > 5:
            raise ValueError(f"node has {len(self.inputs)} inputs, at most 5")
        self.vectors(matrix=12)


@register
@dataclass(frozen=True, eq=False)
class Principled(Parameters, struct=structs.Principled):
    rules: int = Rules.BLENDER_45
    distribution: int = Distribution.MULTI_GGX
    option: int = 1
    subsurface_option: int = 0


@register
@dataclass(frozen=True, eq=False)
class Lobe(Parameters, struct=structs.Lobe):
    kind: int = LobeKind.LAMBERT
    color: object
    distribution: int = Distribution.GGX
    option: int = 0
    rules: int = Rules.BLENDER_45
    principled: Principled | None = None


@register
@dataclass(frozen=True, eq=False)
class Portal(Parameters, struct=structs.Portal):
    moves: int = 0


@register
@dataclass(frozen=True, eq=False)
class Output(Parameters, struct=structs.Output):
    """A value that goes into the pass AOV_COLOR or AOV_VALUE of this number."""

    number: int = 0
    is_color: bool = True


@register
@dataclass(frozen=True, eq=False)
class Material(Parameters, struct=structs.Material):
    name: str = ""
    lobes: tuple[Lobe, ...] = (Lobe(),)
    portals: tuple[Portal, ...] = ()
    outputs: tuple[Output, ...] = ()
    nodes: tuple[Node, ...] = ()
    flags: int = 0  # MaterialFlag
    material_index: int = 0
    matte: int = 0  # id of its matte; 0 = none

    def __post_init__(self):
        super().__post_init__()
        self.set("lobes", tuple(self.lobes))
        self.set("portals", tuple(self.portals))
        self.set("outputs", tuple(self.outputs))
        self.set("nodes", tuple(self.nodes))


@register
@dataclass(frozen=True, eq=False)
class World(Parameters, struct=structs.World):
    radiance: object
    nodes: tuple[Node, ...] = ()
    outputs: tuple[Output, ...] = ()
    light_group: int = 0  # 1 is the first; 0 = none
    hidden_from: int = 0  # Ray bits
    map_resolution: int = 0
    lit_surfaces: int = 0  # 0: all
    ambient: tuple | None = None  # ambient light, which Ka reflects in CLASSIC; None: the mean of the radiance

    def __post_init__(self):
        super().__post_init__()
        if self.ambient is not None:
            self.vectors(ambient=3)
        self.set("outputs", tuple(self.outputs))
        self.set("nodes", tuple(self.nodes))
