/* Lancer's C interface: fill a scene, commit it, render samples, read the film.
 *
 * Conventions
 *   - Every call except the plain queries returns a lancer_status. For any status other than LANCER_OK, LANCER_RUNNING and
 *     LANCER_CANCELLED, lancer_last_error() returns one sentence that names the object and the value.
 *   - The message is kept per thread until that thread's next call.
 *   - Handles are numbers. A freed, foreign or zero handle returns LANCER_ERROR_HANDLE and never crashes.
 *   - Arrays are copied during the call; the caller may free them when the call returns. Texels of LANCER_LAYOUT_BLOCKS stay.
 *   - No call blocks for long: *_commit and *_render start work, *_wait waits for it and reports its progress.
 *   - Calls on different handles may come from different threads at once; calls on one handle are serialised.
 *
 * Units and frames
 *   Lengths in scene units (Blender: metres), angles in radians, right-handed world, linear RGB, premultiplied alpha.
 *   Matrices are 3 x 4, row-major, double: p_world = M[:, 0:3] p_object + M[:, 3].
 *   Images: row 0 is the bottom row, pixels left to right. */
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

/* Incremented with each change of a struct or a call of this header. */
#define LANCER_ABI_VERSION 15u

/* Limits: nodes of a material or world; recursion of CLASSIC, in which glass doubles the rays with every depth. */
#define LANCER_MOST_NODE_RAYS 128u /* of an OCCLUSION or a BEVEL */
#define LANCER_MOST_NODES 4096u
#define LANCER_DEEPEST_RECURSION 16u
#define LANCER_MOST_MATTES 64u /* of a kind in a pixel: those with the largest shares stay */
#define LANCER_PASS_SPAN 4096u /* see lancer_pass_kind */

typedef uint64_t lancer_scene;
typedef uint64_t lancer_session;

typedef int32_t lancer_status;
enum {
  LANCER_OK = 0,
  LANCER_RUNNING = 1,        /* *_wait: not finished yet */
  LANCER_CANCELLED = 2,      /* *_wait: cancelled by the caller; the film keeps finished samples */
  LANCER_ERROR_ARGUMENT = 3, /* a value is out of range or invalid */
  LANCER_ERROR_HANDLE = 4,   /* no such scene or session, or a freed one */
  LANCER_ERROR_STATE = 5,    /* wrong order of calls: fill after commit, render before commit, or busy */
  LANCER_ERROR_MEMORY = 6,   /* not enough memory */
  LANCER_ERROR_INTERNAL = 7  /* a fault in Lancer itself */
};

/* ---- the library ------------------------------------------------------------------------------------------------ */

LANCER_API uint32_t lancer_abi_version(void);
/* The release number, e.g. "0.1.0". */
LANCER_API const char *lancer_version(void);
/* The message of this thread's last failed call; "" if none failed. */
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
  LANCER_STRUCT_DENOISED_ERROR,
  LANCER_STRUCT_RANGE,
  LANCER_STRUCT_PART,
  LANCER_STRUCT_PORTAL,
  LANCER_STRUCT_MADE,
  LANCER_STRUCT_MOTION,
  LANCER_STRUCT_OUTPUT,
  LANCER_STRUCT_TEXEL,
  LANCER_STRUCT_BAKE,
  LANCER_STRUCT_COUNT
} lancer_struct;
/* Returns sizeof the struct with this lancer_struct number, or 0 for an unknown number, so that a caller can refuse a stale
 * library. */
LANCER_API uint32_t lancer_sizeof(uint32_t which);

/* ---- geometry --------------------------------------------------------------------------------------------------- */

enum lancer_normal_domain { LANCER_NORMALS_NONE = 0, LANCER_NORMALS_VERTEX = 1, LANCER_NORMALS_CORNER = 2 };

/* The elements of a mesh that carry one value each. */
enum lancer_domain { LANCER_DOMAIN_VERTEX = 0, LANCER_DOMAIN_FACE = 1, LANCER_DOMAIN_CORNER = 2 };

/* A named mesh attribute that nodes read: further UV maps and colours, tangents, coordinates. Interpolated linearly. */
typedef struct lancer_attribute {
  const char *name;    /* UTF-8; the name by which a node reads it */
  const float *values; /* [n][channels]; n = vertex_count, triangle_count or 3 triangle_count, by domain */
  uint32_t domain;     /* LANCER_DOMAIN_* */
  uint32_t channels;   /* 1 ... 4. One channel is a scalar; otherwise missing channels are 0 and a missing fourth is 1 */
} lancer_attribute;

/* A triangle mesh in object space, shared by any number of instances. */
typedef struct lancer_mesh {
  const char *name;                   /* UTF-8, for messages */
  const float *positions;             /* [vertex_count][3] */
  const uint32_t *triangles;          /* [triangle_count][3], indices below vertex_count, counter-clockwise from outside */
  const float *normals;               /* NULL, [vertex_count][3] or [triangle_count][3][3], by normal_domain */
  const float *uvs;                   /* NULL or [triangle_count][3][2] */
  const float *colors;                /* NULL or [triangle_count][3][3], linear RGB */
  const uint16_t *material_slots;     /* NULL (all slot 0) or [triangle_count] */
  const uint32_t *polygons;           /* NULL (each triangle is a polygon) or [triangle_count]: the polygon of each triangle,
                                         below triangle_count. Read by CLASSIC's FLAT shading only */
  const lancer_attribute *attributes; /* NULL or [attribute_count] */
  uint32_t vertex_count;
  uint32_t triangle_count;
  uint32_t normal_domain; /* LANCER_NORMALS_* */
  uint32_t attribute_count;
  const float *moved_positions;  /* of a mesh that changes its shape: [key_count][vertex_count][3]; the key in the middle is as
                                    positions */
  const float *moved_normals;    /* NULL: the normals keep; or [key_count] times as normals */
  const float *vector_positions; /* for the pass VECTOR: [2][vertex_count][3], the vertices one frame before and one after;
                                    NULL: the mesh keeps its shape */
  uint32_t key_count;            /* 0: the mesh keeps its shape; see lancer_motion */
  uint32_t reserved;
} lancer_mesh;

/* Exact surfaces are defined in a unit frame; the instance's matrix translates, scales and shears them:
 *   SPHERE    |p| = 1
 *   PLANE     z = 0, infinite; the normal is +z
 *   CYLINDER  x^2 + y^2 = 1 for -1 <= z <= 1, closed by both disks
 *   CONE      apex (0, 0, 1), base disk of radius 1 at z = -1, closed by the disk */
enum lancer_instance_kind { LANCER_MESH = 0, LANCER_SPHERE = 1, LANCER_PLANE = 2, LANCER_CYLINDER = 3, LANCER_CONE = 4 };

/* How normals are used, and where CLASSIC computes light.
 *   AS_MESH  the mesh's normals; the faces' normals if the mesh has none
 *   FLAT     the faces' normals. CLASSIC computes one colour for each polygon, as if every ray hit it at its centre: the mean
 *            of its vertices, projected onto the polygon along its normal, or the nearest point of a concave polygon. This
 *            holds for light, shadows, highlights, textures, opacity, and the origins of mirrored and refracted rays; the
 *            passes of places (depth, position and others) are those of the pixel
 *   GOURAUD  CLASSIC computes illumination at the vertices and interpolates it; PATH uses PHONG
 *   PHONG    interpolated normals, averaged by area if the mesh has none */
enum lancer_shading {
  LANCER_SHADING_AS_MESH = 0,
  LANCER_SHADING_FLAT = 1,
  LANCER_SHADING_GOURAUD = 2,
  LANCER_SHADING_PHONG = 3
};

/* Rays by their origin. An object hidden from a kind of ray does not exist for rays of that kind. */
enum lancer_ray {
  LANCER_RAY_CAMERA = 1,
  LANCER_RAY_DIFFUSE = 2,
  LANCER_RAY_GLOSSY = 4,
  LANCER_RAY_TRANSMISSION = 8,
  LANCER_RAY_SHADOW = 16,
  LANCER_RAY_VOLUME = 32,
  LANCER_RAY_RAYCAST = 64 /* of a node RAYCAST */
};

/* A shadow catcher is an object that stands for one in footage: see lancer_settings.catchers. */
enum lancer_instance_flag {
  LANCER_INSTANCE_HOLDOUT = 1, /* a hole in the picture: alpha 0 where it is visible */
  LANCER_INSTANCE_CATCHER = 2
};

/* Light linking: an object is a receiver of light and a blocker of shadow rays in one of 64 sets each; 0 unless stated. A lamp
 * or an emitting object names the sets that its light does not reach, and those that its light passes as if they were not
 * there. Camera rays see every light. */

/* One placed object. */
typedef struct lancer_instance {
  double matrix[12];     /* object to world, 3 x 4 row-major; any invertible affine map, mirrored ones included */
  uint32_t kind;         /* LANCER_MESH ... LANCER_CONE */
  uint32_t mesh;         /* number of the mesh, in order of lancer_scene_add_mesh; used by LANCER_MESH only */
  uint32_t first_slot;   /* its material slots are slots[first_slot .. first_slot + slot_count) */
  uint32_t slot_count;   /* a triangle whose slot is beyond the last uses the last, as in Blender */
  uint32_t object_index; /* value of the object index pass */
  uint32_t shading;      /* LANCER_SHADING_* */
  uint32_t name;         /* offset of its NUL-terminated name in the names of lancer_scene_add_instances */
  uint32_t hidden_from;  /* LANCER_RAY_* bits */
  uint32_t flags;        /* LANCER_INSTANCE_* bits */
  uint32_t object_matte; /* id of its object matte: any number but 0; 0 = none */
  uint32_t asset_matte;  /* the same of its asset matte */
  uint32_t light_group;  /* of the light that it emits: 1 ... settings.light_groups; 0 = none */
  float terminator;      /* smooth meshes: below this cosine to the light, a shadow ray starts on the curved surface that the
                            normals describe, as with Blender's shadow terminator offset; 0 = on the triangle */
  uint32_t receiver_set; /* light linking: its set as a receiver, 0 ... 63 */
  uint32_t blocker_set;  /* its set as a blocker, 0 ... 63 */
  float fast_distance;   /* replaces that of the settings for rays that leave it; 0 = does not */
  uint32_t reserved;
  uint64_t unlit_sets; /* of an emitter: bits of the sets of receivers that its light does not reach */
  uint64_t clear_sets; /* of an emitter: bits of the sets of blockers that its light passes */
} lancer_instance;

/* ---- images ----------------------------------------------------------------------------------------------------- */

