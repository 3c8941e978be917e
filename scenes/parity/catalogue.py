"""The list of parity scenes: a decorator enters a builder under its name, with the rules by which the scene is judged."""

import fnmatch
import importlib
from dataclasses import dataclass, field, replace

import bpy

from .figures import KINDS, Kind, Limit

# One file for each subject.
SUBJECTS = (
    "materials_principled",
    "materials_closures",
    "materials_portals",
    "materials_hair",
    "materials_subsurface",
    "materials_mixes",
    "furnaces",
    "furnaces_principled",
    "textures_images",
    "textures_files",
    "textures_cached",
    "textures_frames",
    "textures_tiles",
    "textures_coordinates",
    "inputs",
    "inputs_objects",
    "inputs_instances",
    "inputs_places",
    "zones",
    "zones_bundles",
    "left_out",
    "settings_of_nodes",
    "looking",
    "textures_normals",
    "textures_computed",
    "textures_patterns",
    "point_density",
    "lights_shapes",
    "lights_nodes",
    "lights_switches",
    "lights_exact",
    "lights_linked",
    "lights_portals",
    "worlds",
    "skies",
    "cameras",
    "objects",
    "motion",
    "subdivisions",
    "subdivisions_inputs",
    "films",
    "catchers",
    "light_paths",
    "fast_gi",
    "passes_light",
    "passes_data",
    "passes_vectors",
    "passes_chosen",
    "real_models",
)

CASES = {}


@dataclass(frozen=True)
class Case:
    name: str
    subject: str
    build: object  # build(scene) fills an empty scene
    kind_name: str = "EXACT"
    limit: Limit | None = None  # instead of the kind's
    reason: str = ""  # why that limit is looser
    since: tuple = (3, 4)  # the first Blender that has the feature
    until: tuple = (99, 0)  # the first Blender that lacks it again
    bounces: int = 2
    transparent_bounces: int = 32
    samples: int = 32  # initial number, for each half of each engine
    size: tuple = (96, 64)
    filter_width: float = 0.0  # 0: the box of one pixel; else the width of a Blackman-Harris filter
    passes: tuple = ("Combined",)  # by the names of Blender 5
    mattes: tuple = ()  # cryptomattes whose decoded mattes are compared, by the titles of their passes
    dark: tuple = ()  # the passes that must be black
    needs: object = None  # needs() returns "" or a sentence that names the missing requirement
    sum_of_passes: bool = False  # compare the sum of Lancer's passes with its Combined
    announced: str = ""  # words that one of Lancer's messages must contain; they excuse no difference
    exposure: float = 1.0  # of the film
    limited: dict = field(default_factory=dict)  # settings of Cycles that limit light; Lancer gets the same
    simplify: bool = False  # whether Simplify is on
    quick: bool = False  # belongs to the subset of `make test`

    @property
    def kind(self) -> Kind:
        return KINDS[self.kind_name]

    @property
    def limits(self) -> Limit:
        return self.limit or self.kind.limit


def case(kind_name="EXACT", *, name=None, limit=None, reason="", blender3=None, **fields):
    """Returns a decorator for build(scene); the scene's name is the function's.

    blender3: (limit, reason) for Blender 3, followed by words that a message must contain there, if any."""
    if blender3 and bpy.app.version < (4, 0):
        limit, reason, *words = blender3
        if words:
            fields["announced"] = words[0]
    if (limit is None) != (not reason):
        raise ValueError(f"{name}: a limit needs a reason, and a reason a limit")

    def enter(build):
        key = name or build.__name__
        if key in CASES:
            raise ValueError(f"two scenes have the name {key}")
        subject = build.__module__.rpartition(".")[2]
        CASES[key] = Case(key, subject, build, kind_name, Limit(*limit) if limit else None, reason, **fields)
        return build

    return enter


def variants(kind_name="EXACT", *, values, **fields):
    """Returns a decorator for build(scene, value): one scene for each {suffix: value}; value may be (value, its fields)."""

    def enter(build):
        for suffix, value in values.items():
            more = {}
            if isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], dict):
                value, more = value
            entry = _bind(build, value)
            case(kind_name, name=f"{build.__name__}_{suffix}", **{**fields, **more})(entry)
        return build

    return enter


def _bind(build, value):
    def entry(scene):
        return build(scene, value)

    entry.__module__ = build.__module__
    entry.__doc__ = build.__doc__
    return entry


def load():
    """Returns all cases by name, subject after subject."""
    for subject in SUBJECTS:
        importlib.import_module(f"{__package__}.{subject}")
    return CASES


def select(pattern="", quick=False):
    """Returns the cases whose name or subject matches one of the comma-separated patterns."""
    patterns = [part.strip() for part in pattern.split(",") if part.strip()] or ["*"]
    return [
        item
        for item in load().values()
        if any(fnmatch.fnmatchcase(text, p) for text in (item.name, item.subject) for p in patterns)
        and (item.quick or not quick)
    ]


def smaller(item):
    """Returns the case as `make test` renders it: a quarter of the blocks where there are many, few samples."""
    width, height = item.size
    if item.kind.relative or not item.kind.averages:
        return item
    return replace(item, size=(width // 2 // 8 * 8, height // 2 // 8 * 8))
