/* Lancer's one C interface: fill a scene, commit it, render samples, read the film.
 *
 * Manners
 *   - Every call but the plain queries returns a lancer_status. On anything but LANCER_OK, LANCER_RUNNING and
 *     LANCER_CANCELLED, lancer_last_error() gives one sentence that names the object and the value.
 *   - The text is kept per thread until that thread's next call.
 *   - Handles are numbers. A freed, foreign or zero handle gives LANCER_ERROR_HANDLE, never a crash.
 *   - Arrays are copied during the call; the caller may free them when it returns.
 *   - No call waits for long: work is started by *_commit and *_render and watched with *_wait.
 *   - Calls on different handles may come from different threads at once; calls on one handle are serialised.
 *
 * Units and frames
 *   Lengths in scene units (Blender: metres), angles in radians, right-handed world, linear RGB, premultiplied alpha.
 *   Matrices are 3 x 4, row-major, double: p_world = M[:, 0:3] p_object + M[:, 3].
 *   Images: row 0 is the bottom row, pixels left to right.
 */
#ifndef LANCER_H
#define LANCER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32) && defined(LANCER_IS_BUILT)
#define LANCER_API __declspec(dllexport)
#elif defined(__GNUC__) && !defined(_WIN32)
#define LANCER_API __attribute__((visibility("default")))
#else
#define LANCER_API
#endif

/* Changes whenever a struct or a call of this header does. */
#define LANCER_ABI_VERSION 5u

typedef uint64_t lancer_scene;
typedef uint64_t lancer_session;

typedef int32_t lancer_status;
enum {
  LANCER_OK = 0,
  LANCER_RUNNING = 1,        /* *_wait: not finished yet */
  LANCER_CANCELLED = 2,      /* *_wait: ended early, as asked; what was done is kept */
  LANCER_ERROR_ARGUMENT = 3, /* a value that cannot be used */
  LANCER_ERROR_HANDLE = 4,   /* no such scene or session (any more) */
  LANCER_ERROR_STATE = 5,    /* the call does not fit now: filled after commit, rendered before it, busy */
  LANCER_ERROR_MEMORY = 6,   /* not enough memory for what was asked */
  LANCER_ERROR_INTERNAL = 7  /* a fault of Lancer's own */
};

/* ---- the library ------------------------------------------------------------------------------------------------ */

LANCER_API uint32_t lancer_abi_version(void);
/* The release, e.g. "0.1.0". */
LANCER_API const char *lancer_version(void);
/* The last failure of this thread; "" when there was none. */
LANCER_API const char *lancer_last_error(void);

typedef enum lancer_struct {
  LANCER_STRUCT_MESH = 0,
  LANCER_STRUCT_INSTANCE,
  LANCER_STRUCT_PARAMETER,
  LANCER_STRUCT_LOBE,
  LANCER_STRUCT_MATERIAL,
  LANCER_STRUCT_LIGHT,
  LANCER_STRUCT_CAMERA,
  LANCER_STRUCT_SETTINGS,
  LANCER_STRUCT_PROGRESS,
  LANCER_STRUCT_STATISTICS,
  LANCER_STRUCT_HIT,
  LANCER_STRUCT_VERTEX,
  LANCER_STRUCT_LIGHT_SAMPLE,
  LANCER_STRUCT_BSDF_SAMPLE,
  LANCER_STRUCT_ATTRIBUTE,
  LANCER_STRUCT_IMAGE,
  LANCER_STRUCT_NODE,
  LANCER_STRUCT_PRINCIPLED,
  LANCER_STRUCT_WORLD,
  LANCER_STRUCT_LOBE_INFO,
  LANCER_STRUCT_ERROR,
  LANCER_STRUCT_COUNT
} lancer_struct;
/* sizeof one of the structs below, by lancer_struct; 0 for an unknown number. Lets a caller refuse a stale library. */
LANCER_API uint32_t lancer_sizeof(uint32_t which);

/* ---- geometry --------------------------------------------------------------------------------------------------- */

enum lancer_normal_domain { LANCER_NORMALS_NONE = 0, LANCER_NORMALS_VERTEX = 1, LANCER_NORMALS_CORNER = 2 };

/* What an attribute has one value for. */
enum lancer_domain { LANCER_DOMAIN_VERTEX = 0, LANCER_DOMAIN_FACE = 1, LANCER_DOMAIN_CORNER = 2 };

/* A named attribute of a mesh, for nodes: further UV maps and colours, tangents, coordinates. Interpolated linearly. */
typedef struct lancer_attribute {
  const char *name;    /* UTF-8; what a node asks for */
  const float *values; /* [n][channels]; n = vertex_count, triangle_count or 3 triangle_count, as domain says */
  uint32_t domain;     /* LANCER_DOMAIN_* */
  uint32_t channels;   /* 1 ... 4; one is a scalar; of more, missing ones are 0, a missing fourth is 1 */
} lancer_attribute;

/* A triangle mesh in object space, shared by any number of instances. */
typedef struct lancer_mesh {
  const char *name;                   /* UTF-8, for messages */
  const float *positions;             /* [vertex_count][3] */
  const uint32_t *triangles;          /* [triangle_count][3], indices below vertex_count, counter-clockwise from outside */
  const float *normals;               /* NULL, [vertex_count][3] or [triangle_count][3][3], as normal_domain says */
  const float *uvs;                   /* NULL or [triangle_count][3][2] */
  const float *colors;                /* NULL or [triangle_count][3][3], linear RGB */
  const uint16_t *material_slots;     /* NULL (all slot 0) or [triangle_count] */
  const uint32_t *polygons;           /* NULL (each triangle is one) or [triangle_count]: of which polygon it is a part, each
                                         below triangle_count. Only FLAT shading in CLASSIC asks */
  const lancer_attribute *attributes; /* NULL or [attribute_count] */
  uint32_t vertex_count;
  uint32_t triangle_count;
  uint32_t normal_domain; /* LANCER_NORMALS_* */
  uint32_t attribute_count;
} lancer_mesh;

/* Exact surfaces stand in their own unit frame; the instance's matrix places, scales and shears them:
 *   SPHERE    |p| = 1
 *   PLANE     z = 0, without end; the normal is +z
 *   CYLINDER  x^2 + y^2 = 1 for -1 <= z <= 1, closed by both disks
 *   CONE      apex (0, 0, 1), base disk of radius 1 at z = -1, closed by the disk */
enum lancer_instance_kind { LANCER_MESH = 0, LANCER_SPHERE = 1, LANCER_PLANE = 2, LANCER_CYLINDER = 3, LANCER_CONE = 4 };

/* How normals are used, and in CLASSIC where light is computed.
 *   AS_MESH  the mesh's normals; without any, the faces'
 *   FLAT     the faces' normals. CLASSIC computes one colour for each polygon, as if every ray had met it at its centre: the
 *            mean of its vertices, moved to the polygon along its normal, or to the nearest place where it is concave. That
 *            holds for light, shadows, highlights, textures, opacity, and for where mirrored and refracted rays start; depth,
 *            position and the other passes of places stay those of the pixel
 *   GOURAUD  CLASSIC computes illumination at the vertices and interpolates it; PATH takes it as PHONG
 *   PHONG    normals interpolated, by area where the mesh has none */
enum lancer_shading {
  LANCER_SHADING_AS_MESH = 0,
  LANCER_SHADING_FLAT = 1,
  LANCER_SHADING_GOURAUD = 2,
  LANCER_SHADING_PHONG = 3
};

/* Rays by what sent them. A thing hidden from some of them is not there for those rays. */
enum lancer_ray {
  LANCER_RAY_CAMERA = 1,
  LANCER_RAY_DIFFUSE = 2,
  LANCER_RAY_GLOSSY = 4,
  LANCER_RAY_TRANSMISSION = 8,
  LANCER_RAY_SHADOW = 16,
  LANCER_RAY_VOLUME = 32
};

enum lancer_instance_flag { LANCER_INSTANCE_HOLDOUT = 1 /* a hole in the picture: alpha 0 where it is seen */ };