enum lancer_texel_kind { LANCER_TEXEL_U8 = 0, LANCER_TEXEL_U16 = 1, LANCER_TEXEL_FLOAT = 2 };
/* Conversion of an interpolated texel to scene-linear colour: decoded by the sRGB curve or not at all, then multiplied by
 * matrix. */
enum lancer_transfer { LANCER_TRANSFER_LINEAR = 0, LANCER_TRANSFER_SRGB = 1 };
/* Meaning of the fourth channel. ASSOCIATED: colour is premultiplied in memory. STRAIGHT: colour is not premultiplied in
 * memory, and a lookup multiplies it. CHANNEL_PACKED: colour and alpha are independent. NONE: alpha is 1. */
enum lancer_alpha_mode {
  LANCER_ALPHA_ASSOCIATED = 0,
  LANCER_ALPHA_STRAIGHT = 1,
  LANCER_ALPHA_CHANNEL_PACKED = 2,
  LANCER_ALPHA_NONE = 3
};

/* Order of texels. ROWS: [height][width][channels], row 0 at the bottom; the library copies them. BLOCKS: squares of 64 x 64
 * texels, row by row of squares, each [64][64][channels]; squares at the right and the top edge are whole, and their texels
 * beyond the image are not read. The library reads blocks in place: they begin at a multiple of 64 bytes, 3 readable bytes
 * follow the last, and they do not change until the scene and all sessions made from it are destroyed. Colour is already
 * multiplied by alpha: alpha is not STRAIGHT with four channels. Images are blocks; tables of numbers are rows. */
enum lancer_layout { LANCER_LAYOUT_ROWS = 0, LANCER_LAYOUT_BLOCKS = 1 };

typedef struct lancer_image {
  const char *name;
  const void *texels; /* in the order of layout, of kind; integers map to 0 ... 1 */
  uint32_t width, height;
  uint32_t channels; /* 1 (grey), 3 or 4 */
  uint32_t kind;     /* LANCER_TEXEL_* */
  uint32_t transfer; /* LANCER_TRANSFER_* */
  uint32_t alpha;    /* LANCER_ALPHA_* */
  uint32_t tile;     /* UDIM number, 1001 ...; 0 if the image is not a tile */
  uint32_t layout;   /* LANCER_LAYOUT_* */
  float matrix[9];   /* row-major: decoded RGB to the scene's working space */
  uint32_t gaps;     /* BLOCKS: number of texels that are not finite; the library counts those of ROWS */
  uint32_t mipmaps;  /* 1: a lookup for a ray reads the level whose texels are about as large as what the ray sees, as Cycles
                        does with a texture cache: each level has half the sides of the one before, rounded down and at least
                        1, until both are at most 64. The library makes the levels of ROWS; those of BLOCKS follow the image,
                        each in blocks of its own, whose texels lancer_make_mipmaps() makes. 0: lookups read the image */
  uint32_t reserved;
} lancer_image;

/* Makes the levels of an image of ROWS. levels: level 1 and all smaller ones, one after another, each [height][width][channels]
 * of the image's kind, with colour that is multiplied by alpha where alpha is STRAIGHT. */
LANCER_API lancer_status lancer_make_mipmaps(const lancer_image *image, void *levels);

/* ---- nodes ------------------------------------------------------------------------------------------------------ */

/* A value of a material, light or world: a constant, or the result of a node. A comment [kind number] gives the parameter's
 * kind and default. Kinds: color, RGB of 0 or more; share, 0 to 1; amount, 0 or more; signed, -1 to 1; index, an index of
 * refraction above 0; denser, an index of at least 1; turns, where 1 is a full turn; direction, in world space, 0, 0, 0 for
 * none; vector, any three numbers. */
typedef struct lancer_parameter {
  float value[3]; /* scalars use value[0] */
  int32_t node;   /* -1: use value; otherwise the number of a node of the same owner, whose result replaces value */
} lancer_parameter;

/* Nodes compute values at the hit of a ray. A node has up to five inputs, refers only to earlier nodes, and returns four
 * numbers: x, y, z or RGB, and alpha (1 if the node has none). A scalar is stored in x, y and z. Vectors are in world space
 * and lengths in scene units unless stated otherwise. */
