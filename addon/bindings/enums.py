"""The numbers of the interface.

Generated from core/include/lancer.h by `make bindings`; changes here are lost.
"""

from enum import IntEnum, IntFlag

ABI_VERSION = 15
MOST_NODE_RAYS = 128
MOST_NODES = 4096
DEEPEST_RECURSION = 16
MOST_MATTES = 64
PASS_SPAN = 4096
NODE_STEADY = 2147483648
SKY_WIDTH = 512


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
    ATTRIBUTE = 14
    IMAGE = 15
    NODE = 16
    PRINCIPLED = 17
    WORLD = 18
    LOBE_INFO = 19
    ERROR = 20
    DENOISED_ERROR = 21
    RANGE = 22
    PART = 23
    PORTAL = 24
    MADE = 25
    MOTION = 26
    OUTPUT = 27
    TEXEL = 28
    BAKE = 29


class NormalDomain(IntEnum):
    NONE = 0
    VERTEX = 1
    CORNER = 2


class Domain(IntEnum):
    """The elements of a mesh that carry one value each."""

    VERTEX = 0
    FACE = 1
    CORNER = 2


class InstanceKind(IntEnum):
    """Exact surfaces are defined in a unit frame; the instance's matrix translates, scales and shears them."""

    MESH = 0
    SPHERE = 1
    PLANE = 2
    CYLINDER = 3
    CONE = 4


class Shading(IntEnum):
    """How normals are used, and where CLASSIC computes light."""

    AS_MESH = 0
    FLAT = 1
    GOURAUD = 2
    PHONG = 3


class Ray(IntFlag):
    """Rays by their origin."""

    CAMERA = 1
    DIFFUSE = 2
    GLOSSY = 4
    TRANSMISSION = 8
    SHADOW = 16
    VOLUME = 32
    RAYCAST = 64


class InstanceFlag(IntFlag):
    """A shadow catcher is an object that stands for one in footage."""

    HOLDOUT = 1
    CATCHER = 2


class TexelKind(IntEnum):
    U8 = 0
    U16 = 1
    FLOAT = 2


class Transfer(IntEnum):
    """Conversion of an interpolated texel to scene-linear colour."""

    LINEAR = 0
    SRGB = 1


class AlphaMode(IntEnum):
    """Meaning of the fourth channel."""

    ASSOCIATED = 0
    STRAIGHT = 1
    CHANNEL_PACKED = 2
    NONE = 3


class Layout(IntEnum):
    """Order of texels."""

    ROWS = 0
    BLOCKS = 1


class NodeKind(IntEnum):
    """Nodes compute values at the hit of a ray."""

    COORDINATE = 0
    ATTRIBUTE = 1
    IMAGE = 2
    ENVIRONMENT = 3
    ALPHA = 4
    MAPPING = 5
    TRANSFORM = 6
    MATH = 7
    VECTOR_MATH = 8
    MIX = 9
    SEPARATE = 10
    COMBINE = 11
    GREY = 12
    FRESNEL = 13
    LAYER_WEIGHT = 14
    NORMAL_MAP = 15
    BUMP = 16
    TANGENT = 17
    CLAMP = 18
    DISPLACEMENT = 19
    GAMMA = 20
    INVERT = 21
    NOISE = 22
    VORONOI = 23
    GRADIENT = 24
    CURVES = 25
    OBJECT_INFO = 26
    LIGHT_PATH = 27
    COLOR_MODEL = 28
    WAVE = 29
    MAGIC = 30
    CHECKER = 31
    BRICK = 32
    WHITE_NOISE = 33
    GABOR = 34
    RADIAL_TILING = 35
    WIREFRAME = 36
    VECTOR_TRANSFORM = 37
    IES = 38
    SKY = 39
    OCCLUSION = 40
    BEVEL = 41
    RAYCAST = 42
    VOXELS = 43