/* One placed object. */
typedef struct lancer_instance {
  double matrix[12];     /* object to world, 3 x 4 row-major; any invertible affine map, mirrored ones included */
  uint32_t kind;         /* LANCER_MESH ... LANCER_CONE */
  uint32_t mesh;         /* number of the mesh, in order of lancer_scene_add_mesh; ignored unless LANCER_MESH */
  uint32_t first_slot;   /* its material slots are slots[first_slot .. first_slot + slot_count) */
  uint32_t slot_count;   /* a triangle's slot beyond the last takes the last, as Blender does */
  uint32_t object_index; /* value of the object index pass */
  uint32_t shading;      /* LANCER_SHADING_* */
  uint32_t name;         /* offset of its NUL-terminated name in the names of lancer_scene_add_instances */
  uint32_t hidden_from;  /* LANCER_RAY_* bits */
  uint32_t flags;        /* LANCER_INSTANCE_* bits */
  float terminator;      /* smooth meshes: below this cosine to the light a shadow ray starts on the curved surface that the
                            normals stand for, as Blender's shadow terminator offset; 0 = on the triangle */
} lancer_instance;

/* ---- images ----------------------------------------------------------------------------------------------------- */

enum lancer_texel_kind { LANCER_TEXEL_U8 = 0, LANCER_TEXEL_U16 = 1, LANCER_TEXEL_FLOAT = 2 };
/* How a texel becomes scene-linear, after interpolation: as it is, or decoded by the sRGB curve; then multiplied by matrix. */
enum lancer_transfer { LANCER_TRANSFER_LINEAR = 0, LANCER_TRANSFER_SRGB = 1 };
/* What the fourth channel does. ASSOCIATED: colour is premultiplied in memory. STRAIGHT: it is not, and is multiplied on the
 * way. CHANNEL_PACKED: colour and alpha are independent. NONE: alpha is 1. */
enum lancer_alpha_mode {
  LANCER_ALPHA_ASSOCIATED = 0,
  LANCER_ALPHA_STRAIGHT = 1,
  LANCER_ALPHA_CHANNEL_PACKED = 2,
  LANCER_ALPHA_NONE = 3
};

typedef struct lancer_image {
  const char *name;
  const void *texels; /* [height][width][channels] of kind, row 0 at the bottom; integers stand for 0 ... 1 */
  uint32_t width, height;
  uint32_t channels; /* 1 (grey), 3 or 4 */
  uint32_t kind;     /* LANCER_TEXEL_* */
  uint32_t transfer; /* LANCER_TRANSFER_* */
  uint32_t alpha;    /* LANCER_ALPHA_* */
  uint32_t tile;     /* UDIM number, 1001 ...; 0 where the picture is not one of several tiles */
  uint32_t reserved;
  float matrix[9]; /* row-major: decoded RGB to the scene's working space */
  uint32_t reserved2;
} lancer_image;

/* ---- nodes ------------------------------------------------------------------------------------------------------ */

/* A value of a material, light or world: a constant, or the result of a node.
 * A comment [kind number] tells what a parameter is, and its value where nobody gives one. Kinds: color, RGB of 0 or more;
 * share, 0 to 1; amount, 0 or more; signed, -1 to 1; index, of refraction, above 0; denser, the same of at least 1; turns, 1
 * is once around; direction, in the world, 0, 0, 0 for none; vector, any three numbers. */
typedef struct lancer_parameter {
  float value[3]; /* scalars use value[0] */
  int32_t node;   /* -1: the value; else the number of a node of the same owner, whose result replaces it */
} lancer_parameter;

/* Nodes compute values where a ray meets a surface. Each has up to five inputs, refers only to nodes before it, and gives four
 * numbers: x, y, z or RGB, and alpha (1 where it has none). A scalar is in all of x, y, z. Vectors are in the world unless said
 * otherwise; lengths in scene units. */