enum lancer_node_kind {
  /* option LANCER_COORDINATE_*; matrix: world to object for OBJECT with flag 1; NORMAL with flag 1 is the same at all three
   * points of a bump; name: the UV map of UV ("" = the mesh's own) */
  LANCER_NODE_COORDINATE = 0,
  LANCER_NODE_ATTRIBUTE = 1, /* name: of the attribute; "" = the mesh's own colours; flags: LANCER_ATTRIBUTE_* */
  /* images [image, image + image_count): one image or the tiles of one; inputs: vector. option: projection LANCER_PROJECT_*;
   * flags: extension LANCER_EXTEND_* in bits 0-3, interpolation LANCER_INTERPOLATE_* in bits 4-7, 256 = return straight
   * colour (divided by alpha) according to the image's alpha mode, 512 = each side of BOX shows the tile of its place, else
   * the first image; input 1: blend of BOX. The vector is used as given: 0 ... 1 covers the image */
  LANCER_NODE_IMAGE = 2,
  /* as IMAGE, with a direction as vector; option LANCER_ENVIRONMENT_*; CUBE takes six images: +x -x +y -y +z -z, upright as
   * seen from inside with +z up; +z and -z as seen by a viewer who faces +y and then looks up or down */
  LANCER_NODE_ENVIRONMENT = 3,
  LANCER_NODE_ALPHA = 4,         /* the fourth number of input 0 */
  LANCER_NODE_MAPPING = 5,       /* inputs: vector, location, rotation (Euler XYZ), scale; option LANCER_MAPPING_* */
  LANCER_NODE_TRANSFORM = 6,     /* matrix times input 0; option 0 point, 1 vector, 2 normal (inverse transpose, normalised) */
  LANCER_NODE_MATH = 7,          /* inputs a, b, c; option LANCER_MATH_*; flag 1: clamp to 0 ... 1 */
  LANCER_NODE_VECTOR_MATH = 8,   /* inputs a, b, c, scale; option LANCER_VECTOR_* */
  LANCER_NODE_MIX = 9,           /* inputs factor, a, b; option LANCER_MIX_*; flag 1: clamp the factor, 2: clamp the result */
  LANCER_NODE_SEPARATE = 10,     /* component option (0, 1, 2) of input 0 */
  LANCER_NODE_COMBINE = 11,      /* inputs x, y, z */
  LANCER_NODE_GREY = 12,         /* luminance of input 0 with the weights matrix[0 ... 2] */
  LANCER_NODE_FRESNEL = 13,      /* inputs: IOR, normal */
  LANCER_NODE_LAYER_WEIGHT = 14, /* inputs: blend, normal; option 0 Fresnel, 1 facing */
  LANCER_NODE_NORMAL_MAP = 15,   /* inputs: strength, colour, normal; option 0 tangent, 1 object, 2 world, 3 object with y, z
                                    inverted (Blender's), 4 world with y, z inverted; name: the UV map, whose tangents are
                                    attribute "tangent:" + name; flag 1: normalise the interpolated normal of the frame, else
                                    keep its length */
  LANCER_NODE_BUMP = 16,    /* inputs: strength, distance, height, normal, filter width in pixels; flag 1: invert, 2: use the
                               surface before displacement, in object space, 4: give a flat face, too, its normal before
                               displacement. Nodes [first, this) compute the height; they are evaluated at the hit point, to
                               its right and above it */
  LANCER_NODE_TANGENT = 17, /* inputs: normal; option 0, 1, 2: radial about x, y, z of GENERATED; 3: along u of the UV map name;
                               flags in the world: 1: 0; 2: across the ray */
  LANCER_NODE_CLAMP = 18,   /* inputs: value, low, high */
  LANCER_NODE_DISPLACEMENT = 19, /* inputs: height, midlevel, scale, normal; option: space of scale, 0 object, 1 world.
                                    Returns an offset in object space */
  LANCER_NODE_GAMMA = 20,        /* inputs: colour, exponent */
  LANCER_NODE_INVERT = 21,       /* inputs: factor, colour */
  /* inputs: vector; w, scale, distortion; detail, roughness, lacunarity; offset, gain. option LANCER_NOISE_*; flags:
   * dimensions minus 1 in bits 0-1, and LANCER_NOISE_* bits */
  LANCER_NODE_NOISE = 22,
  /* inputs: vector; w, scale, randomness; detail, roughness, lacunarity; smoothness, exponent. option LANCER_VORONOI_*;
   * flags: dimensions minus 1 in bits 0-1, LANCER_VORONOI_EUCLIDEAN ... in bits 2-3, and LANCER_VORONOI_* bits */
  LANCER_NODE_VORONOI = 23,
  LANCER_NODE_GRADIENT = 24, /* inputs: vector; option LANCER_GRADIENT_* */
  /* inputs: factor, value. image: one row of at least two floating-point texels, read as they are in memory: values at equal
   * distances from matrix[0] to matrix[1]. One channel is a curve of the value's x; more channels are one curve each. option
   * 1: evaluate all curves at the value's x and ignore the factor. flag 1: extrapolate the first and last line, 2: step to
   * the entry before instead of interpolating */
  LANCER_NODE_CURVES = 25,
  LANCER_NODE_OBJECT_INFO = 26, /* of the object hit; option LANCER_OBJECT_*; name: of ATTRIBUTE */
  LANCER_NODE_LIGHT_PATH = 27,  /* of the ray that has hit the surface or reached the world; option LANCER_PATH_* */
  LANCER_NODE_COLOR_MODEL = 28, /* inputs: colour; option LANCER_COLOR_* */
  /* inputs: vector; scale, distortion, phase; detail, scale and roughness of the noise that distorts. option
   * LANCER_PROFILE_*; flags: LANCER_WAVE_* in bits 0-2, and LANCER_NOISE_REPEATS */
  LANCER_NODE_WAVE = 29,
  /* inputs: vector; scale, distortion. option: depth, 0 ... 10; flag 1: scale the vector, else the argument of the waves */
  LANCER_NODE_MAGIC = 30,
  LANCER_NODE_CHECKER = 31, /* inputs: vector, scale. Returns 1 in cells of the first colour, 0 in others */
  /* inputs: vector; scale, mortar size, mortar smooth; bias, brick width, row height; offset, squash; of how many rows one is
   * moved, and squashed. Returns the share of the second colour, and the share of mortar */
  LANCER_NODE_BRICK = 32,
  LANCER_NODE_WHITE_NOISE = 33, /* inputs: vector, w. flags: dimensions minus 1 in bits 0-1, LANCER_NOISE_COLOR */
  /* inputs: vector; scale, frequency, anisotropy; orientation: an angle, or with option 1 a direction. option 0 in the plane,
   * 1 in space. Returns value, phase, intensity */
  LANCER_NODE_GABOR = 34,
  /* inputs: vector; sides, roundness. option 0: segment coordinates x and y, segment width, segment rotation; 1: the segment's
   * number. flag 1: normalise */
  LANCER_NODE_RADIAL_TILING = 35,
  LANCER_NODE_WIREFRAME = 36, /* inputs: size; flag 1: in pixels. Returns 1 near an edge of the triangle, else 0 */
  /* inputs: vector. option as TRANSFORM; flags: LANCER_SPACE_* of the vector in bits 0-1, of the result in bits 2-3 */
  LANCER_NODE_VECTOR_TRANSFORM = 37,
  /* inputs: direction, strength. image: rows of floating-point texels, one number each, at least 5 x 5: in the first row, from
   * the third texel to the last but one, ascending angles from -z, in the first column those around z, from -y on, both in
   * radians; from the second row and texel on the intensities there, with one more row and column on each side, by which the
   * cubic interpolation of Catmull and Rom is continued. Returns strength times the intensity; outside the angles 0 */
  LANCER_NODE_IES = 38,
  /* The radiance of the sky, not negative. inputs: direction, in which z is up; option LANCER_SKY_*. image, of three
   * floating-point channels, read as they are in memory, by option:
   *   PREETHAM, HOSEK_WILKIE: one row of 11 texels: direction of the sun; radiance; nine coefficients of x, y, Y (PREETHAM,
   *     five are used) or X, Y, Z. matrix[0 ... 8]: CIE XYZ to RGB.
   *   others: RGB by azimuth from the one opposite the sun, and by elevation, as lancer_compute_sky. matrix[0 ... 2] and
   *     [3 ... 5]: RGB of the lower and the upper rim of the sun's disc, [6 ... 8]: direction of the sun, [9]: its diameter in
   *     radians, 0 = no disc, [10]: the elevation below which the ground hides the disc */
  LANCER_NODE_SKY = 39,
  /* Nodes that look around the surface that a path of PATH meets; in shadows, lights, the world and displacement they meet
   * nothing. Lengths are those of the user's world.
   * inputs: distance, normal, the constant 0 = the shading normal. option: number of rays; flags 1: of the inside, 2: only its
   * own object occludes. Returns the open share */
  LANCER_NODE_OCCLUSION = 40,
  /* inputs: radius; a normal, to which the bevel's change is added, the constant 0 = none; the surface's own normal, as
   * OCCLUSION's. option: number of rays. Returns a normal */
  LANCER_NODE_BEVEL = 41,
  /* inputs: position; direction; length, in those of the direction. option 0: 1 if there is a hit, 1 if of its own object, the
   * distance; 1: position, 2: normal of the hit, else 0, 0, 0; 3: the attribute `name` there, 0 with alpha 1 if its mesh has
   * none. flag 1: its own object alone; of an attribute flag 2: its mean, or the first of two numbers, 4: its alpha */
  LANCER_NODE_RAYCAST = 42,
  /* inputs: vector. option LANCER_INTERPOLATE_*. image: a cube of n x n x n floating-point voxels of four channels, read as
   * they are in memory, n texels wide and n * n high: layer z has the rows from n * z on. 0 ... 1 along each axis covers the
   * cube, outside all is 0. Returns the first three channels, and the fourth as alpha */
  LANCER_NODE_VOXELS = 43,
  LANCER_NODE_COUNT = 44
};
/* Models of the sky. NISHITA: the single scattering of Blender before 5.0. */
enum lancer_sky_model {
  LANCER_SKY_PREETHAM = 0,
  LANCER_SKY_HOSEK_WILKIE,
  LANCER_SKY_NISHITA,
  LANCER_SKY_SINGLE_SCATTERING,
  LANCER_SKY_MULTIPLE_SCATTERING,
  LANCER_SKY_COUNT
};
enum lancer_profile { LANCER_PROFILE_SIN = 0, LANCER_PROFILE_SAW, LANCER_PROFILE_TRI, LANCER_PROFILE_COUNT };
/* Bands across an axis, or rings around it. */
enum lancer_wave {
  LANCER_WAVE_BANDS_X = 0,
  LANCER_WAVE_BANDS_Y,
  LANCER_WAVE_BANDS_Z,
  LANCER_WAVE_BANDS_DIAGONAL,
  LANCER_WAVE_RINGS_X,
  LANCER_WAVE_RINGS_Y,
  LANCER_WAVE_RINGS_Z,
  LANCER_WAVE_RINGS_SPHERICAL
};
enum lancer_space { LANCER_SPACE_WORLD = 0, LANCER_SPACE_OBJECT, LANCER_SPACE_CAMERA };
enum lancer_attribute_flag {
  LANCER_ATTRIBUTE_OPAQUE = 1, /* alpha is 1 on a mesh without the attribute; else 0 */
  LANCER_ATTRIBUTE_FIRST = 2,  /* of two channels the first is in x, y, z, for a node that reads one number */
  LANCER_ATTRIBUTE_STILL = 4   /* in the height of a bump: the value at the bump itself */
};
/* Conversion between linear RGB and hue, saturation and value (HSV) or lightness (HSL). */
enum lancer_color_model {
  LANCER_COLOR_TO_HSV = 0,
  LANCER_COLOR_FROM_HSV,
  LANCER_COLOR_TO_HSL,
  LANCER_COLOR_FROM_HSL,
  LANCER_COLOR_COUNT
};
enum lancer_object_fact {
  LANCER_OBJECT_LOCATION = 0, /* origin of its frame */
  LANCER_OBJECT_COLOR,        /* with alpha */
  LANCER_OBJECT_INDEX,
  LANCER_OBJECT_RANDOM,
  LANCER_OBJECT_ATTRIBUTE, /* of lancer_scene_add_object_attribute; four times 0 without one; 0, 0, 0, 1 in the world */
  LANCER_OBJECT_COUNT
};
/* Facts about the ray of a hit. IS_*: 1 or 0. LENGTH: scene units. *_DEPTH: number of earlier scattering events, of that
 * kind, or of surfaces passed straight through. */
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
  LANCER_NOISE_NORMALIZED = 4, /* FBM: map to 0 ... 1 */
  LANCER_NOISE_REPEATS = 8,    /* period 100 000 along each axis, as from Blender 4.2 on */
  LANCER_NOISE_COUNTED = 16,   /* detail is the number of octaves, as in the Musgrave Texture; without this flag, one less */
  LANCER_NOISE_COLOR = 32      /* green and blue are separate noises */
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
  LANCER_VORONOI_COLOR = 32,     /* x, y, z are the colour of the cell and the fourth number is the distance; without this flag
                                    all four are the distance */
  LANCER_VORONOI_POSITION = 64,  /* x, y, z are the position of the point and the fourth number is its w */
  LANCER_VORONOI_INTEGERS = 128, /* cells are hashed as from Blender 5.0 on */
  LANCER_VORONOI_BOUNDED = 256   /* distances are at most 8, as before Blender 4.0 */
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
  LANCER_COORDINATE_GENERATED = 0, /* 0 ... 1 over the mesh's bounds, or attribute "generated" if the mesh has it */
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
  LANCER_COORDINATE_BACKFACING = 11,    /* 1 if seen from inside */
  LANCER_COORDINATE_PARAMETRIC = 12,    /* barycentric weights of vertices 0 and 1, as in Blender */
  LANCER_COORDINATE_FROM_CAMERA = 13,   /* as CAMERA, but in the height of a bump that of the bump itself, and in the world
                                           that of the direction taken as a point */
  LANCER_COORDINATE_EDGE_U = 14,        /* world: from vertex 0 of a triangle to 1, Cycles' dPdu on meshes; else 0, 0, 0 */
  LANCER_COORDINATE_EDGE_V = 15,        /* from vertex 0 to 2, Cycles' dPdv */
  LANCER_COORDINATE_COUNT = 16
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
/* As in Blender's nodes of these names. */
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

/* A flag of nodes of all kinds: the value is taken as constant over a pixel where an image with mipmaps follows how its
 * coordinates change, as Cycles takes the values of most nodes. */
#define LANCER_NODE_STEADY 2147483648u

typedef struct lancer_node {
  uint32_t kind;               /* LANCER_NODE_* */
  uint32_t option, flags;      /* their meaning depends on kind */
  uint32_t image, image_count; /* numbers of images, in order of lancer_scene_add_image */
  uint32_t first;              /* BUMP */
  const char *name;            /* NULL is "" */
  lancer_parameter inputs[5];
  float matrix[12]; /* 3 x 4 row-major */
} lancer_node;

/* Evaluates a node whose inputs are constants and that does not depend on the hit, as programs compute it: value (float[4]).
 * Any other node is a LANCER_ERROR_ARGUMENT. */
LANCER_API lancer_status lancer_evaluate_node(const lancer_node *node, float *value);

/* Computes the light that an atmosphere scatters, as CIE XYZ. model: NISHITA, SINGLE_SCATTERING or MULTIPLE_SCATTERING.
 * elevation and diameter of the sun: radians; altitude: metres; densities: of air, aerosols and ozone, 1 = the Earth's. xyz:
 * float[height][LANCER_SKY_WIDTH][3], height 128 for NISHITA, else 256. Columns go round from the azimuth opposite the sun.
 * Rows go up: of NISHITA from the horizon to the zenith, the elevation growing with the square of the row; else from the nadir
 * to the zenith, likewise on both sides of the horizon. rims: float[6], the radiance of the sun's disc at its lower and upper
 * rim. */
#define LANCER_SKY_WIDTH 512u
LANCER_API lancer_status lancer_compute_sky(uint32_t model, double elevation, double diameter, double altitude,
                                            const double *densities, float *xyz, float *rims);

/* ---- materials -------------------------------------------------------------------------------------------------- */