class SkyModel(IntEnum):
    """Models of the sky."""

    PREETHAM = 0
    HOSEK_WILKIE = 1
    NISHITA = 2
    SINGLE_SCATTERING = 3
    MULTIPLE_SCATTERING = 4


class Profile(IntEnum):
    SIN = 0
    SAW = 1
    TRI = 2


class Wave(IntEnum):
    """Bands across an axis, or rings around it."""

    BANDS_X = 0
    BANDS_Y = 1
    BANDS_Z = 2
    BANDS_DIAGONAL = 3
    RINGS_X = 4
    RINGS_Y = 5
    RINGS_Z = 6
    RINGS_SPHERICAL = 7


class Space(IntEnum):
    WORLD = 0
    OBJECT = 1
    CAMERA = 2


class AttributeFlag(IntFlag):
    OPAQUE = 1
    FIRST = 2
    STILL = 4


class ColorModel(IntEnum):
    """Conversion between linear RGB and hue, saturation and value (HSV) or lightness (HSL)."""

    TO_HSV = 0
    FROM_HSV = 1
    TO_HSL = 2
    FROM_HSL = 3


class ObjectFact(IntEnum):
    LOCATION = 0
    COLOR = 1
    INDEX = 2
    RANDOM = 3
    ATTRIBUTE = 4


class PathFact(IntEnum):
    """Facts about the ray of a hit."""

    IS_CAMERA = 0
    IS_SHADOW = 1
    IS_DIFFUSE = 2
    IS_GLOSSY = 3
    IS_SINGULAR = 4
    IS_REFLECTION = 5
    IS_TRANSMISSION = 6
    IS_VOLUME = 7
    LENGTH = 8
    DEPTH = 9
    DIFFUSE_DEPTH = 10
    GLOSSY_DEPTH = 11
    TRANSPARENT_DEPTH = 12
    TRANSMISSION_DEPTH = 13
    PORTAL_DEPTH = 14


class NoiseKind(IntEnum):
    FBM = 0
    MULTIFRACTAL = 1
    HYBRID_MULTIFRACTAL = 2
    RIDGED_MULTIFRACTAL = 3
    HETERO_TERRAIN = 4


class NoiseFlag(IntFlag):
    NORMALIZED = 4
    REPEATS = 8
    COUNTED = 16
    COLOR = 32


class VoronoiFeature(IntEnum):
    F1 = 0
    F2 = 1
    SMOOTH_F1 = 2
    DISTANCE_TO_EDGE = 3
    N_SPHERE_RADIUS = 4


class VoronoiMetric(IntEnum):
    EUCLIDEAN = 0
    MANHATTAN = 1
    CHEBYCHEV = 2
    MINKOWSKI = 3


class VoronoiFlag(IntFlag):
    NORMALIZED = 16
    COLOR = 32
    POSITION = 64
    INTEGERS = 128
    BOUNDED = 256


class GradientKind(IntEnum):
    LINEAR = 0
    QUADRATIC = 1
    EASING = 2
    DIAGONAL = 3
    SPHERICAL = 4
    QUADRATIC_SPHERE = 5
    RADIAL = 6


class Coordinate(IntEnum):
    GENERATED = 0
    NORMAL = 1
    UV = 2
    OBJECT = 3
    CAMERA = 4
    WINDOW = 5
    REFLECTION = 6
    POSITION = 7
    SHADING_NORMAL = 8
    TRUE_NORMAL = 9
    INCOMING = 10
    BACKFACING = 11
    PARAMETRIC = 12
    FROM_CAMERA = 13
    EDGE_U = 14
    EDGE_V = 15


class Projection(IntEnum):
    FLAT = 0
    BOX = 1
    SPHERE = 2
    TUBE = 3


class Extension(IntEnum):
    REPEAT = 0
    EXTEND = 1
    CLIP = 2
    MIRROR = 3


class Interpolation(IntEnum):
    LINEAR = 0
    CLOSEST = 1
    CUBIC = 2