enum lancer_node_kind {
  /* option LANCER_COORDINATE_*; matrix: world to object for OBJECT with flag 1; name: the UV map of UV ("" = the mesh's own) */
  LANCER_NODE_COORDINATE = 0,
  LANCER_NODE_ATTRIBUTE = 1, /* name: of the attribute; "" = the mesh's own colours */
  /* images [image, image + image_count): one, or the tiles of one; inputs: vector. option: projection LANCER_PROJECT_*;
   * flags: extension LANCER_EXTEND_* in bits 0-3, interpolation LANCER_INTERPOLATE_* in bits 4-7, 256 = colour is wanted
   * straight (divided by alpha) as the image's alpha mode says; input 1: blend of BOX. Vector as it is given: 0 ... 1 covers
   * the image */
  LANCER_NODE_IMAGE = 2,
  /* the same, vector a direction; option LANCER_ENVIRONMENT_*; CUBE takes six images: +x -x +y -y +z -z, upright for one who
   * stands inside with +z up; +z and -z for one who looks along +y, then up or down */
  LANCER_NODE_ENVIRONMENT = 3,
  LANCER_NODE_ALPHA = 4,         /* the fourth number of input 0 */
  LANCER_NODE_MAPPING = 5,       /* inputs: vector, location, rotation (Euler XYZ), scale; option LANCER_MAPPING_* */
  LANCER_NODE_TRANSFORM = 6,     /* matrix times input 0; option 0 point, 1 vector, 2 normal (inverse transpose, normalised) */
  LANCER_NODE_MATH = 7,          /* inputs a, b, c; option LANCER_MATH_*; flag 1: clamped to 0 ... 1 */
  LANCER_NODE_VECTOR_MATH = 8,   /* inputs a, b, c, scale; option LANCER_VECTOR_* */
  LANCER_NODE_MIX = 9,           /* inputs factor, a, b; option LANCER_MIX_*; flag 1: factor clamped, 2: result clamped */
  LANCER_NODE_SEPARATE = 10,     /* component option (0, 1, 2) of input 0 */
  LANCER_NODE_COMBINE = 11,      /* inputs x, y, z */
  LANCER_NODE_GREY = 12,         /* luminance of input 0; matrix[0 ... 2]: the weights */
  LANCER_NODE_FRESNEL = 13,      /* inputs: IOR, normal */
  LANCER_NODE_LAYER_WEIGHT = 14, /* inputs: blend, normal; option 0 Fresnel, 1 facing */
  LANCER_NODE_NORMAL_MAP = 15,   /* inputs: strength, colour; option 0 tangent, 1 object, 2 world, 3 object with y, z inverted
                                    (Blender's), 4 world so; name: the UV map; its tangents are attribute "tangent:" + name;
                                    flag 1: in the frame of the interpolated normal made unit, else as long as it is */
  LANCER_NODE_BUMP = 16,    /* inputs: strength, distance, height, normal, filter width in pixels; flag 1: inverted, 2: over
                               the surface as it was before displacement, in object space, 4: a flat face has the normal
                               that it had before, too. Nodes [first, this) compute the height, which is evaluated there, to the
                               right and above */
  LANCER_NODE_TANGENT = 17, /* option 0, 1, 2 radial about x, y, z of GENERATED; 3 along u of the UV map name */
  LANCER_NODE_CLAMP = 18,   /* inputs: value, low, high */
  LANCER_NODE_DISPLACEMENT = 19, /* inputs: height, midlevel, scale, normal; option 0 object, 1 world: where
                                    scale is measured. Gives an offset in object space */
  LANCER_NODE_GAMMA = 20,        /* inputs: colour, exponent */
  LANCER_NODE_INVERT = 21,       /* inputs: factor, colour */
  /* inputs: vector; w, scale, distortion; detail, roughness, lacunarity; offset, gain. option LANCER_NOISE_*; flags: dimensions
   * less 1 in bits 0-1, and LANCER_NOISE_* bits */
  LANCER_NODE_NOISE = 22,
  /* inputs: vector; w, scale, randomness; detail, roughness, lacunarity; smoothness, exponent. option LANCER_VORONOI_*; flags:
   * dimensions less 1 in bits 0-1, LANCER_VORONOI_EUCLIDEAN ... in bits 2-3, and LANCER_VORONOI_* bits */
  LANCER_NODE_VORONOI = 23,
  LANCER_NODE_GRADIENT = 24, /* inputs: vector; option LANCER_GRADIENT_* */
  /* inputs: factor, value. image: one row of at least two floating point texels, as it is in memory: values at equal distances
   * from matrix[0] to matrix[1]; with one channel a curve of the value's x, with more one of each; option 1: all of x, factor
   * left out. flag 1: goes on beyond its ends along its first and last line, 2: no lines between values, the one before */
  LANCER_NODE_CURVES = 25,
  LANCER_NODE_OBJECT_INFO = 26, /* of the object that is met; option LANCER_OBJECT_* */
  LANCER_NODE_LIGHT_PATH = 27,  /* of the ray that has met it, or the world; option LANCER_PATH_* */
  LANCER_NODE_COLOR_MODEL = 28, /* inputs: colour; option LANCER_COLOR_* */
  LANCER_NODE_COUNT = 29
};
/* Between linear RGB and hue, saturation and value (HSV) or lightness (HSL). */
enum lancer_color_model {
  LANCER_COLOR_TO_HSV = 0,
  LANCER_COLOR_FROM_HSV,
  LANCER_COLOR_TO_HSL,
  LANCER_COLOR_FROM_HSL,
  LANCER_COLOR_COUNT
};
enum lancer_object_fact {
  LANCER_OBJECT_LOCATION = 0, /* of its frame's origin */
  LANCER_OBJECT_COLOR,        /* and alpha */
  LANCER_OBJECT_INDEX,
  LANCER_OBJECT_RANDOM,
  LANCER_OBJECT_COUNT
};
/* 1 or 0; a length in scene units; or how many scatterings, of that kind, or surfaces passed straight through came before. */
enum lancer_path_fact {
  LANCER_PATH_IS_CAMERA = 0,
  LANCER_PATH_IS_SHADOW,
  LANCER_PATH_IS_DIFFUSE,
  LANCER_PATH_IS_GLOSSY,
  LANCER_PATH_IS_SINGULAR,
  LANCER_PATH_IS_REFLECTION,
  LANCER_PATH_IS_TRANSMISSION,
  LANCER_PATH_IS_VOLUME,
  LANCER_PATH_LENGTH,
  LANCER_PATH_DEPTH,
  LANCER_PATH_DIFFUSE_DEPTH,
  LANCER_PATH_GLOSSY_DEPTH,
  LANCER_PATH_TRANSPARENT_DEPTH,
  LANCER_PATH_TRANSMISSION_DEPTH,
  LANCER_PATH_PORTAL_DEPTH,
  LANCER_PATH_COUNT
};
enum lancer_noise_kind {
  LANCER_NOISE_FBM = 0,
  LANCER_NOISE_MULTIFRACTAL,
  LANCER_NOISE_HYBRID_MULTIFRACTAL,
  LANCER_NOISE_RIDGED_MULTIFRACTAL,
  LANCER_NOISE_HETERO_TERRAIN,
  LANCER_NOISE_COUNT
};
enum lancer_noise_flag {
  LANCER_NOISE_NORMALIZED = 4, /* FBM: 0 ... 1 */
  LANCER_NOISE_REPEATS = 8,    /* every 100 000 along each axis, as from Blender 4.2 on */
  LANCER_NOISE_COUNTED = 16,   /* detail is the number of octaves, as of the Musgrave Texture; else one less */
  LANCER_NOISE_COLOR = 32      /* green and blue are noises of their own */
};
enum lancer_voronoi_feature {
  LANCER_VORONOI_F1 = 0,
  LANCER_VORONOI_F2,
  LANCER_VORONOI_SMOOTH_F1,
  LANCER_VORONOI_DISTANCE_TO_EDGE,
  LANCER_VORONOI_N_SPHERE_RADIUS,
  LANCER_VORONOI_COUNT
};
enum lancer_voronoi_metric {
  LANCER_VORONOI_EUCLIDEAN = 0,
  LANCER_VORONOI_MANHATTAN,
  LANCER_VORONOI_CHEBYCHEV,
  LANCER_VORONOI_MINKOWSKI
};
enum lancer_voronoi_flag {
  LANCER_VORONOI_NORMALIZED = 16,
  LANCER_VORONOI_COLOR = 32, /* x, y, z are the colour of the cell; the distance is the fourth number, and all without this */
  LANCER_VORONOI_POSITION = 64,  /* x, y, z are the position of the point, its w the fourth */
  LANCER_VORONOI_INTEGERS = 128, /* cells are hashed as from Blender 5.0 on */
  LANCER_VORONOI_BOUNDED = 256   /* nothing is further than 8, as before Blender 4.0 */
};
enum lancer_gradient_kind {
  LANCER_GRADIENT_LINEAR = 0,
  LANCER_GRADIENT_QUADRATIC,
  LANCER_GRADIENT_EASING,
  LANCER_GRADIENT_DIAGONAL,
  LANCER_GRADIENT_SPHERICAL,
  LANCER_GRADIENT_QUADRATIC_SPHERE,
  LANCER_GRADIENT_RADIAL,
  LANCER_GRADIENT_COUNT
};
enum lancer_coordinate {
  LANCER_COORDINATE_GENERATED = 0, /* 0 ... 1 over the mesh's bounds; attribute "generated" where the mesh has it */
  LANCER_COORDINATE_NORMAL = 1,    /* object space */
  LANCER_COORDINATE_UV = 2,
  LANCER_COORDINATE_OBJECT = 3,
  LANCER_COORDINATE_CAMERA = 4,
  LANCER_COORDINATE_WINDOW = 5,
  LANCER_COORDINATE_REFLECTION = 6,
  LANCER_COORDINATE_POSITION = 7,
  LANCER_COORDINATE_SHADING_NORMAL = 8, /* towards the viewer */
  LANCER_COORDINATE_TRUE_NORMAL = 9,    /* towards the viewer */
  LANCER_COORDINATE_INCOMING = 10,      /* towards the viewer */
  LANCER_COORDINATE_BACKFACING = 11,    /* 1 where seen from inside */
  LANCER_COORDINATE_PARAMETRIC = 12,    /* barycentric weights of vertex 0 and 1, Blender's */
  LANCER_COORDINATE_COUNT = 13
};
enum lancer_projection { LANCER_PROJECT_FLAT = 0, LANCER_PROJECT_BOX = 1, LANCER_PROJECT_SPHERE = 2, LANCER_PROJECT_TUBE = 3 };
enum lancer_extension { LANCER_EXTEND_REPEAT = 0, LANCER_EXTEND_EXTEND = 1, LANCER_EXTEND_CLIP = 2, LANCER_EXTEND_MIRROR = 3 };
enum lancer_interpolation { LANCER_INTERPOLATE_LINEAR = 0, LANCER_INTERPOLATE_CLOSEST = 1, LANCER_INTERPOLATE_CUBIC = 2 };
enum lancer_environment {
  LANCER_ENVIRONMENT_EQUIRECTANGULAR = 0,
  LANCER_ENVIRONMENT_MIRROR_BALL = 1,
  LANCER_ENVIRONMENT_CUBE = 2
};
enum lancer_mapping_type {
  LANCER_MAPPING_POINT = 0,
  LANCER_MAPPING_TEXTURE = 1,
  LANCER_MAPPING_VECTOR = 2,
  LANCER_MAPPING_NORMAL = 3
};
/* As Blender's nodes of these names. */
enum lancer_math_operation {
  LANCER_MATH_ADD = 0,
  LANCER_MATH_SUBTRACT,
  LANCER_MATH_MULTIPLY,
  LANCER_MATH_DIVIDE,
  LANCER_MATH_MULTIPLY_ADD,
  LANCER_MATH_POWER,
  LANCER_MATH_LOGARITHM,
  LANCER_MATH_SQRT,
  LANCER_MATH_INVERSE_SQRT,
  LANCER_MATH_ABSOLUTE,
  LANCER_MATH_EXPONENT,
  LANCER_MATH_MINIMUM,
  LANCER_MATH_MAXIMUM,
  LANCER_MATH_LESS_THAN,
  LANCER_MATH_GREATER_THAN,
  LANCER_MATH_SIGN,
  LANCER_MATH_COMPARE,
  LANCER_MATH_SMOOTH_MIN,
  LANCER_MATH_SMOOTH_MAX,
  LANCER_MATH_ROUND,
  LANCER_MATH_FLOOR,
  LANCER_MATH_CEIL,
  LANCER_MATH_TRUNC,
  LANCER_MATH_FRACT,
  LANCER_MATH_MODULO,
  LANCER_MATH_FLOORED_MODULO,
  LANCER_MATH_WRAP,
  LANCER_MATH_SNAP,
  LANCER_MATH_PINGPONG,
  LANCER_MATH_SINE,
  LANCER_MATH_COSINE,
  LANCER_MATH_TANGENT,
  LANCER_MATH_ARCSINE,
  LANCER_MATH_ARCCOSINE,
  LANCER_MATH_ARCTANGENT,
  LANCER_MATH_ARCTAN2,
  LANCER_MATH_SINH,
  LANCER_MATH_COSH,
  LANCER_MATH_TANH,
  LANCER_MATH_RADIANS,
  LANCER_MATH_DEGREES,
  LANCER_MATH_COUNT
};
enum lancer_vector_operation {
  LANCER_VECTOR_ADD = 0,
  LANCER_VECTOR_SUBTRACT,
  LANCER_VECTOR_MULTIPLY,
  LANCER_VECTOR_DIVIDE,
  LANCER_VECTOR_MULTIPLY_ADD,
  LANCER_VECTOR_CROSS_PRODUCT,
  LANCER_VECTOR_PROJECT,
  LANCER_VECTOR_REFLECT,
  LANCER_VECTOR_DOT_PRODUCT,
  LANCER_VECTOR_DISTANCE,
  LANCER_VECTOR_LENGTH,
  LANCER_VECTOR_SCALE,
  LANCER_VECTOR_NORMALIZE,
  LANCER_VECTOR_ABSOLUTE,
  LANCER_VECTOR_MINIMUM,
  LANCER_VECTOR_MAXIMUM,
  LANCER_VECTOR_FLOOR,
  LANCER_VECTOR_CEIL,
  LANCER_VECTOR_FRACTION,
  LANCER_VECTOR_MODULO,
  LANCER_VECTOR_SNAP,
  LANCER_VECTOR_SINE,
  LANCER_VECTOR_COSINE,
  LANCER_VECTOR_TANGENT,
  LANCER_VECTOR_COUNT
};
enum lancer_mix_mode {
  LANCER_MIX_MIX = 0,
  LANCER_MIX_DARKEN,
  LANCER_MIX_MULTIPLY,
  LANCER_MIX_BURN,
  LANCER_MIX_LIGHTEN,
  LANCER_MIX_SCREEN,
  LANCER_MIX_DODGE,
  LANCER_MIX_ADD,
  LANCER_MIX_OVERLAY,
  LANCER_MIX_SOFT_LIGHT,
  LANCER_MIX_LINEAR_LIGHT,
  LANCER_MIX_DIFFERENCE,
  LANCER_MIX_EXCLUSION,
  LANCER_MIX_SUBTRACT,
  LANCER_MIX_DIVIDE,
  LANCER_MIX_HUE,
  LANCER_MIX_SATURATION,
  LANCER_MIX_COLOR,
  LANCER_MIX_VALUE,
  LANCER_MIX_COUNT
};