/* clang-format off */
/* Lobes, summed. In the local frame n = +z; wo and wi point away from the surface. Values are f, without the cosine.
 *   LAMBERT      color/pi, on both sides
 *   BECKMANN     color D F G / (4 (l.n)(v.n)): Beckmann D, exact dielectric Fresnel F of ior (infinite = 1), Smith G
 *                with Walter's rational G1; roughness is alpha itself. Below alpha 2e-5 a mirror weighted with F.
 *   MIRROR       color, in the mirrored direction only
 *   DIELECTRIC   smooth glass: color F reflected, color (1 - F) refracted, total internal reflection; ior is that of the
 *                inside, the side opposite to the geometric normal
 *   PHONG        color (n + 2)/(2 pi) max(0, R.V)^n in PATH; color max(0, R.V)^n per light / pi in CLASSIC; n = shininess
 *   BLINN_PHONG  color (n + 2)(n + 4)/(8 pi (2^(-n/2) + n)) max(0, N.H)^n in PATH; color max(0, N.H)^n / pi in CLASSIC
 *   MINNAERT     color (k + 1)/(2 pi) ((l.n)(v.n))^(k - 1), k = shininess; 1 is LAMBERT. color is the albedo at normal
 *                incidence. Below k = 1 the albedo would exceed 1 towards the horizon: cosines are clamped to at least
 *                m = max(color)^(1/(1 - k)), where it is 1, and 2 pi/(k + 1) becomes 2 pi ((1 - q)/(k + 1) + q/2), q = m^(k + 1)
 * The following are the lobes of Blender's shader nodes, as Cycles of the running version defines them. roughness is the
 * socket's: alpha is its square (DIFFUSE, SHEEN, VELVET, SUBSURFACE: the value itself); anisotropy and rotation turn and
 * stretch the lobe along tangent.
 *   DIFFUSE      Oren-Nayar of roughness; 0 is LAMBERT. option 0: before Blender 4.3, 1: energy-preserving, from 4.3
 *   GLOSSY       a metal of constant color, with distribution
 *   GLASS        reflection and refraction by Fresnel of ior, rough or smooth, with distribution
 *   REFRACTION   the refraction of GLASS alone, with weight color
 *   CONDUCTOR    option 0: F82, color at the normal and edge at 82 degrees; 1: ior = color, extinction = edge;
 *                2: the same, approximated for strong absorption as in Blender before 5.0
 *   SHEEN        cloth: distribution GGX = microfibres, BECKMANN = Ashikhmin's velvet (VELVET before 4.0)
 *   TRANSLUCENT  color/pi on the other side
 *   PRINCIPLED   see lancer_principled
 *   TOON         of constant brightness in a cone of the angle pi/2 roughness, which fades over pi/2 roughness_across; its axis
 *                is the normal for option 0, the mirrored direction for option 1
 *   HAIR         option 0: reflection, 1: transmission of the Hair BSDF along tangent; roughness along it, roughness_across
 *                around it, offset in radians
 *   HAIR_FIBRE   Principled Hair BSDF along tangent, as on meshes: color is the absorption, offset the tilt of the scales in
 *                radians. option 0: Chiang's model: roughness and roughness_across as in HAIR, edge[0] the roughness of the first
 *                reflection over roughness. option 1: Huang's model: roughness is alpha of the facets, roughness_across the
 *                minor axis over the major one, edge the factors of light reflected, passed, and reflected within once
 *   SUBSURFACE   light enters, goes below the surface of its object, and leaves elsewhere: color is the albedo of the surface,
 *                edge the radii of red, green and blue in world lengths, ior and roughness those of the facets that light
 *                enters by, anisotropy the mean cosine of scattering. option: LANCER_SUBSURFACE_*, plus 4 where radii below a
 *                quarter of a pixel are none (Blender 4.0 to 4.3). CLASSIC shows LAMBERT
 * film_thickness, in nanometres, and film_ior describe a film on GLASS and CONDUCTOR whose interference colours the reflected
 * light, in the primaries of Rec. 709; a film of at most 0.1 is none. */
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
  LANCER_TOON = 15,
  LANCER_HAIR = 16,
  LANCER_HAIR_FIBRE = 17,
  LANCER_SUBSURFACE = 18,
  LANCER_LOBE_KIND_COUNT = 19
};
/* RANDOM_WALK_LEGACY: Random Walk before Blender 5.2, in 3.x Random Walk (Fixed Radius); SKIN: in 3.x Random Walk. */
enum lancer_subsurface_method {
  LANCER_SUBSURFACE_BURLEY = 0,
  LANCER_SUBSURFACE_RANDOM_WALK_LEGACY = 1,
  LANCER_SUBSURFACE_SKIN = 2,
  LANCER_SUBSURFACE_RANDOM_WALK = 3
};
enum lancer_distribution {
  LANCER_DISTRIBUTION_GGX = 0,
  LANCER_DISTRIBUTION_BECKMANN = 1,
  LANCER_DISTRIBUTION_ASHIKHMIN_SHIRLEY = 2,
  LANCER_DISTRIBUTION_MULTI_GGX = 3
};
/* The Blender versions whose definitions hold for lobes of nodes: 3.x, 4.0 to 4.4, 4.5, 5.0 and 5.1, 5.2 and newer. */
enum lancer_rules {
  LANCER_RULES_BLENDER_3 = 0,
  LANCER_RULES_BLENDER_4 = 1,
  LANCER_RULES_BLENDER_45 = 2,
  LANCER_RULES_BLENDER_50 = 3,
  LANCER_RULES_BLENDER_52 = 4
};

/* The Principled BSDF's inputs under their newest names. Before 4.0 some have another meaning: specular is the level over
 * 0.08, specular_tint[0] and sheen_tint[0] mix in the base colour's hue, coat is four times the layer's weight;
 * transmission_roughness exists before 4.0 only. */
typedef struct lancer_principled {
  uint32_t rules;                          /* LANCER_RULES_* */
  uint32_t distribution;                   /* LANCER_DISTRIBUTION_GGX or LANCER_DISTRIBUTION_MULTI_GGX */
  uint32_t option;                         /* as in DIFFUSE, for diffuse_roughness */
  uint32_t subsurface_option;              /* as option of SUBSURFACE */
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
  lancer_parameter emission;               /* [vector 0] radiance, below sheen and coat; may be negative */
  lancer_parameter film_thickness;         /* [amount 0] nanometres, of a film on the base; from 5.0 on also on metal */
  lancer_parameter film_ior;               /* [index 1.33] */
  lancer_parameter thin_wall;              /* [share 0] from 5.2: above 0 the surface is a sheet with air on both sides */
  lancer_parameter wall_scattering;        /* [share 0] share of a sheet's diffuse light that also passes to the other side */
  lancer_parameter wall_forward;           /* [share 0.5] how much of that light passes */
  lancer_parameter subsurface;             /* [share 0] share of the diffuse light that goes below the surface */
  lancer_parameter subsurface_radius;      /* [color 0] of red, green and blue, in world lengths */
  lancer_parameter subsurface_color;       /* [color 0.8] before 4.0 only */
  lancer_parameter subsurface_ior;         /* [index 1.4] of SKIN, and before 4.0 */
  lancer_parameter subsurface_anisotropy;  /* [signed 0] mean cosine of scattering */
} lancer_principled;

typedef struct lancer_lobe {
  uint32_t kind;                       /* LANCER_LAMBERT ... */
  uint32_t distribution;               /* LANCER_DISTRIBUTION_GGX ...; GLOSSY, GLASS, REFRACTION, CONDUCTOR, SHEEN */
  uint32_t option;                     /* its meaning depends on kind */
  uint32_t rules;                      /* LANCER_RULES_* */
  lancer_parameter weight;             /* [color 1] factor of the whole lobe: the shares of the Mix Shaders above it */
  lancer_parameter color;              /* [color 0.8] Kd or Ks */
  lancer_parameter roughness;          /* [share 0.5] BECKMANN: alpha itself; others: the socket's value */
  lancer_parameter ior;                /* [index 1.5] relative to the outside, > 0, may be infinite */
  lancer_parameter shininess;          /* [amount 50] the exponent n of PHONG, BLINN_PHONG; k of MINNAERT */
  lancer_parameter edge;               /* [color 1] CONDUCTOR, HAIR_FIBRE, SUBSURFACE */
  lancer_parameter anisotropy;         /* [signed 0] GLOSSY, CONDUCTOR, SUBSURFACE */
  lancer_parameter rotation;           /* [turns 0] GLOSSY, CONDUCTOR */
  lancer_parameter normal;             /* [direction 0] none: the shading normal */
  lancer_parameter tangent;            /* [direction 0] none: any */
  lancer_parameter roughness_across;   /* [share 0] TOON, HAIR, HAIR_FIBRE */
  lancer_parameter offset;             /* [turns 0] HAIR, HAIR_FIBRE */
  lancer_parameter film_thickness;     /* [amount 0] GLASS, CONDUCTOR */
  lancer_parameter film_ior;           /* [index 1.33] GLASS, CONDUCTOR */
  const lancer_principled *principled; /* PRINCIPLED */
} lancer_lobe;

/* A part of a surface that light enters to go on elsewhere, as Cycles' Ray Portal. The weight is a part of the material's
 * transmittance. As in Cycles, shadow rays end at portals, but pass them straight where the surface has other transmittance,
 * too. In CLASSIC light goes straight on. */
typedef struct lancer_portal {
  uint32_t moves; /* 1: light goes on at position; 0: where it has met the surface */
  uint32_t reserved;
  lancer_parameter weight;    /* [color 0] factor of the light */
  lancer_parameter position;  /* [vector 0] world */
  lancer_parameter direction; /* [vector 0] world, of any length; 0, 0, 0: straight on */
} lancer_portal;

/* A value of a surface or of the world that goes into a pass AOV_COLOR or AOV_VALUE. As in Cycles, each surface that a ray of
 * the camera passes straight gives its value, up to the first with the opacity settings.alpha_threshold. The pass has the mean
 * over the samples. */
typedef struct lancer_output {
  uint32_t number;        /* of the pass */
  uint32_t is_color;      /* 1: AOV_COLOR, 0: AOV_VALUE */
  lancer_parameter value; /* [vector 0] */
} lancer_output;

enum lancer_material_flag {
  LANCER_MATERIAL_NO_BUMP_CORRECTION = 1, /* do not soften the terminator of bump-mapped surfaces */
  LANCER_MATERIAL_NOT_A_LIGHT = 2,        /* emits, but is never sampled as a light: only scattered rays find it */
  LANCER_MATERIAL_OPAQUE_SHADOWS = 4,     /* shadow rays ignore transmittance */
  LANCER_MATERIAL_KEEP_NORMALS = 8        /* displacement keeps the normals; a BUMP with flag 2 computes them */
};

