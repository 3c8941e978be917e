"""The numbers of lancer.h."""

from enum import IntEnum


class Status(IntEnum):
    OK = 0
    RUNNING = 1
    CANCELLED = 2
    ERROR_ARGUMENT = 3
    ERROR_HANDLE = 4
    ERROR_STATE = 5
    ERROR_MEMORY = 6
    ERROR_INTERNAL = 7


class Struct(IntEnum):
    MESH = 0
    INSTANCE = 1
    PARAMETER = 2
    LOBE = 3
    MATERIAL = 4
    LIGHT = 5
    CAMERA = 6
    SETTINGS = 7
    PROGRESS = 8
    STATISTICS = 9
    HIT = 10
    VERTEX = 11
    LIGHT_SAMPLE = 12
    BSDF_SAMPLE = 13


class NormalDomain(IntEnum):
    NONE = 0
    VERTEX = 1
    CORNER = 2


class InstanceKind(IntEnum):
    MESH = 0
    SPHERE = 1
    PLANE = 2
    CYLINDER = 3
    CONE = 4


class Shading(IntEnum):
    AS_MESH = 0
    FLAT = 1
    GOURAUD = 2
    PHONG = 3


class LobeKind(IntEnum):
    LAMBERT = 0
    BECKMANN = 1
    MIRROR = 2
    DIELECTRIC = 3
    PHONG = 4
    BLINN_PHONG = 5


class LightKind(IntEnum):
    POINT = 0
    SPOT = 1
    SUN = 2
    AREA = 3


class AreaShape(IntEnum):
    RECTANGLE = 0
    ELLIPSE = 1


class Falloff(IntEnum):
    PHYSICAL = 0
    CONSTANT = 1
    LINEAR = 2
    QUADRATIC = 3
    SMOOTH = 4
    GAUSSIAN = 5


class Accelerator(IntEnum):
    BVH = 0
    KDTREE = 1
    BRUTE_FORCE = 2


class CameraKind(IntEnum):
    PERSPECTIVE = 0
    ORTHOGRAPHIC = 1


class Integrator(IntEnum):
    PATH = 0
    CLASSIC = 1
    NORMALS = 2


class PixelFilter(IntEnum):
    BOX = 0
    BLACKMAN_HARRIS = 1


class Features(IntEnum):
    SCENE = 0
    ALL = 1


class Pass(IntEnum):
    COMBINED = 0
    DEPTH = 1
    NORMAL = 2
    ALBEDO = 3
    POSITION = 4
    OBJECT_INDEX = 5
    MATERIAL_INDEX = 6

    @property
    def channels(self):
        return (4, 1, 3, 3, 3, 1, 1)[self]