typedef struct lancer_node {
  uint32_t kind;               /* LANCER_NODE_* */
  uint32_t option, flags;      /* as the kind says */
  uint32_t image, image_count; /* numbers of pictures, in order of lancer_scene_add_image */
  uint32_t first;              /* BUMP */
  const char *name;            /* NULL is "" */
  lancer_parameter inputs[5];
  float matrix[12]; /* 3 x 4 row-major */
} lancer_node;

/* ---- materials -------------------------------------------------------------------------------------------------- */

/* clang-format off */
/* Lobes, summed. In the local frame n = +z; wo and wi point away from the surface. Value f, without the cosine.
 *   LAMBERT      color/pi, on both sides
 *   BECKMANN     color D F G / (4 (l.n)(v.n)): Beckmann D, exact dielectric Fresnel F of ior (infinite = 1), Smith G
 *                with Walter's rational G1; roughness is alpha itself. Below alpha 2e-5 a mirror weighted with F.
 *   MIRROR       color, in the mirrored direction only
 *   DIELECTRIC   smooth glass: color F reflected, color (1 - F) refracted, total internal reflection; ior is that of the
 *                inside, the side that the geometric normal points away from
 *   PHONG        color (n + 2)/(2 pi) max(0, R.V)^n in PATH; color max(0, R.V)^n per light / pi in CLASSIC; n = shininess
 *   BLINN_PHONG  color (n + 2)(n + 4)/(8 pi (2^(-n/2) + n)) max(0, N.H)^n in PATH; color max(0, N.H)^n / pi in CLASSIC
 *   MINNAERT     color (k + 1)/(2 pi) ((l.n)(v.n))^(k - 1), k = shininess; 1 is LAMBERT. color is the albedo from straight
 *                above. Below k = 1 the albedo would pass 1 towards the horizon: no cosine counts as less than
 *                m = max(color)^(1/(1 - k)), where it is 1, and 2 pi/(k + 1) becomes 2 pi ((1 - q)/(k + 1) + q/2), q = m^(k + 1)
 * Those of Blender's shader nodes, as Cycles of the running version defines them. roughness is the socket's: alpha is its
 * square (DIFFUSE, SHEEN, VELVET: the value itself); anisotropy and rotation turn and stretch it along tangent.
 *   DIFFUSE      Oren-Nayar of roughness; 0 is LAMBERT. option 0: before Blender 4.3, 1: energy-preserving, from 4.3
 *   GLOSSY       a metal of constant color, with distribution
 *   GLASS        reflection and refraction by Fresnel of ior, rough or smooth, with distribution
 *   REFRACTION   the refraction of it alone, all of color
 *   CONDUCTOR    option 0: F82, color at the normal and edge at 82 degrees; 1: ior = color, extinction = edge
 *   SHEEN        of cloth: distribution GGX = microfibres, BECKMANN = Ashikhmin's velvet (VELVET before 4.0)
 *   TRANSLUCENT  color/pi on the other side
 *   PRINCIPLED   as its record says */
/* clang-format on */
enum lancer_lobe_kind {
  LANCER_LAMBERT = 0,
  LANCER_BECKMANN = 1,
  LANCER_MIRROR = 2,
  LANCER_DIELECTRIC = 3,
  LANCER_PHONG = 4,
  LANCER_BLINN_PHONG = 5,
  LANCER_DIFFUSE = 6,
  LANCER_GLOSSY = 7,
  LANCER_GLASS = 8,
  LANCER_REFRACTION = 9,
  LANCER_CONDUCTOR = 10,
  LANCER_SHEEN = 11,
  LANCER_TRANSLUCENT = 12,
  LANCER_PRINCIPLED = 13,
  LANCER_MINNAERT = 14,
  LANCER_LOBE_KIND_COUNT = 15
};
enum lancer_distribution {
  LANCER_DISTRIBUTION_GGX = 0,
  LANCER_DISTRIBUTION_BECKMANN = 1,
  LANCER_DISTRIBUTION_ASHIKHMIN_SHIRLEY = 2,
  LANCER_DISTRIBUTION_MULTI_GGX = 3
};
/* Whose definitions hold for lobes of nodes: those of Blender 3.x, of 4.0 to 4.4, of 4.5 and newer. */
enum lancer_rules { LANCER_RULES_BLENDER_3 = 0, LANCER_RULES_BLENDER_4 = 1, LANCER_RULES_BLENDER_45 = 2 };

/* The Principled BSDF's inputs under their newest names. Before 4.0 some mean another thing: specular is the level over 0.08,
 * specular_tint[0] a share of the base colour, sheen_tint[0] and coat likewise; transmission_roughness exists there alone. */