typedef struct lancer_material {
  const char *name;
  const lancer_lobe *lobes;
  const lancer_node *nodes;
  const lancer_portal *portals;
  const lancer_output *outputs;
  uint32_t lobe_count;     /* at most 64; 0 is a black surface */
  uint32_t node_count;     /* at most LANCER_MOST_NODES */
  uint32_t material_index; /* value of the material index pass */
  uint32_t flags;          /* LANCER_MATERIAL_* bits */
  uint32_t portal_count;   /* at most 64 */
  uint32_t output_count;   /* at most LANCER_MOST_NODES */
  uint32_t matte;          /* id of its material matte: any number but 0; 0 = none */
  uint32_t reserved;
  lancer_parameter emission;      /* [color 0] radiance, both sides; may be negative */
  lancer_parameter transmittance; /* [color 0] factor of light that passes straight through; lobes and emission are not
                                     scaled by it */
  lancer_parameter holdout;       /* [share 0] share of the picture that becomes a hole */
  lancer_parameter ambient;       /* [color 0] Ka, CLASSIC only */
  lancer_parameter displacement;  /* [vector 0] offset of vertices in object space, applied at commit; 0, 0, 0: none. A mesh
                                     is displaced once for each list of displacing materials among its instances, at the
                                     first instance with that list */
  lancer_parameter normal;        /* [direction 0] replaces the shading normal of all lobes; 0, 0, 0: none */
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

/* A light emits along its local -z. Only the directions of the matrix's columns are used, not their lengths; sizes are world
 * lengths in the fields below. Columns that are not orthogonal shear the sides of an AREA, which then emits along the normal of
 * its plane, and the cone of a SPOT; other lights keep z. In PATH a light is visible to camera, mirror and glass rays unless it
 * is hidden from them.
 *
 * The nodes of a light give the factor of its emission at a point of the light, seen from a place that it lights. Their
 * position is that point, of a SUN the direction that the light travels in, as a point; their normals are those of an area or a
 * ball, otherwise the direction towards the lit place, as INCOMING. OBJECT and NORMAL are in the frame of matrix. PARAMETRIC is
 * the place in the light's own texture coordinates: 0 ... 1 over the sides of an AREA and over the disk of a SUN, longitude and
 * latitude of a POINT, and the plane on which the cone of a SPOT covers 0 ... 1. Light Path is that of a light sample. */
typedef struct lancer_light {
  const char *name;
  const lancer_node *nodes;
  uint32_t node_count;
  lancer_parameter strength; /* [vector 1] factor of emission, of a light that has nodes */
  double matrix[12];
  uint32_t kind;         /* LANCER_POINT ... */
  float emission[3];     /* POINT, SPOT: radiant intensity, W/sr. SUN: irradiance at normal incidence, W/m^2. AREA: radiance.
                            Negative: takes light away */
  float radius;          /* POINT, SPOT: 0 is a true point */
  uint32_t soft_falloff; /* POINT, SPOT with radius: 1 = a disk that always faces the shaded point (E = I/(d^2 + r^2)); 0 = a
                            ball */
  float spot_angle;      /* SPOT: full angle of the cone */
  float spot_blend;      /* SPOT: 0 hard edge ... 1 all of the cone softened */
  uint32_t spot_cosine;  /* SPOT: 1 = intensity also falls with the cosine of the angle to the axis, as before Blender 4.0 */
  float sun_angle;       /* SUN: full angle of the disk in the sky; 0 is exactly parallel light */
  uint32_t sun_flat; /* SUN: 1 = radiance grows to the rim as 1 / cos^3, as of a flat disk, before Blender 4.0; 0 = uniform */
  float size[2];     /* AREA: full lengths along local x and y. SPOT: factors that widen the cone along them; 1, 1 (and 0,
                        0): round */
  uint32_t shape;    /* AREA: LANCER_RECTANGLE or LANCER_ELLIPSE */
  float spread;      /* AREA: full angle of emission, pi = the whole front hemisphere */
  uint32_t hidden_from;   /* LANCER_RAY_* bits; SHADOW has no effect */
  uint32_t no_shadow;     /* 1: casts no shadows */
  uint32_t light_group;   /* 1 ... settings.light_groups; 0 = none */
  uint32_t falloff;       /* CLASSIC: LANCER_FALLOFF_* */
  float falloff_radius;   /* CLASSIC: r of lancer_falloff */
  float ambient_color[3]; /* CLASSIC: factors of emission for the ambient, diffuse and specular sums; 1, 1, 1 = one colour */
  float diffuse_color[3];
  float specular_color[3];
  uint32_t lit_surfaces; /* PATH: light samples on the first surfaces of a path alone, so many of them; 0 = on all */
  uint32_t no_catchers;  /* 1: none of its light is that of shadow catchers alone, see lancer_settings.catchers */
  uint32_t opening; /* AREA: 1 = it gives no light: half of PATH's light samples of the world go through such openings, to points
                       on the side to which they face. It changes the noise, not the picture */
  uint64_t unlit_sets;   /* light linking: bits of the sets of receivers that its light does not reach */
  uint64_t clear_sets;   /* bits of the sets of blockers that its light passes */
} lancer_light;

/* ---- scene: create, fill, commit, destroy ------------------------------------------------------------------------ */

LANCER_API lancer_status lancer_scene_create(lancer_scene *scene);
/* Stops a running commit and frees the scene. Sessions made from the scene stay valid: each keeps its data until it is
 * destroyed. */
LANCER_API lancer_status lancer_scene_destroy(lancer_scene scene);

/* Meshes and materials are numbered 0, 1, 2 ... in order of adding. Faces that are non-finite or have no area are left out
 * and reported by lancer_scene_messages; an index out of range is an error and adds nothing. */
LANCER_API lancer_status lancer_scene_add_mesh(lancer_scene scene, const lancer_mesh *mesh);
LANCER_API lancer_status lancer_scene_add_material(lancer_scene scene, const lancer_material *material);
LANCER_API lancer_status lancer_scene_add_light(lancer_scene scene, const lancer_light *light);
/* Adds count instances at once. slots: material numbers [slot_count]; names: NUL-terminated UTF-8 strings, names_size bytes
 * in total. Instances whose matrix is not finite or not invertible are left out and reported. May be called repeatedly. */
LANCER_API lancer_status lancer_scene_add_instances(lancer_scene scene, uint32_t count, const lancer_instance *instances,
                                                    uint32_t slot_count, const uint32_t *slots, const char *names,
                                                    size_t names_size);
/* Sets the data of OBJECT_INFO nodes: infos[count][5] holds colour, alpha and the random number of the first count instances
 * in order of adding, including those left out. All other instances are white with random number 0. */
LANCER_API lancer_status lancer_scene_set_object_infos(lancer_scene scene, uint32_t count, const float *infos);
/* Adds an attribute of objects that OBJECT_INFO nodes read by its name, UTF-8: values[count][4] of the first count instances in
 * order of adding, including those left out. All other instances have 0. A name may be added once. */
LANCER_API lancer_status lancer_scene_add_object_attribute(lancer_scene scene, const char *name, uint32_t count,
                                                           const float *values);
/* Lets instances move: matrices[count][key_count][12] are their placements at the keys of lancer_motion, in place of the matrix
 * that they were added with; instances[count]: their numbers in order of adding. An instance with a key that is not finite or
 * not invertible stands still, with a message. An instance may be given once. */
LANCER_API lancer_status lancer_scene_move_instances(lancer_scene scene, uint32_t count, const uint32_t *instances,
                                                     uint32_t key_count, const double *matrices);
/* Tells the pass VECTOR where instances are one frame before the picture and one after: matrices[count][2][12];
 * instances[count]: their numbers in order of adding. Other instances stand still. No ray is traced at these places. An
 * instance with a matrix that is not finite stands still, with a message. An instance may be given once. */
LANCER_API lancer_status lancer_scene_set_vectors(lancer_scene scene, uint32_t count, const uint32_t *instances,
                                                  const double *matrices);
/* Images are numbered 0, 1, 2 ... in order of adding. */
LANCER_API lancer_status lancer_scene_add_image(lancer_scene scene, const lancer_image *image);

/* The environment's radiance, as a value or as nodes. In the nodes every coordinate is the unit direction (GENERATED,
 * OBJECT, POSITION) or its opposite, as on a surface that faces the viewer (normals, INCOMING, REFLECTION). */
typedef struct lancer_world {
  const lancer_node *nodes;
  const lancer_output *outputs;
  uint32_t node_count;
  uint32_t hidden_from;      /* LANCER_RAY_* bits */
  lancer_parameter radiance; /* [color 0] may be negative */
  float ambient[3];          /* CLASSIC: uniform light from everywhere that Ka reflects once, independent of the lamps; see
                                use_ambient */
  uint32_t use_ambient;      /* 0: use the mean of the radiance instead of ambient */
  uint32_t map_resolution;   /* width of the map that samples directions where the radiance varies; 0 = by its images, 1024
                                without any. At most 65536, but no map is wider than 2048: finer detail is averaged from up to
                                8192 x 4096 evaluations */
  uint32_t light_group;      /* 1 ... settings.light_groups; 0 = none */
  uint32_t output_count;     /* at most LANCER_MOST_NODES */
  uint32_t lit_surfaces;     /* as of a light */
} lancer_world;
/* The world is black until set. */
LANCER_API lancer_status lancer_scene_set_world(lancer_scene scene, const lancer_world *world);

/* ---- objects: parts of scenes that many scenes share, and scenes that differ little -------------------------------- */

/* An object is a checked copy of one record that never changes: a mesh, an image, a material, a light or a world. Any number of
 * scenes share it, with all that their commits make of it, such as a mesh's tree. The caller owns the handle; the object lives
 * until its handle is destroyed and no scene, session or other object needs it. */
typedef uint64_t lancer_object;
enum lancer_object_kind {
  LANCER_OBJECT_IMAGE = 0,
  LANCER_OBJECT_MESH = 1,
  LANCER_OBJECT_MATERIAL = 2,
  LANCER_OBJECT_LIGHT = 3,
  LANCER_OBJECT_WORLD = 4
};
/* number: names an object without a name in messages. */
LANCER_API lancer_status lancer_object_create_image(const lancer_image *image, uint32_t number, lancer_object *object);
LANCER_API lancer_status lancer_object_create_mesh(const lancer_mesh *mesh, uint32_t number, lancer_object *object);
/* images[image_count]: the images that nodes name by number; the object keeps those that its nodes read. */
LANCER_API lancer_status lancer_object_create_material(const lancer_material *material, uint32_t number, uint32_t image_count,
                                                       const lancer_object *images, lancer_object *object);
LANCER_API lancer_status lancer_object_create_light(const lancer_light *light, uint32_t number, uint32_t image_count,
                                                    const lancer_object *images, lancer_object *object);
LANCER_API lancer_status lancer_object_create_world(const lancer_world *world, uint32_t image_count,
                                                    const lancer_object *images, lancer_object *object);
LANCER_API lancer_status lancer_object_destroy(lancer_object object);
/* Begins, in a thread of the library, with the work that a commit would do for this object alone: the tree of a mesh. So it
 * goes on while the caller still reads others. It is left out if nobody has the object any more when its turn comes.
 * threads: as of lancer_scene_commit. */
LANCER_API lancer_status lancer_object_prepare(lancer_object object, uint32_t threads);

/* Creates a scene that begins with all that a committed scene has, for changes. Its commit makes only the parts that differ and
 * shares all others, and its pictures have the bits of a scene that is filled anew. before may be destroyed at once. */
LANCER_API lancer_status lancer_scene_edit(lancer_scene before, lancer_scene *scene);
/* Replaces all objects of a kind, which are numbered 0, 1, 2 ... in this order. One world, or none: black. */
LANCER_API lancer_status lancer_scene_set_objects(lancer_scene scene, uint32_t kind, uint32_t count,
                                                  const lancer_object *objects);
/* Removes all instances with their infos, attributes and motions. */
LANCER_API lancer_status lancer_scene_clear_instances(lancer_scene scene);

enum lancer_accelerator { LANCER_BVH = 0, LANCER_KDTREE = 1, LANCER_BRUTE_FORCE = 2 };
/* Starts the commit on threads threads (0 = one per processor): checks, normalises, finds features, builds the accelerator. An
 * instance that refers to a mesh or a material that is not there is an error.
 * Can be called once. */
LANCER_API lancer_status lancer_scene_commit(lancer_scene scene, uint32_t accelerator, uint32_t threads);
/* Waits at most this time. LANCER_OK: committed, ready for sessions. */
LANCER_API lancer_status lancer_scene_wait(lancer_scene scene, uint32_t milliseconds);
LANCER_API lancer_status lancer_scene_cancel(lancer_scene scene);
/* Lists everything left out or replaced by fill calls and commit, one line each, "object: text" (UTF-8, NUL-terminated).
 * Writes at most size bytes; *needed (may be NULL) receives the full size with the NUL. */
LANCER_API lancer_status lancer_scene_messages(lancer_scene scene, char *text, size_t size, size_t *needed);

/* Names the scene in parts of pictures: a hash of its description, e.g. SHA-256, which the caller computes. Copied by the
 * sessions that are created afterwards. Allowed before and after the commit. */
LANCER_API lancer_status lancer_scene_set_digest(lancer_scene scene, const uint8_t digest[32]);

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
  uint32_t region_width, region_height; /* size of that region */
  uint32_t aperture_blades;             /* below 3: a round aperture */
  double window[4];            /* left, right, bottom, top of the full image: on the plane z = -1 (PERSPECTIVE), at any depth
                                  (ORTHOGRAPHIC); panoramas: in units where 0 ... 1 is the whole panorama */
  double panorama[8];          /* parameters of the kind, see lancer_camera_kind; angles in radians */
  double clip_start, clip_end; /* along z; panoramas: along the ray */
  double lens_radius;          /* thin lens: aperture radius; 0 = no depth of field */
  double focal_distance;       /* along z, > 0 where lens_radius > 0; panoramas: along the ray */
  double aperture_rotation;    /* of the blades, radians */
  double aperture_ratio;       /* height of the bokeh over its width; 1 = round */
  /* Spherical stereo, of panoramas and PERSPECTIVE: the eye is to the right of each ray by eye_offset, about the camera's y
   * axis, or the world's z axis if PERSPECTIVE; 0 = off. Both eyes' rays meet at convergence_distance; 0 = they are parallel.
   * From pole_merge_from to pole_merge_to above or below the horizon the offset fades to 0; pole_merge_to of 0 = it does not.
   */
  double eye_offset, convergence_distance, pole_merge_from, pole_merge_to;
  /* For the pass VECTOR: matrix and window one frame before and one after; a matrix of zeros: those of the picture. */
  double matrix_before[12], matrix_after[12];
  double window_before[4], window_after[4];
} lancer_camera;