class Environment(IntEnum):
    EQUIRECTANGULAR = 0
    MIRROR_BALL = 1
    CUBE = 2


class MappingType(IntEnum):
    POINT = 0
    TEXTURE = 1
    VECTOR = 2
    NORMAL = 3


class MathOperation(IntEnum):
    """As in Blender's nodes of these names."""

    ADD = 0
    SUBTRACT = 1
    MULTIPLY = 2
    DIVIDE = 3
    MULTIPLY_ADD = 4
    POWER = 5
    LOGARITHM = 6
    SQRT = 7
    INVERSE_SQRT = 8
    ABSOLUTE = 9
    EXPONENT = 10
    MINIMUM = 11
    MAXIMUM = 12
    LESS_THAN = 13
    GREATER_THAN = 14
    SIGN = 15
    COMPARE = 16
    SMOOTH_MIN = 17
    SMOOTH_MAX = 18
    ROUND = 19
    FLOOR = 20
    CEIL = 21
    TRUNC = 22
    FRACT = 23
    MODULO = 24
    FLOORED_MODULO = 25
    WRAP = 26
    SNAP = 27
    PINGPONG = 28
    SINE = 29
    COSINE = 30
    TANGENT = 31
    ARCSINE = 32
    ARCCOSINE = 33
    ARCTANGENT = 34
    ARCTAN2 = 35
    SINH = 36
    COSH = 37
    TANH = 38
    RADIANS = 39
    DEGREES = 40


class VectorOperation(IntEnum):
    ADD = 0
    SUBTRACT = 1
    MULTIPLY = 2
    DIVIDE = 3
    MULTIPLY_ADD = 4
    CROSS_PRODUCT = 5
    PROJECT = 6
    REFLECT = 7
    DOT_PRODUCT = 8
    DISTANCE = 9
    LENGTH = 10
    SCALE = 11
    NORMALIZE = 12
    ABSOLUTE = 13
    MINIMUM = 14
    MAXIMUM = 15
    FLOOR = 16
    CEIL = 17
    FRACTION = 18
    MODULO = 19
    SNAP = 20
    SINE = 21
    COSINE = 22
    TANGENT = 23


class MixMode(IntEnum):
    MIX = 0
    DARKEN = 1
    MULTIPLY = 2
    BURN = 3
    LIGHTEN = 4
    SCREEN = 5
    DODGE = 6
    ADD = 7
    OVERLAY = 8
    SOFT_LIGHT = 9
    LINEAR_LIGHT = 10
    DIFFERENCE = 11
    EXCLUSION = 12
    SUBTRACT = 13
    DIVIDE = 14
    HUE = 15
    SATURATION = 16
    COLOR = 17
    VALUE = 18


class LobeKind(IntEnum):
    """Lobes, summed."""

    LAMBERT = 0
    BECKMANN = 1
    MIRROR = 2
    DIELECTRIC = 3
    PHONG = 4
    BLINN_PHONG = 5
    DIFFUSE = 6
    GLOSSY = 7
    GLASS = 8
    REFRACTION = 9
    CONDUCTOR = 10
    SHEEN = 11
    TRANSLUCENT = 12
    PRINCIPLED = 13
    MINNAERT = 14
    TOON = 15
    HAIR = 16
    HAIR_FIBRE = 17
    SUBSURFACE = 18


class SubsurfaceMethod(IntEnum):
    """RANDOM_WALK_LEGACY."""

    BURLEY = 0
    RANDOM_WALK_LEGACY = 1
    SKIN = 2
    RANDOM_WALK = 3


class Distribution(IntEnum):
    GGX = 0
    BECKMANN = 1
    ASHIKHMIN_SHIRLEY = 2
    MULTI_GGX = 3


class Rules(IntEnum):
    """The Blender versions whose definitions hold for lobes of nodes."""

    BLENDER_3 = 0
    BLENDER_4 = 1
    BLENDER_45 = 2
    BLENDER_50 = 3
    BLENDER_52 = 4