typedef struct lancer_principled {
  uint32_t rules;        /* LANCER_RULES_* */
  uint32_t distribution; /* LANCER_DISTRIBUTION_GGX or LANCER_DISTRIBUTION_MULTI_GGX */
  uint32_t option;       /* as of DIFFUSE, for diffuse_roughness */
  uint32_t reserved;
  lancer_parameter base_color;             /* [color 0.8] */
  lancer_parameter metallic;               /* [share 0] */
  lancer_parameter roughness;              /* [share 0.5] */
  lancer_parameter ior;                    /* [index 1.5] */
  lancer_parameter diffuse_roughness;      /* [share 0] */
  lancer_parameter specular;               /* [amount 0.5] */
  lancer_parameter specular_tint;          /* [color 1] */
  lancer_parameter anisotropic;            /* [share 0] */
  lancer_parameter anisotropic_rotation;   /* [turns 0] */
  lancer_parameter transmission;           /* [share 0] */
  lancer_parameter transmission_roughness; /* [share 0] */
  lancer_parameter coat;                   /* [amount 0] */
  lancer_parameter coat_roughness;         /* [share 0.03] */
  lancer_parameter coat_ior;               /* [denser 1.5] */
  lancer_parameter coat_tint;              /* [color 1] */
  lancer_parameter coat_normal;            /* [direction 0] */
  lancer_parameter sheen;                  /* [amount 0] */
  lancer_parameter sheen_roughness;        /* [share 0.5] */
  lancer_parameter sheen_tint;             /* [color 1] */
  lancer_parameter emission;               /* [color 0] radiance, below sheen and coat */
} lancer_principled;

typedef struct lancer_lobe {
  uint32_t kind;                       /* LANCER_LAMBERT ... */
  uint32_t distribution;               /* LANCER_DISTRIBUTION_GGX ...; GLOSSY, GLASS, REFRACTION, CONDUCTOR, SHEEN */
  uint32_t option;                     /* as the kind says */
  uint32_t rules;                      /* LANCER_RULES_* */
  lancer_parameter weight;             /* [color 1] times everything: the shares of Mix Shaders above it */
  lancer_parameter color;              /* [color 0.8] Kd or Ks */
  lancer_parameter roughness;          /* [share 0.5] alpha itself, BECKMANN; else the socket's value */
  lancer_parameter ior;                /* [index 1.5] relative to the outside, > 0, may be infinite */
  lancer_parameter shininess;          /* [amount 50] the exponent n of PHONG, BLINN_PHONG; k of MINNAERT */
  lancer_parameter edge;               /* [color 1] CONDUCTOR */
  lancer_parameter anisotropy;         /* [signed 0] GLOSSY, CONDUCTOR */
  lancer_parameter rotation;           /* [turns 0] the same */
  lancer_parameter normal;             /* [direction 0] none: the shading normal */
  lancer_parameter tangent;            /* [direction 0] none: any */
  const lancer_principled *principled; /* PRINCIPLED */
} lancer_lobe;

enum lancer_material_flag {
  LANCER_MATERIAL_NO_BUMP_CORRECTION = 1, /* bumps darken as they are, without a smooth end of the lit side */
  LANCER_MATERIAL_NOT_A_LIGHT = 2,        /* it shines, but is only found by chance, never sampled */
  LANCER_MATERIAL_OPAQUE_SHADOWS = 4,     /* transmittance lets no shadow ray pass */
  LANCER_MATERIAL_KEEP_NORMALS = 8        /* displacement leaves the normals as they were: a BUMP with flag 2 makes them */
};

typedef struct lancer_material {
  const char *name;
  const lancer_lobe *lobes;
  const lancer_node *nodes;
  uint32_t lobe_count;            /* 0 is a black surface; at most 64 */
  uint32_t node_count;            /* at most 4096 */
  uint32_t material_index;        /* value of the material index pass */
  uint32_t flags;                 /* LANCER_MATERIAL_* bits */
  lancer_parameter emission;      /* [color 0] radiance, both sides */
  lancer_parameter transmittance; /* [color 0] of light that passes straight on; lobes and emission are not scaled by it */
  lancer_parameter holdout;       /* [share 0] of the picture that becomes a hole */
  lancer_parameter ambient;       /* [color 0] Ka, CLASSIC only */
  lancer_parameter displacement;  /* [vector 0] offset of vertices in object space, applied when the scene is committed; 0, 0,
                                     0: none. A mesh is moved once for each list of displacing materials that its instances have,
                                     at the first of those instances */
  lancer_parameter normal;        /* [direction 0] takes the place of the shading normal for all lobes; 0, 0, 0: none */
} lancer_material;

/* ---- lights ----------------------------------------------------------------------------------------------------- */

enum lancer_light_kind { LANCER_POINT = 0, LANCER_SPOT = 1, LANCER_SUN = 2, LANCER_AREA = 3 };
enum lancer_area_shape { LANCER_RECTANGLE = 0, LANCER_ELLIPSE = 1 };
/* CLASSIC's attenuation over the distance d with the light's falloff_radius r:
 * PHYSICAL 1/d^2 | CONSTANT 1 | LINEAR max(0, 1-d/r) | QUADRATIC max(0, 1-d^2/r^2) | SMOOTH max(0, 1-d^2/r^2)^2 | GAUSSIAN
 * exp(-d^2/r^2) */
enum lancer_falloff {
  LANCER_FALLOFF_PHYSICAL = 0,
  LANCER_FALLOFF_CONSTANT = 1,
  LANCER_FALLOFF_LINEAR = 2,
  LANCER_FALLOFF_QUADRATIC = 3,
  LANCER_FALLOFF_SMOOTH = 4,
  LANCER_FALLOFF_GAUSSIAN = 5
};

/* A light shines along its local -z. The matrix's linear part gives directions only (columns are normalised); sizes are
 * world lengths in the fields below. In PATH camera, mirrors and glass see it unless it is hidden from their rays. */
typedef struct lancer_light {
  const char *name;
  double matrix[12];
  uint32_t kind;         /* LANCER_POINT ... */
  float emission[3];     /* POINT, SPOT: radiant intensity, W/sr. SUN: irradiance at normal incidence, W/m^2. AREA: radiance */
  float radius;          /* POINT, SPOT: 0 is a true point */
  uint32_t soft_falloff; /* POINT, SPOT with radius: 1 = a disk that always faces the shaded point (E = I/(d^2 + r^2));
                            0 = a ball */
  float spot_angle;      /* SPOT: full angle of the cone */
  float spot_blend;      /* SPOT: 0 hard edge ... 1 all of the cone softened */
  uint32_t spot_cosine;  /* SPOT: 1 = intensity also falls with the cosine of the angle to the axis, as in Blender before 4.0 */
  float sun_angle;       /* SUN: full angle of the disk in the sky; 0 is exactly parallel light */
  uint32_t sun_flat; /* SUN: 1 = radiance grows to the rim as 1 / cos^3, a flat disk's, as in Blender before 4.0; 0 = even */
  float size[2];     /* AREA: full lengths along local x and y. SPOT: what widens the cone along them; 1, 1 (and 0, 0): round */
  uint32_t shape;    /* AREA: LANCER_RECTANGLE or LANCER_ELLIPSE */
  float spread;      /* AREA: full angle of emission, pi = all of the front side */
  uint32_t hidden_from;   /* LANCER_RAY_* bits; SHADOW has no meaning here */
  uint32_t no_shadow;     /* 1: nothing stands in its way */
  uint32_t falloff;       /* CLASSIC: LANCER_FALLOFF_* */
  float falloff_radius;   /* CLASSIC: r above */
  float ambient_color[3]; /* CLASSIC: factors of emission for the ambient, diffuse and specular sum; 1, 1, 1 = one colour */
  float diffuse_color[3];
  float specular_color[3];
} lancer_light;

/* ---- scene: create, fill, commit, destroy ------------------------------------------------------------------------ */