/* Motion while the shutter is open. Time runs from 0, where it opens, to 1, where it closes. Things that move are given at
 * keys, at equal steps of time from 0 to 1; a number of keys is 3, 5, 9 ... 129. Between two keys vertices move along straight
 * lines; of a placement, translation and stretch change linearly, and the rotation turns by the shortest way at constant speed.
 */
typedef struct lancer_motion {
  const float *shutter;      /* [shutter_count] how far the shutter is open, at equal steps of time from 0 to 1: samples choose
                                their times in proportion. Not negative; NULL: all samples are of the time 0.5 */
  uint32_t shutter_count;    /* 0, or at least 2 */
  uint32_t key_count;        /* of the camera; 0: it stands still */
  const lancer_camera *keys; /* [key_count] the camera of a session at the keys: matrix, window, panorama, lens_radius and
                                focal_distance are read. Its place in the picture is the session's */
  uint32_t rolling;          /* 1: rows are exposed from the top of the picture to its bottom, as by a rolling shutter */
  uint32_t reserved;
  double rolling_duration; /* share of the shutter's time for which each row is exposed, 0 ... 1 */
} lancer_motion;
/* Sets the motion of a scene. A scene without it shows the time 0.5. */
LANCER_API lancer_status lancer_scene_set_motion(lancer_scene scene, const lancer_motion *motion);

enum lancer_integrator { LANCER_PATH = 0, LANCER_CLASSIC = 1, LANCER_NORMALS = 2 };
enum lancer_pixel_filter { LANCER_FILTER_BOX = 0, LANCER_FILTER_BLACKMAN_HARRIS = 1 };
enum lancer_features { LANCER_FEATURES_SCENE = 0, LANCER_FEATURES_ALL = 1 };

/* Passes of the film, which keeps those whose bit (1u << pass) is set in lancer_settings.passes. Channels in brackets;
 * "mean": over samples; "sample 0": of the first sample, unfiltered. A component's direct and indirect light are divided by its
 * colour (a channel without colour uses the mean of the others that have some), so that
 *   COMBINED = DIFFUSE_COLOR (DIFFUSE_DIRECT + DIFFUSE_INDIRECT) + GLOSSY_... + TRANSMISSION_... + EMISSION + ENVIRONMENT.
 * PATH fills the light passes; CLASSIC and NORMALS leave them 0. */
enum lancer_pass {
  LANCER_PASS_COMBINED = 0,               /* [4] premultiplied */
  LANCER_PASS_DEPTH = 1,                  /* [1] along the camera's z (panoramas: distance); 1e10 if nothing is hit. Sample 0 */
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
  LANCER_PASS_ERROR = 23, /* [1] standard error of the mean luminance; infinity below two samples per pixel. Always kept */
  /* Half the difference of two pictures, each of one half of the samples: it has the variance of the pass, and is independent
   * of the noise of the pass. 0 below two samples per pixel. */
  LANCER_PASS_HALVES = 24,        /* [3] of COMBINED */
  LANCER_PASS_ALBEDO_HALVES = 25, /* [3] */
  LANCER_PASS_NORMAL_HALVES = 26, /* [3] of DENOISING_NORMAL */
  /* For denoising by others, of the first surface, by the rule of Blender 5.2. */
  LANCER_PASS_SPECULAR_ALBEDO = 27, /* [3] albedo of its lobes by their mirror-like share, mean */
  LANCER_PASS_ROUGHNESS = 28,       /* [1] of its lobes, as of shader nodes, mean */
  /* Motion of the first surface in the picture, in pixels to the right and up: its place one frame before less its place, and
   * its place less that one frame after; the mean of the samples that see a surface, 0 without any. See
   * lancer_scene_set_vectors. */
  LANCER_PASS_VECTOR = 29, /* [4] */
  LANCER_PASS_COUNT = 30
};

/* Passes without a bit in lancer_settings.passes: the number of such a pass is its kind times LANCER_PASS_SPAN plus its number
 * within the kind. Light passes by groups are those of PATH; the other integrators leave them 0. */
enum lancer_pass_kind {
  LANCER_PASS_KIND_PLAIN = 0, /* those of lancer_pass */
  /* The mattes of a pixel, by falling share; number n holds the id and the share of the matte 2 n, then of 2 n + 1; 0, 0: none.
   * An id is given as the float that has its bits. A surface's share is its opacity times the light that passes to the camera.
   */
  LANCER_PASS_KIND_OBJECT_MATTES = 1,   /* [4] kept if settings.mattes has the bit 1 */
  LANCER_PASS_KIND_MATERIAL_MATTES = 2, /* [4] bit 2 */
  LANCER_PASS_KIND_ASSET_MATTES = 3,    /* [4] bit 4 */
  LANCER_PASS_KIND_LIGHT_GROUP = 4,     /* [3] light of the group number + 1, as in COMBINED; behind a transparent film also the
                                           world's own, if ENVIRONMENT is kept */
  LANCER_PASS_KIND_AOV_COLOR = 5,       /* [4] see lancer_output; the fourth counts the surfaces that gave a value */
  LANCER_PASS_KIND_AOV_VALUE = 6,       /* [1] */
  LANCER_PASS_KIND_SAMPLES = 7,         /* [1] samples of the pixel. Always kept */
  LANCER_PASS_KIND_RENDER_TIME = 8,     /* [1] milliseconds of this session for the pixel: an equal share of its tile's. Always
                                           kept */
  /* Kept if settings.catchers is not OBJECTS. The factor is the light of the shadow catchers that the camera sees, divided by
   * their light without all other objects, and blended with 1 by the picture's alpha. The matte is the picture without them. */
  LANCER_PASS_KIND_SHADOW_CATCHER = 9, /* [3] 1 where there are none */
  LANCER_PASS_KIND_CATCHER_MATTE = 10  /* [4] premultiplied */
};

/* Shadow catchers in the picture. OBJECTS: as any other object. APART: COMBINED is CATCHER_MATTE, beside the pass
 * SHADOW_CATCHER. SHADOWS: COMBINED is CATCHER_MATTE over a black of the alpha 1 - mean(SHADOW_CATCHER), over the environment
 * where the film is not transparent; ENVIRONMENT is kept, and also shows the world behind shadow catchers. Error and halves are
 * always those of the picture with its shadow catchers as objects. */
enum lancer_catchers { LANCER_CATCHERS_OBJECTS = 0, LANCER_CATCHERS_APART = 1, LANCER_CATCHERS_SHADOWS = 2 };