class MaterialFlag(IntFlag):
    NO_BUMP_CORRECTION = 1
    NOT_A_LIGHT = 2
    OPAQUE_SHADOWS = 4
    KEEP_NORMALS = 8


class LightKind(IntEnum):
    POINT = 0
    SPOT = 1
    SUN = 2
    AREA = 3


class AreaShape(IntEnum):
    RECTANGLE = 0
    ELLIPSE = 1


class Falloff(IntEnum):
    """CLASSIC's attenuation over the distance d with the light's falloff_radius r."""

    PHYSICAL = 0
    CONSTANT = 1
    LINEAR = 2
    QUADRATIC = 3
    SMOOTH = 4
    GAUSSIAN = 5


class ObjectKind(IntEnum):
    IMAGE = 0
    MESH = 1
    MATERIAL = 2
    LIGHT = 3
    WORLD = 4


class Accelerator(IntEnum):
    BVH = 0
    KDTREE = 1
    BRUTE_FORCE = 2


class CameraKind(IntEnum):
    PERSPECTIVE = 0
    ORTHOGRAPHIC = 1
    EQUIRECTANGULAR = 2
    FISHEYE_EQUIDISTANT = 3
    FISHEYE_EQUISOLID = 4
    FISHEYE_POLYNOMIAL = 5
    MIRROR_BALL = 6
    CYLINDRICAL = 7


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
    """Passes of the film, which keeps those whose bit (1u << pass) is set in lancer_settings.passes."""

    COMBINED = 0
    DEPTH = 1
    NORMAL = 2
    ALBEDO = 3
    POSITION = 4
    OBJECT_INDEX = 5
    MATERIAL_INDEX = 6
    UV = 7
    MIST = 8
    EMISSION = 9
    ENVIRONMENT = 10
    AMBIENT_OCCLUSION = 11
    DIFFUSE_DIRECT = 12
    DIFFUSE_INDIRECT = 13
    DIFFUSE_COLOR = 14
    GLOSSY_DIRECT = 15
    GLOSSY_INDIRECT = 16
    GLOSSY_COLOR = 17
    TRANSMISSION_DIRECT = 18
    TRANSMISSION_INDIRECT = 19
    TRANSMISSION_COLOR = 20
    DENOISING_NORMAL = 21
    DENOISING_DEPTH = 22
    ERROR = 23
    HALVES = 24
    ALBEDO_HALVES = 25
    NORMAL_HALVES = 26
    SPECULAR_ALBEDO = 27
    ROUGHNESS = 28
    VECTOR = 29

    @property
    def channels(self):
        return (4, 1, 3, 3, 3, 1, 1, 3, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 1, 1, 3, 3, 3, 3, 1, 4)[self]


class PassKind(IntEnum):
    """Passes without a bit in lancer_settings.passes."""

    PLAIN = 0
    OBJECT_MATTES = 1
    MATERIAL_MATTES = 2
    ASSET_MATTES = 3
    LIGHT_GROUP = 4
    AOV_COLOR = 5
    AOV_VALUE = 6
    SAMPLES = 7
    RENDER_TIME = 8
    SHADOW_CATCHER = 9
    CATCHER_MATTE = 10

    @property
    def channels(self):
        return (0, 4, 4, 4, 3, 4, 1, 1, 1, 3, 4)[self]


class Catchers(IntEnum):
    """Shadow catchers in the picture."""

    OBJECTS = 0
    APART = 1
    SHADOWS = 2


class BakeView(IntEnum):
    """From where a bake looks at its surface."""

    ABOVE = 0
    CAMERA = 1
    SKY = 2


class BakeLacks(IntFlag):
    """Lobes that the baked surface lacks at first sight, bits; seen by rays it has them."""

    DIFFUSE = 1
    GLOSSY = 2
    TRANSMISSION = 4