LANCER_API lancer_status lancer_scene_create(lancer_scene *scene);
/* Stops a commit that still runs, and frees it. Sessions made from it go on: each keeps what it needs until it is destroyed. */
LANCER_API lancer_status lancer_scene_destroy(lancer_scene scene);

/* Meshes and materials are numbered 0, 1, 2 ... in the order in which they are added. Bad faces (non-finite or zero area)
 * are left out and reported by lancer_scene_messages; an index out of range is an error and adds nothing. */
LANCER_API lancer_status lancer_scene_add_mesh(lancer_scene scene, const lancer_mesh *mesh);
LANCER_API lancer_status lancer_scene_add_material(lancer_scene scene, const lancer_material *material);
LANCER_API lancer_status lancer_scene_add_light(lancer_scene scene, const lancer_light *light);
/* Adds count instances at once. slots: material numbers [slot_count]; names: NUL-terminated UTF-8 strings, names_size bytes in
 * all. Instances whose matrix is not finite or not invertible are left out and reported. May be called again. */
LANCER_API lancer_status lancer_scene_add_instances(lancer_scene scene, uint32_t count, const lancer_instance *instances,
                                                    uint32_t slot_count, const uint32_t *slots, const char *names,
                                                    size_t names_size);
/* For OBJECT_INFO nodes: infos[count][5], colour, alpha and the random number of the first count instances in order of adding,
 * those left out included. Others are white and 0. */
LANCER_API lancer_status lancer_scene_set_object_infos(lancer_scene scene, uint32_t count, const float *infos);
/* Pictures are numbered in the order in which they are added. */
LANCER_API lancer_status lancer_scene_add_image(lancer_scene scene, const lancer_image *image);

/* What lies beyond everything: its radiance as a value or as nodes, in which every coordinate is the unit direction
 * (GENERATED, OBJECT, POSITION) or its opposite, as of a surface that looks back at the viewer (normals, INCOMING,
 * REFLECTION). */
typedef struct lancer_world {
  const lancer_node *nodes;
  uint32_t node_count;
  uint32_t hidden_from;      /* LANCER_RAY_* bits */
  lancer_parameter radiance; /* [color 0] */
  float ambient[3];        /* CLASSIC: the light from everywhere that Ka reflects, once, whatever the lamps; see use_ambient */
  uint32_t use_ambient;    /* 0: the mean of the radiance in place of ambient */
  uint32_t map_resolution; /* width of the map by which directions are sampled where the radiance varies; 0 = by its images,
                              1024 without any. At most 65536, but no map is wider than 2048: what is finer is looked at in
                              up to 8192 x 4096 places and joined */
  uint32_t reserved;
} lancer_world;
/* Black until set. */
LANCER_API lancer_status lancer_scene_set_world(lancer_scene scene, const lancer_world *world);

enum lancer_accelerator { LANCER_BVH = 0, LANCER_KDTREE = 1, LANCER_BRUTE_FORCE = 2 };
/* Starts the build on threads threads (0 = all): checks, normalises, finds features, builds the accelerator. Once only. */
LANCER_API lancer_status lancer_scene_commit(lancer_scene scene, uint32_t accelerator, uint32_t threads);
/* Waits at most the given time. LANCER_OK: committed, ready for sessions. */
LANCER_API lancer_status lancer_scene_wait(lancer_scene scene, uint32_t milliseconds);
LANCER_API lancer_status lancer_scene_cancel(lancer_scene scene);
/* What was left out or replaced while filling and committing, one line each, "object: what" (UTF-8, NUL-terminated).
 * Writes at most size bytes; *needed (may be NULL) gets the full size with the NUL. */
LANCER_API lancer_status lancer_scene_messages(lancer_scene scene, char *text, size_t size, size_t *needed);

/* ---- session: camera, settings, film ----------------------------------------------------------------------------- */

enum lancer_camera_kind {
  LANCER_PERSPECTIVE = 0,
  LANCER_ORTHOGRAPHIC = 1,
  LANCER_EQUIRECTANGULAR = 2,     /* panorama: latitude_min, latitude_max, longitude_min, longitude_max */
  LANCER_FISHEYE_EQUIDISTANT = 3, /* panorama: field of view */
  LANCER_FISHEYE_EQUISOLID = 4,   /* panorama: focal length, field of view, sensor width, sensor height (mm) */
  LANCER_FISHEYE_POLYNOMIAL = 5,  /* panorama: field of view, sensor width, sensor height (mm), k0 ... k4 */
  LANCER_MIRROR_BALL = 6,
  LANCER_CYLINDRICAL = 7 /* panorama: longitude_min, longitude_max, height_min, height_max, radius */
};

/* The camera looks along its local -z, y up. */
typedef struct lancer_camera {
  double matrix[12];                    /* camera to world; must be rigid (rotation or mirrored rotation, translation) */
  uint32_t kind;                        /* LANCER_PERSPECTIVE ... */
  uint32_t width, height;               /* full image, pixels */
  uint32_t x, y;                        /* lower left pixel of the rendered region */
  uint32_t region_width, region_height; /* size of the rendered region */
  uint32_t aperture_blades;             /* below 3: a round lens */
  double window[4];            /* left, right, bottom, top of the full image: on the plane z = -1 (PERSPECTIVE), at any depth
                                  (ORTHOGRAPHIC); panoramas: where 0 ... 1 is the whole panorama */
  double panorama[8];          /* as the kind says, angles in radians */
  double clip_start, clip_end; /* along z; panoramas: along the ray */
  double lens_radius;          /* thin lens: aperture radius; 0 = everything sharp */
  double focal_distance;       /* along z, > 0 where lens_radius > 0; panoramas: along the ray */
  double aperture_rotation;    /* of the blades, radians */
  double aperture_ratio;       /* height of the bokeh over its width; 1 = round */
} lancer_camera;

enum lancer_integrator { LANCER_PATH = 0, LANCER_CLASSIC = 1, LANCER_NORMALS = 2 };
enum lancer_pixel_filter { LANCER_FILTER_BOX = 0, LANCER_FILTER_BLACKMAN_HARRIS = 1 };
enum lancer_features { LANCER_FEATURES_SCENE = 0, LANCER_FEATURES_ALL = 1 };

/* Passes; the film keeps those whose bit (1u << pass) is in lancer_settings.passes. Channels in brackets; "mean": over samples;
 * "sample 0": of the first sample, unfiltered. A component's direct and indirect light are divided by its colour (a channel
 * without colour gets the mean of the other two, or of the one that has some), so that
 *   COMBINED = DIFFUSE_COLOR (DIFFUSE_DIRECT + DIFFUSE_INDIRECT) + GLOSSY_... + TRANSMISSION_... + EMISSION + ENVIRONMENT.
 * Light passes are PATH's; CLASSIC and NORMALS give them as 0. */
enum lancer_pass {
  LANCER_PASS_COMBINED = 0,               /* [4] premultiplied */
  LANCER_PASS_DEPTH = 1,                  /* [1] along the camera's z (panoramas: distance); 1e10 where nothing is. Sample 0 */
  LANCER_PASS_NORMAL = 2,                 /* [3] shading normal, world, mean */
  LANCER_PASS_ALBEDO = 3,                 /* [3] for denoising: sum of the lobes' albedos, mean */
  LANCER_PASS_POSITION = 4,               /* [3] world. Sample 0 */
  LANCER_PASS_OBJECT_INDEX = 5,           /* [1] sample 0 */
  LANCER_PASS_MATERIAL_INDEX = 6,         /* [1] sample 0 */
  LANCER_PASS_UV = 7,                     /* [3] u, v, 1, mean */
  LANCER_PASS_MIST = 8,                   /* [1] mean */
  LANCER_PASS_EMISSION = 9,               /* [3] */
  LANCER_PASS_ENVIRONMENT = 10,           /* [3] */
  LANCER_PASS_AMBIENT_OCCLUSION = 11,     /* [3] */
  LANCER_PASS_DIFFUSE_DIRECT = 12,        /* [3] */
  LANCER_PASS_DIFFUSE_INDIRECT = 13,      /* [3] */
  LANCER_PASS_DIFFUSE_COLOR = 14,         /* [3] */
  LANCER_PASS_GLOSSY_DIRECT = 15,         /* [3] */
  LANCER_PASS_GLOSSY_INDIRECT = 16,       /* [3] */
  LANCER_PASS_GLOSSY_COLOR = 17,          /* [3] */
  LANCER_PASS_TRANSMISSION_DIRECT = 18,   /* [3] */
  LANCER_PASS_TRANSMISSION_INDIRECT = 19, /* [3] */
  LANCER_PASS_TRANSMISSION_COLOR = 20,    /* [3] */
  LANCER_PASS_DENOISING_NORMAL = 21,      /* [3] camera space, mean */
  LANCER_PASS_DENOISING_DEPTH = 22,       /* [1] mean */
  LANCER_PASS_ERROR = 23, /* [1] standard error of the mean luminance; infinity below two samples a pixel. Always kept */
  LANCER_PASS_COUNT = 24
};