/* How a scene is rendered. Each comment begins with kind, default and, where there is one, the largest value: a choice of an
 * enum; a number; an amount, finite and not negative; a width, finite and positive; a switch, 0 or 1; bits. */
typedef struct lancer_settings {
  uint32_t integrator;      /* [choice 0 2] LANCER_PATH ... */
  uint32_t samples;         /* [number 256] planned per pixel; CLASSIC with 1 uses the centre of pixel, lens and light */
  uint32_t seed;            /* [number 0] */
  uint32_t max_bounces;     /* [number 12 1024] PATH: scattering events after the first; CLASSIC: recursion depth, at most
                               LANCER_DEEPEST_RECURSION */
  uint32_t diffuse_bounces; /* [number 1024 1024] PATH: as max_bounces, of scattering events by kind: diffuse reflections, */
  uint32_t glossy_bounces;  /* [number 1024 1024] other reflections, */
  uint32_t transmission_bounces; /* [number 1024 1024] and transmissions. 255 and more are no limit */
  float contribution_threshold;  /* [amount 0] CLASSIC: a ray is traced only if its throughput exceeds this in some channel */
  float clamp_indirect;          /* [amount 0] PATH: largest channel of a sample's indirect light; 0 = off */
  float clamp_direct;        /* [amount 0] PATH: largest mean of the channels of each light sample, and of each light that a ray
                                runs into, that was scattered at most once; 0 = off */
  uint32_t no_reflections;   /* [switch 0] PATH: rays from diffuse lobes meet no lobes that mirror, */
  uint32_t no_refractions;   /* [switch 0] and none that refract: no caustics */
  float filter_glossy;       /* [amount 0] PATH: after scatterings of a density p below this, glossy lobes have at least the
                                alpha sqrt(1 - p / filter_glossy) / 2 */
  float exposure;            /* [amount 1] factor of all light in the film */
  uint32_t fast_bounces;     /* [number 0 1024] PATH: a path with more scatterings than this less 1, not counting transmissions
                                and one glossy reflection, ends at the first surface within fast_distance, or sees the
                                environment times fast_factor; 0 = off */
  float fast_factor;         /* [amount 1] */
  float fast_distance;       /* [amount 0] 0 = unlimited */
  float ambient;             /* [amount 0] PATH: white light from everywhere that diffuse lobes reflect where nothing within
                                fast_distance hides them; in the picture alone, not in passes of its parts */
  uint32_t split_lights;     /* [number 1 16] PATH: number of lights sampled per sample at its first surface with a lobe
                                that is not a single direction. 0, as split_paths: chosen by rendering a few pixels before
                                the first sample, if at least 16 samples are planned */
  uint32_t split_paths;      /* [number 1 16] PATH: number of branches that continue from that surface */
  uint32_t pixel_filter;     /* [choice 0 1] LANCER_FILTER_* */
  float filter_width;        /* [width 1] full width in pixels */
  uint32_t film_transparent; /* [switch 0] the environment has alpha 0 */
  uint32_t transparent_glass;   /* [switch 0] the environment has alpha 0 also through glass of at most glass_roughness */
  float glass_roughness;        /* [amount 0] alpha */
  uint32_t transparent_bounces; /* [number 8 1024] surfaces that a ray may pass straight through; the next one contributes only
                                   its emission */
  uint32_t transparent_shadows; /* [number 8 1024] surfaces that a shadow ray may pass, PATH: including those that its
                                   path has passed before */
  float alpha_threshold;        /* [amount 0.5] NORMAL, UV, DEPTH, POSITION and the indices are of the first surface with at
                                   least this opacity */
  uint32_t environment_reflections; /* [switch 0] CLASSIC: a reflected or refracted ray returns the environment's colour without
                                       being traced */
  float occlusion_distance;         /* [amount 0] AMBIENT_OCCLUSION: largest distance of an occluder; 0 = unlimited */
  float mist_start;                 /* [amount 5] MIST: distance from the camera */
  float mist_depth;                 /* [amount 25] MIST: distance from mist_start */
  float mist_falloff;               /* [amount 2] MIST: the exponent */
  uint32_t blended_features; /* [switch 0] ALBEDO, DENOISING_*: 0 = from one surface, as in Blender up to 5.1; 1 = blended
                                over surfaces by their share of matt lobes, as in 5.2 */
  uint32_t sky_vectors;      /* [switch 0] VECTOR: 1 = also of samples that see no surface, as in Blender 5.2, where places of
                                directions are multiplied by their depth along the camera's z */
  uint32_t even_choices;     /* [switch 0] PATH: 1 = at the first surface of a path, the way straight on and each lobe are at
                                least an eighth of the choices, as in Blender up to 3.6: AOV_* of surfaces behind it count
                                the paths that pass */
  uint32_t features;         /* [choice 0 1] LANCER_FEATURES_SCENE: only the work that the scene requires; ALL: work for all
                                features. Same pixels */
  uint32_t passes;           /* [bits 1 1073741823] 1u << LANCER_PASS_*; COMBINED is always kept */
  uint32_t mattes;           /* [bits 0 7] kinds of mattes: 1 objects, 2 materials, 4 assets */
  uint32_t light_groups;     /* [number 0 1024] number of groups of lights, each with a pass */
  uint32_t aov_colors;       /* [number 0 1024] number of passes AOV_COLOR */
  uint32_t aov_values;       /* [number 0 1024] number of passes AOV_VALUE */
  uint32_t catchers;         /* [choice 0 2] PATH: LANCER_CATCHERS_* */
  uint32_t threads;          /* [number 0 1024] 0 = one per processor */
  uint32_t tile_size;        /* [number 0] pixels; 0 = automatic. Changes no pixel */
  uint32_t refines;          /* [switch 0] the session refines, or renders or joins parts of a picture */
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
  uint64_t camera_rays, bounce_rays, shadow_rays; /* traced rays; pixels with nothing but an even background trace none */
  uint64_t invalid_samples;                       /* non-finite samples in the film's range that were dropped */
  uint32_t invalid_x, invalid_y, invalid_sample;  /* the first invalid sample, by sample, then row, for lancer_debug_sample */
  uint32_t threads;
  uint64_t triangles, instances, lights;
  uint64_t geometry_bytes, accelerator_bytes, film_bytes;
  char features[512];                 /* features of the scene, separated by blanks */
  char kernel[64];                    /* the integrator that ran */
  char instruction_set[32];           /* e.g. "AVX2" */
  uint64_t texture_bytes;             /* copied images; geometry_bytes covers meshes, instances and lights */
  uint64_t mapped_bytes;              /* images that the library reads in place */
  uint64_t vertices;                  /* of rays on surfaces, without layers that a cut-out removes */
  uint32_t split_lights, split_paths; /* the numbers in use; 0 until they are found */
} lancer_statistics;

/* Checks camera and settings and allocates the film. Fails unless the scene is committed. */
LANCER_API lancer_status lancer_session_create(lancer_scene scene, const lancer_camera *camera, const lancer_settings *settings,
                                               lancer_session *session);
/* From where a bake looks at its surface. */
enum lancer_bake_view {
  LANCER_BAKE_ABOVE = 0,  /* along the normal */
  LANCER_BAKE_CAMERA = 1, /* from the camera; faces that look away from the camera are turned towards it, as in Cycles */
  LANCER_BAKE_SKY = 2     /* not at the surface: from the world's origin to the place, at the environment */
};

/* Lobes that the baked surface lacks at first sight, bits; seen by rays it has them. As in Cycles, glass is left out where
 * GLOSSY and TRANSMISSION are, and light that enters the surface never. */
enum lancer_bake_lacks { LANCER_BAKE_LACKS_DIFFUSE = 1, LANCER_BAKE_LACKS_GLOSSY = 2, LANCER_BAKE_LACKS_TRANSMISSION = 4 };

/* A texel of an image that shows the surface of a mesh. */
typedef struct lancer_texel {
  uint32_t triangle; /* number of a triangle of the mesh; one that the mesh lacks: the texel is empty, and black with alpha 0 */
  float weights[2];  /* barycentric weights of the triangle's corners 0 and 1 in the middle of the texel */
  float dx[2];       /* their change over the texel along a row, */
  float dy[2];       /* and along a column */
} lancer_texel;

/* The picture of a surface in texels, in place of the camera's view. */
typedef struct lancer_bake {
  const lancer_texel *texels; /* [texel_count], by row from the bottom */
  uint32_t texel_count;       /* the camera's width times its height */
  uint32_t instance;          /* its number in order of adding; a mesh. All texels of one that was left out are empty */
  uint32_t view;              /* LANCER_BAKE_* */
  uint32_t lacks;             /* LANCER_BAKE_LACKS_*, added */
  float bare_roughness;       /* 0 ... 1: ROUGHNESS where no lobe counts; 1 since Blender 4.2 */
  uint32_t reserved;
} lancer_bake;
/* As lancer_session_create, for a session whose samples begin on a surface: its passes are those of a picture whose pixels see
 * their texels. PATH only. Each sample takes a random place of its texel on its triangle. Of the camera, its size counts, its
 * place for LANCER_BAKE_CAMERA, and all of it for nodes that read the camera. Such a session has no parts. */
LANCER_API lancer_status lancer_session_create_bake(lancer_scene scene, const lancer_camera *camera,
                                                    const lancer_settings *settings, const lancer_bake *bake,
                                                    lancer_session *session);
LANCER_API lancer_status lancer_session_destroy(lancer_session session);
/* Starts the samples first ... first + count - 1 of every pixel. first must be the end of the range rendered before (0 at
 * the start). The bits do not depend on how a range is split, the number of threads or the tile size. Memory does: ranges
 * shorter than an eighth of the samples before them need more of it than lancer_session_create checks. */
LANCER_API lancer_status lancer_session_render(lancer_session session, uint32_t first, uint32_t count);
/* Waits at most this time. LANCER_OK: the range is done. progress may be NULL. */
LANCER_API lancer_status lancer_session_wait(lancer_session session, uint32_t milliseconds, lancer_progress *progress);
/* Cancels the running range; *_wait then returns LANCER_CANCELLED. The film keeps the samples of each pixel. */
LANCER_API lancer_status lancer_session_cancel(lancer_session session);
/* Stops the running range; *_wait then returns LANCER_OK. The film keeps the largest power of two of each pixel's samples,
 * and the session can continue: by lancer_session_render if all pixels have the same number, otherwise by
 * lancer_session_refine. */