typedef struct lancer_settings {
  uint32_t integrator; /* LANCER_PATH ... */
  uint32_t samples;    /* planned per pixel; CLASSIC with 1 takes the middle of pixel, lens and light */
  uint32_t seed;
  uint32_t max_bounces;               /* PATH: scatterings after the first; CLASSIC: depth of the recursion */
  float contribution_threshold;       /* CLASSIC: a ray that brings no more than this share of what it meets is not traced;
                                         0 = never */
  float clamp_indirect;               /* PATH: largest channel of a sample's indirect light; 0 = off */
  uint32_t split_lights, split_paths; /* PATH: how many lights a sample asks, and along how many paths it goes on, at the first
                                         surface that scatters into more than single directions; at most 16. 0 in both: as
                                         many as pay, which some pixels tell before the first sample, where 16 are planned */
  uint32_t pixel_filter;              /* LANCER_FILTER_* */
  float filter_width;                 /* full width in pixels */
  uint32_t film_transparent;          /* 1: the environment leaves alpha 0 */
  uint32_t transparent_glass;         /* 1: so it does where it is seen through glass of at most glass_roughness */
  float glass_roughness;              /* alpha */
  uint32_t transparent_bounces;       /* surfaces that a ray may pass straight through; the next one shows its own light only */
  uint32_t transparent_shadows;       /* surfaces that a shadow ray may pass, with those that the path before it has passed */
  float alpha_threshold; /* NORMAL, UV, DEPTH, POSITION and the indices are of the first surface at least this opaque */
  uint32_t environment_reflections; /* CLASSIC: 1 = a reflected or refracted ray takes its colour from the environment,
                                       untraced */
  float occlusion_distance;         /* AMBIENT_OCCLUSION: how far a thing may be to darken; 0 = any distance */
  float mist_start, mist_depth, mist_falloff; /* MIST: distances from the camera; the exponent */
  uint32_t blended_features; /* ALBEDO, DENOISING_*: 0 = one surface gives all, as in Blender up to 5.1; 1 = surfaces share, by
                                how matt they are, as in 5.2 */
  uint32_t features;         /* LANCER_FEATURES_SCENE: the kernel for what the scene uses; ALL: the general one. Same pixels */
  uint32_t passes;           /* bits 1u << LANCER_PASS_*; COMBINED is always kept */
  uint32_t threads;          /* 0 = one per processor */
  uint32_t tile_size;        /* pixels; 0 = Lancer's choice. Changes no pixel */
  uint32_t refines;          /* 1: lancer_session_refine will be called */
} lancer_settings;

typedef struct lancer_progress {
  double fraction;  /* of the range given to lancer_session_render, 0 ... 1 */
  double seconds;   /* rendering time of this session so far */
  uint64_t samples; /* pixel samples of this session so far */
  uint64_t rays;    /* rays of all kinds so far */
} lancer_progress;

typedef struct lancer_statistics {
  double build_seconds, render_seconds;
  uint64_t samples;                               /* pixel samples */
  uint64_t camera_rays, bounce_rays, shadow_rays; /* traced; pixels of nothing but an even background need none */
  uint64_t invalid_samples;                       /* non-finite, dropped, among those that the film has */
  uint32_t invalid_x, invalid_y, invalid_sample;  /* the first of them by sample, then row, for lancer_debug_sample */
  uint32_t threads;
  uint64_t triangles, instances, lights;
  uint64_t geometry_bytes, accelerator_bytes, film_bytes;
  char features[512];       /* what the scene uses, separated by blanks */
  char kernel[64];          /* the integrator's specialisation that ran */
  char instruction_set[32]; /* e.g. "AVX2" */
  uint64_t texture_bytes;   /* pictures; geometry_bytes has meshes, instances and lights */
  /* Vertices of rays on surfaces: shaded by kernels of many lanes, and one by one by the general code. Layers that a cut-out
   * takes away are none. */
  uint64_t wide_vertices, narrow_vertices;
  uint32_t split_lights, split_paths; /* as samples were taken; 0 before the first */
} lancer_statistics;

/* The scene must be committed. Checks camera and settings; allocates the film. */
LANCER_API lancer_status lancer_session_create(lancer_scene scene, const lancer_camera *camera, const lancer_settings *settings,
                                               lancer_session *session);
LANCER_API lancer_status lancer_session_destroy(lancer_session session);
/* Starts the samples first ... first + count - 1 of every pixel. first must follow what was rendered before (0 at the start).
 * Any split of a range, any number of threads and any tile size give the same bits. */
LANCER_API lancer_status lancer_session_render(lancer_session session, uint32_t first, uint32_t count);
/* Waits at most the given time. LANCER_OK: the range is done. progress may be NULL. */
LANCER_API lancer_status lancer_session_wait(lancer_session session, uint32_t milliseconds, lancer_progress *progress);
/* Asks the running range to stop; *_wait then gives LANCER_CANCELLED. The film keeps what each pixel has. */
LANCER_API lancer_status lancer_session_cancel(lancer_session session);
/* Asks the running range to stop; *_wait then gives LANCER_OK. Of each pixel's samples the film keeps the largest power of two,
 * and the session can go on: by lancer_session_render where all pixels have the same number, else by lancer_session_refine. */
LANCER_API lancer_status lancer_session_stop(lancer_session session);
/* Starts a round that doubles the samples of those pixels where this brings the error down most for its cost: as many as it
 * takes to bring the bound on the error (high + cannot_exclude at that confidence) below target, or with target 0 all of them,
 * in that order; none beyond settings.samples. target is finite and not negative. What a pixel needs is judged by other pixels'
 * samples, which leaves its mean without bias. LANCER_OK: started, watch it with lancer_session_wait. LANCER_CANCELLED: nothing
 * is left to double. Needs settings.refines, and every pixel's number of samples a power of two. */
LANCER_API lancer_status lancer_session_refine(lancer_session session, double target, double confidence);
/* Copies one pass of the region: [region_height][region_width][channels]; float_count must be exactly that. While rendering,
 * too. */
LANCER_API lancer_status lancer_session_read(lancer_session session, uint32_t pass, float *out, size_t float_count);
LANCER_API lancer_status lancer_session_statistics(lancer_session session, lancer_statistics *statistics);

/* How far the picture is from the converged one: the root mean square over pixels of the standard error of their luminance,
 * each relative to the pixel's luminance plus 1 % of the picture's mean. Luminance is that of ITU-R BT.709. */
typedef struct lancer_error {
  double error;           /* infinity before every pixel has two samples, and so are low, high and cannot_exclude */
  double low, high;       /* the truth lies between them with the confidence asked for */
  double cannot_exclude;  /* what light in flashes that no sample has met may add to the error, at 95 %: the rule of three */
  double clipped;         /* share of the picture's light that clamp_indirect has taken away */
  double missing;         /* PATH: share that bounces beyond max_bounces would add, as far as the last ones tell; else 0 */
  double planned_samples; /* pixel samples that the last lancer_session_refine still wanted in all */
  uint32_t least_samples, most_samples; /* of a pixel */
} lancer_error;
/* The error of the film as it is, at a confidence in (0, 1). While rendering, too. */
LANCER_API lancer_status lancer_session_error(lancer_session session, double confidence, lancer_error *error);