LANCER_API lancer_status lancer_session_stop(lancer_session session);
/* Starts a round that doubles the samples of the pixels with the largest reduction of error per cost. It doubles as many pixels
 * as bring the bound on the error (high + cannot_exclude at that confidence) below target, or all pixels if target is 0, but
 * none beyond settings.samples. target is finite and not negative. A pixel is chosen by the samples of other pixels, which
 * avoids most of the bias that a choice by its own samples would cause. Returns LANCER_OK when the round has started
 * (lancer_session_wait waits for it) and LANCER_CANCELLED when nothing is left to double. Needs settings.refines, and a power
 * of two as the number of samples of every pixel. */
LANCER_API lancer_status lancer_session_refine(lancer_session session, double target, double confidence);
/* Copies one pass of the region: [region_height][region_width][channels]; float_count must be exactly that. pass: of
 * lancer_pass, or as lancer_pass_kind says. Allowed while rendering. */
LANCER_API lancer_status lancer_session_read(lancer_session session, uint32_t pass, float *out, size_t float_count);
LANCER_API lancer_status lancer_session_statistics(lancer_session session, lancer_statistics *statistics);

/* The distance of the picture from the converged one: the root mean square over pixels of the standard error of their
 * luminance, each relative to the pixel's luminance plus 1 % of the picture's mean. Luminance is that of ITU-R BT.709. */
typedef struct lancer_error {
  double error;           /* infinity until every pixel has two samples; low, high and cannot_exclude likewise */
  double low, high;       /* confidence interval of the error at the given confidence */
  double cannot_exclude;  /* bound at 95 % on the error from flashes that no sample has hit: the rule of three */
  double clipped;         /* share of the picture's light removed by clamp_indirect */
  double clipped_direct;  /* the same of clamp_direct */
  double cut;             /* estimated share of the light beyond the limits of kinds of bounces and of lamps */
  double no_caustics;     /* estimated share of the caustics that no_reflections and no_refractions leave out */
  /* Estimated shares of the light that a setting takes away, negative where it adds light, and half of their 95 % intervals. */
  double filtered, filtered_error; /* filter_glossy */
  double guessed, guessed_error;   /* fast_bounces and ambient */
  double missing;         /* PATH: estimated share of light beyond max_bounces, extrapolated from the last bounces; else 0 */
  double planned_samples; /* total pixel samples planned by the last lancer_session_refine */
  uint32_t least_samples, most_samples; /* per pixel */
} lancer_error;
/* Returns the error of the film's current state at a confidence in (0, 1). Allowed while rendering. */
LANCER_API lancer_status lancer_session_error(lancer_session session, double confidence, lancer_error *error);

/* The error of a denoised picture, in the unit of lancer_error. */
typedef struct lancer_denoised_error {
  double error;     /* of the result */
  double low, high; /* confidence interval of the error at the given confidence */
  double moved; /* light that denoising alone has moved: root mean square of the difference of means of 16 x 16 pixels between
                   the denoised and the noisy picture, beyond noise */
} lancer_denoised_error;
/* Combines a picture with two denoised versions of it, and estimates the error of the result. All pictures are
 * [height][width][3], linear, finite. noisy: the pass COMBINED without alpha; noise: the pass HALVES, from at least two
 * samples; errors: the pass ERROR, which tells small lights from bright pixels that are errors; may be NULL.
 * first, second: a denoiser's results for noisy + step noise and noisy - step noise, with step in (0, 1]. combines: 1
 * = the result is the combination with the least estimated error, which converges with the samples; 0 = the mean of first and
 * second. picture: receives the result, and may be one of the inputs. bars: receives the standard error of the mean luminance
 * of each block, [(height + block - 1) / block][(width + block - 1) / block]; block: side in pixels, 1 = of each pixel. */
LANCER_API lancer_status lancer_combine_denoised(uint32_t width, uint32_t height, const float *noisy, const float *noise,
                                                 const float *errors, const float *first, const float *second, double step,
                                                 uint32_t combines, double confidence, uint32_t block, float *picture,
                                                 float *bars, lancer_denoised_error *error);
/* Composes COMBINED of LANCER_CATCHERS_SHADOWS from its parts, such as denoised ones, of count pixels: matte[count][4], the
 * pass CATCHER_MATTE; catcher[count][3], SHADOW_CATCHER; environment[count][3], ENVIRONMENT, or NULL for a transparent film.
 * picture[count][4] may be matte. */
LANCER_API lancer_status lancer_compose_catchers(uint64_t count, const float *matte, const float *catcher,
                                                 const float *environment, float *picture);

/* ---- parts of a picture ------------------------------------------------------------------------------------------
 *
 * Several sessions, also on several machines, render one picture: each renders some samples of some tiles and exports their
 * sums as a part. Joined in any order, all parts give the bits of one session that has rendered all samples. The sessions need
 * settings.refines, a digest of the scene, and the same scene, camera and settings, but for samples, features, threads and
 * tile_size. The numbers of lights and paths of a sample are found once, by lancer_session_decide, and given to all sessions
 * in settings.split_lights and split_paths.
 *
 * A tile is half of a square of 16 x 16 pixels. Squares lie side by side in rows, from the lower left corner of the region;
 * those at its right and upper edge are cut off. Square i has the tiles 2 i, its pixels (x, y) with even x + y, and 2 i + 1,
 * those with odd x + y, with x and y counted from the corner of the region. Pixels of a tile are in the order of rows.
 *
 * A part is a string of bytes without padding. Numbers are little-endian; f32 and f64 are those of IEEE 754; pixels are in the
 * order of their tile.
 *   char[8] "LANCERPT", u32 format (2), u32 LANCER_ABI_VERSION, u64 size of the part in bytes
 *   lancer_part
 *   u64[4] camera rays, bounce rays, shadow rays, vertices
 *   i64[10][32] luminance that clamp_indirect, clamp_direct, limits of bounces and the lack of caustics have removed, that of
 *     the last bounce and the one before, that which filter_glossy takes away and the sum of its squares over samples, and the
 *     same of Fast GI: digits of base 256, the lowest one in units of 2^-150
 *   for each tile, by rising number:
 *     u32 tile, u32 n, u32 d, u32 m (1 if the tile has sample 0, else 0)
 *     n times u32 start, u32 level: sums of the samples start ... start + 2^level - 1, by rising start, a multiple of 2^level
 *     n times f64[pixels][channels] sums of the summed passes in order of pass, as film_passes.cpp lists them, VECTOR followed
 *       by the number of samples that have one, then of light groups, AOV_COLOR and AOV_VALUE; f32[pixels] difference of the
 *       mean luminances of both halves (0 if level is 0); f32[pixels][halves] the same of each colour that passes of halves
 *       tell, three numbers for each such pass, in order of pass; for each kind of mattes u32[pixels] number of mattes up to
 *       the end of each pixel, then of all mattes u32 id, by rising id within a pixel, and f64 sum of shares
 *     f32[pixels] largest absolute luminance of a sample
 *     m times f32[pixels][channels] values of sample 0
 *     d times u64 number of dropped samples, by the bit width of the sample's number
 *     d > 0: u32[3] x, y, sample of the first dropped one
 *   u64 XXH64, with seed 0, of all bytes before */

/* Samples first ... first + count - 1 of all pixels of a tile. */
typedef struct lancer_range {
  uint32_t tile, first, count;
} lancer_range;

/* The picture that a part belongs to, and the samples that it holds. */
typedef struct lancer_part {
  uint8_t digest[32]; /* of the scene */
  char release[16];   /* lancer_version() of the library that has rendered the samples: another one may have other bits */
  uint64_t hash;      /* of digest, release, camera and the settings that must be equal: XXH64 */
  uint64_t samples;   /* pixel samples */
  lancer_camera camera;
  lancer_settings settings;           /* features, threads and tile_size are 0 */
  uint32_t split_lights, split_paths; /* the numbers in use, as in settings */
  uint64_t tiles;                     /* number of tiles with samples */
  uint32_t first, end;                /* the lowest number of a sample, and the highest plus 1 */
} lancer_part;

/* Writes the number of pixels of the first capacity tiles; *count receives the number of tiles. */
LANCER_API lancer_status lancer_session_tiles(lancer_session session, uint32_t capacity, uint32_t *pixels, uint32_t *count);
/* Starts to find the numbers of lights and paths of a sample, without rendering any; lancer_session_wait waits for them, and
 * lancer_session_statistics tells them. */
LANCER_API lancer_status lancer_session_decide(lancer_session session);
/* Writes the first capacity ranges of the round that lancer_session_refine would start, in order of gain; *count receives
 * their number, 0 if nothing is left to double. */
LANCER_API lancer_status lancer_session_plan(lancer_session session, double target, double confidence, uint32_t capacity,
                                             lancer_range *ranges, uint32_t *count);
/* Starts the given ranges, each of another tile. A tile's range starts anywhere if the tile has no samples, and continues it
 * otherwise. lancer_session_stop cancels it. */
LANCER_API lancer_status lancer_session_render_ranges(lancer_session session, uint32_t count, const lancer_range *ranges);
/* Forgets all samples, also after a cancelled range, and keeps the numbers of lights and paths. */
LANCER_API lancer_status lancer_session_clear(lancer_session session);
/* Writes all samples of the session as a part, if size is at least its size; *needed (may be NULL) receives its size. Fails
 * while rendering. */
LANCER_API lancer_status lancer_session_export(lancer_session session, void *part, size_t size, size_t *needed);
/* Checks a part and adds its samples. A part that is damaged, of another picture, or has samples that the session has already
 * is refused as a whole. Without any samples before, and with split_lights and split_paths of 0, the session takes over the
 * part's numbers. Fails while rendering. */
LANCER_API lancer_status lancer_session_import(lancer_session session, const void *part, size_t size);
/* Creates a session without a scene, which joins parts: it plans rounds, reads passes and errors, exports and imports, and
 * cannot render. digest: of the scene. */
LANCER_API lancer_status lancer_session_create_joiner(const uint8_t digest[32], const lancer_camera *camera,
                                                      const lancer_settings *settings, lancer_session *session);
/* Checks a part's size and checksum, and copies its description. */
LANCER_API lancer_status lancer_part_describe(const void *part, size_t size, lancer_part *description);

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

/* Replays sample s of pixel (x, y) of the region. rgba: the sample's contribution to the film (float[4]). vertices: receives
 * the first capacity vertices in order of visit (may be NULL with 0); *count receives their total number. */
LANCER_API lancer_status lancer_debug_sample(lancer_session session, uint32_t x, uint32_t y, uint32_t s, float *rgba,
                                             lancer_vertex *vertices, uint32_t capacity, uint32_t *count);

#ifdef __cplusplus
}
#endif
#endif