/* ---- replay ------------------------------------------------------------------------------------------------------ */

/* One vertex of a replayed sample. */
typedef struct lancer_vertex {
  double position[3]; /* world */
  double t;           /* along the ray, scene units */
  float normal[3];    /* shading normal, world */
  float beta[3];      /* throughput on arrival */
  float radiance[3];  /* the sample's radiance on arrival, without this vertex's own light */
  uint32_t instance, primitive, material, depth;
} lancer_vertex;

/* Computes sample s of pixel (x, y) of the region again, by itself. rgba: what it adds to the film (float[4]).
 * vertices: the first capacity vertices in order of visit (may be NULL with 0); *count gets how many there were. */
LANCER_API lancer_status lancer_debug_sample(lancer_session session, uint32_t x, uint32_t y, uint32_t s, float *rgba,
                                             lancer_vertex *vertices, uint32_t capacity, uint32_t *count);

/* ---- probes: the stages by themselves, vectorised, for tests ------------------------------------------------------ */

typedef struct lancer_hit {
  double t;           /* in units of the direction's length; infinity on a miss */
  double u, v;        /* barycentric weights of vertex 1 and 2; for exact surfaces their parametrisation */
  double position[3]; /* world */
  float normal[3];    /* shading normal, world, unit, on the side of the outward geometric normal */
  float geometric_normal[3];
  float uv[2];
  float color[3];     /* vertex colour, 1 without */
  uint32_t instance;  /* in order of adding; UINT32_MAX on a miss */
  uint32_t primitive; /* triangle as given to add_mesh; 0 for exact surfaces */
  uint32_t material;  /* UINT32_MAX where the instance has no slot */
} lancer_hit;

/* Closest hits with tmin < t < tmax. origins, directions [count][3]; tmin, tmax [count]. */
LANCER_API lancer_status lancer_probe_intersect(lancer_scene scene, uint32_t count, const double *origins,
                                                const double *directions, const double *tmin, const double *tmax,
                                                lancer_hit *hits);
/* occluded[i] = 1 where anything is met with tmin < t < tmax. */
LANCER_API lancer_status lancer_probe_occluded(lancer_scene scene, uint32_t count, const double *origins,
                                               const double *directions, const double *tmin, const double *tmax,
                                               uint8_t *occluded);

/* What the wide BVH looks at to answer lancer_probe_occluded (any = 1) or lancer_probe_intersect (any = 0) for all these rays
 * together; zeros with another accelerator. counts[4]: nodes of eight boxes (256 bytes each); blocks of four triangles (160);
 * blocks of four exact spheres (416); trees of meshes that were entered and single exact surfaces. */
LANCER_API lancer_status lancer_probe_traversal(lancer_scene scene, uint32_t count, const double *origins,
                                                const double *directions, const double *tmin, const double *tmax, uint32_t any,
                                                uint64_t *counts);

/* f[count][3] and pdf[count] of a material for local directions wo, wi [count][3] (n = +z, tangent +x; nodes see the middle of
 * a unit square); f without cosine, pdf per solid angle; lobes that are a single direction give 0 here. */
LANCER_API lancer_status lancer_probe_bsdf(lancer_scene scene, uint32_t material, uint32_t count, const float *wo,
                                           const float *wi, float *f, float *pdf);

typedef struct lancer_bsdf_sample {
  float wi[3];
  float weight[3]; /* f |cos| / pdf; for a single direction the whole weight / probability; 0 = no sample */
  float pdf;       /* per solid angle; for a single direction its probability */
  uint32_t delta;  /* 1 for a single direction */
} lancer_bsdf_sample;
/* Samples a material: wo [count][3], u [count][3] in [0, 1). */
LANCER_API lancer_status lancer_probe_bsdf_sample(lancer_scene scene, uint32_t material, uint32_t count, const float *wo,
                                                  const float *u, lancer_bsdf_sample *samples);

/* A lobe as it stands for one wo, after nodes and layers. */
typedef struct lancer_lobe_info {
  uint32_t kind;      /* LANCER_LAMBERT ...; never PRINCIPLED */
  uint32_t component; /* 0 diffuse, 1 glossy, 2 transmission */
  float weight[3];    /* what its value is multiplied with */
  float albedo[3];    /* what it scatters of light from wo, weight included */
  float roughness[2]; /* alpha along tangent and bitangent */
  float ior;
  float probability; /* of being sampled */
} lancer_lobe_info;
/* The lobes that a material has for the local direction wo (float[3]): the first capacity of them; *count gets how many.
 * emission and transmittance (float[3] each) may be NULL. */
LANCER_API lancer_status lancer_probe_lobes(lancer_scene scene, uint32_t material, const float *wo, lancer_lobe_info *lobes,
                                            uint32_t capacity, uint32_t *count, float *emission, float *transmittance);
/* Values [count][4] of a node of a material at UV coordinates [count][2] of a unit square in the plane z = 0 of its object,
 * seen along its normal. */
LANCER_API lancer_status lancer_probe_node(lancer_scene scene, uint32_t material, uint32_t node, uint32_t count,
                                           const float *uv, float *values);
/* The value (float[4]) of a node whose inputs are constants and which asks nothing of a place, as programs compute it. Other
 * nodes are a wrong argument. */
LANCER_API lancer_status lancer_evaluate_node(const lancer_node *node, float *value);
/* Radiance [count][3] of the world in unit directions [count][3], and the density per solid angle with which it is sampled. */
LANCER_API lancer_status lancer_probe_world(lancer_scene scene, uint32_t count, const double *directions, float *radiance,
                                            float *pdf);

/* The terms of BECKMANN for cosines against n and h: D(n.h), F(l.h), G1 of a direction with cosine n.v and v.h > 0. Arrays
 * [count]. */
LANCER_API lancer_status lancer_probe_microfacet(uint32_t count, const float *cos_nh, const float *cos_lh, const float *cos_nv,
                                                 const float *alpha, const float *ior, float *d, float *f, float *g1);

typedef struct lancer_light_sample {
  double wi[3];      /* unit, towards the light */
  double distance;   /* infinite for sun and environment */
  float radiance[3]; /* for a point-like light: intensity / distance^2 (irradiance at normal incidence) */
  float pdf;         /* per solid angle; 1 for a point-like light; 0 = no sample */
  uint32_t delta;
  uint32_t reserved;
} lancer_light_sample;
/* Samples one light as seen from points [count][3] with u [count][2]. Lights are numbered as added, then one per emitting
 * instance, then the environment where its radiance varies (a constant one is found best by the BSDF's own samples). */
LANCER_API lancer_status lancer_probe_light(lancer_scene scene, uint32_t light, uint32_t count, const double *points,
                                            const float *u, lancer_light_sample *samples);
/* Density per solid angle with which that light would sample wi (unit, [count][3]) from points; 0 where the direction misses
 * it. */
LANCER_API lancer_status lancer_probe_light_pdf(lancer_scene scene, uint32_t light, uint32_t count, const double *points,
                                                const double *wi, float *pdf);

/* Rays for raster positions [count][2] (pixels of the full image, 0, 0 lower left corner) and lens [count][2] in [0, 1).
 * Directions have z component 1 along the camera's axis (PERSPECTIVE) or unit length; 0, 0, 0 where a panorama shows
 * nothing. */
LANCER_API lancer_status lancer_probe_camera(lancer_session session, uint32_t count, const double *raster, const double *lens,
                                             double *origins, double *directions);

/* The sampler's numbers for dimensions 0 ... dimensions - 1 of one address: out[dimensions] in [0, 1). */
LANCER_API lancer_status lancer_probe_sampler(uint32_t seed, uint32_t x, uint32_t y, uint32_t sample, uint32_t dimensions,
                                              float *out);
/* Offsets from the pixel's middle, in pixels, that a filter of that kind and full width gives for u [count]. */
LANCER_API lancer_status lancer_probe_filter(uint32_t filter, float width, uint32_t count, const float *u, float *offset);

#ifdef __cplusplus
}
#endif
#endif
