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

#if defined(__GNUC__)
#define LANCER_API __attribute__((visibility("default")))
#else
#define LANCER_API
#endif

/* Changes whenever a struct or a call of this header does. */
#define LANCER_ABI_VERSION 1u

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
  LANCER_STRUCT_COUNT
} lancer_struct;
/* sizeof one of the structs below, by lancer_struct; 0 for an unknown number. Lets a caller refuse a stale library. */
LANCER_API uint32_t lancer_sizeof(uint32_t which);

/* ---- geometry --------------------------------------------------------------------------------------------------- */

enum { LANCER_NORMALS_NONE = 0, LANCER_NORMALS_VERTEX = 1, LANCER_NORMALS_CORNER = 2 };

/* A triangle mesh in object space, shared by any number of instances. */
typedef struct lancer_mesh {
  const char *name;               /* UTF-8, for messages */
  const float *positions;         /* [vertex_count][3] */
  const uint32_t *triangles;      /* [triangle_count][3], indices below vertex_count, counter-clockwise from outside */
  const float *normals;           /* NULL, [vertex_count][3] or [triangle_count][3][3], as normal_domain says */
  const float *uvs;               /* NULL or [triangle_count][3][2] */
  const float *colors;            /* NULL or [triangle_count][3][3], linear RGB */
  const uint16_t *material_slots; /* NULL (all slot 0) or [triangle_count] */
  uint32_t vertex_count;
  uint32_t triangle_count;
  uint32_t normal_domain; /* LANCER_NORMALS_* */
  uint32_t reserved;
} lancer_mesh;

/* Exact surfaces stand in their own unit frame; the instance's matrix places, scales and shears them:
 *   SPHERE    |p| = 1
 *   PLANE     z = 0, without end; the normal is +z
 *   CYLINDER  x^2 + y^2 = 1 for -1 <= z <= 1, closed by both disks
 *   CONE      apex (0, 0, 1), base disk of radius 1 at z = -1, closed by the disk */
enum { LANCER_MESH = 0, LANCER_SPHERE = 1, LANCER_PLANE = 2, LANCER_CYLINDER = 3, LANCER_CONE = 4 };

/* How normals are used. GOURAUD is an idea of CLASSIC (illumination at the vertices, interpolated); PATH takes it as PHONG. */
enum { LANCER_SHADING_AS_MESH = 0, LANCER_SHADING_FLAT = 1, LANCER_SHADING_GOURAUD = 2, LANCER_SHADING_PHONG = 3 };

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
  uint32_t reserved;
} lancer_instance;

/* ---- materials -------------------------------------------------------------------------------------------------- */

/* A value of a material. texture is -1 for a constant; else the number of a texture that replaces value. */
typedef struct lancer_parameter {
  float value[3]; /* scalars use value[0] */
  int32_t texture;
} lancer_parameter;

/* Lobes, summed. In the local frame n = +z; wo and wi point away from the surface. Value f, without the cosine.
 *   LAMBERT      color/pi, on both sides
 *   BECKMANN     color D F G / (4 (l.n)(v.n)): Beckmann D, exact dielectric Fresnel F of ior (infinite = 1), Smith G
 *                with Walter's rational G1; roughness is alpha itself. Below alpha 2e-5 a mirror weighted with F.
 *   MIRROR       color, in the mirrored direction only
 *   DIELECTRIC   smooth glass: color F reflected, color (1 - F) refracted, total internal reflection; ior is that of the
 *                inside, the side that the geometric normal points away from
 *   PHONG        color (n + 2)/(2 pi) max(0, R.V)^n in PATH; color max(0, R.V)^n per light / pi in CLASSIC; n = shininess
 *   BLINN_PHONG  color (n + 2)(n + 4)/(8 pi (2^(-n/2) + n)) max(0, N.H)^n in PATH; color max(0, N.H)^n / pi in CLASSIC */
enum {
  LANCER_LAMBERT = 0,
  LANCER_BECKMANN = 1,
  LANCER_MIRROR = 2,
  LANCER_DIELECTRIC = 3,
  LANCER_PHONG = 4,
  LANCER_BLINN_PHONG = 5
};

typedef struct lancer_lobe {
  uint32_t kind;              /* LANCER_LAMBERT ... */
  lancer_parameter color;     /* Kd or Ks */
  lancer_parameter roughness; /* alpha, BECKMANN */
  lancer_parameter ior;       /* relative to the outside, > 0, may be infinite; BECKMANN, DIELECTRIC */
  lancer_parameter shininess; /* the exponent n; PHONG, BLINN_PHONG */
} lancer_lobe;

typedef struct lancer_material {
  const char *name;
  const lancer_lobe *lobes;
  uint32_t lobe_count;       /* 0 is a black surface; at most 8 */
  uint32_t material_index;   /* value of the material index pass */
  lancer_parameter emission; /* radiance, both sides */
  lancer_parameter opacity;  /* 1 solid ... 0 not there; the rest of the light passes straight on */
  lancer_parameter ambient;  /* Ka, CLASSIC only */
} lancer_material;

/* ---- lights ----------------------------------------------------------------------------------------------------- */

enum { LANCER_POINT = 0, LANCER_SPOT = 1, LANCER_SUN = 2, LANCER_AREA = 3 };
enum { LANCER_RECTANGLE = 0, LANCER_ELLIPSE = 1 };
/* CLASSIC's attenuation over the distance d with the light's falloff_radius r:
 * PHYSICAL 1/d^2 | CONSTANT 1 | LINEAR max(0, 1-d/r) | QUADRATIC max(0, 1-d^2/r^2) | SMOOTH max(0, 1-d^2/r^2)^2 | GAUSSIAN
 * exp(-d^2/r^2) */
enum {
  LANCER_FALLOFF_PHYSICAL = 0,
  LANCER_FALLOFF_CONSTANT = 1,
  LANCER_FALLOFF_LINEAR = 2,
  LANCER_FALLOFF_QUADRATIC = 3,
  LANCER_FALLOFF_SMOOTH = 4,
  LANCER_FALLOFF_GAUSSIAN = 5
};

/* A light shines along its local -z. The matrix's linear part gives directions only (columns are normalised); sizes are
 * world lengths in the fields below. The camera does not see it; in PATH mirrors and glass do. */
typedef struct lancer_light {
  const char *name;
  double matrix[12];
  uint32_t kind;     /* LANCER_POINT ... */
  float emission[3]; /* POINT, SPOT: radiant intensity, W/sr. SUN: irradiance at normal incidence, W/m^2. AREA: radiance */
  float radius;      /* POINT, SPOT: 0 is a true point */
  uint32_t
      soft_falloff; /* POINT, SPOT with radius: 1 = a disk that always faces the shaded point (E = I/(d^2 + r^2)); 0 = a ball */
  float spot_angle; /* SPOT: full angle of the cone */
  float spot_blend; /* SPOT: 0 hard edge ... 1 all of the cone softened */
  uint32_t spot_cosine; /* SPOT: 1 = intensity also falls with the cosine of the angle to the axis, as in Blender before 4.0 */
  float sun_angle;      /* SUN: full angle of the disk in the sky; 0 is exactly parallel light */
  float size[2];        /* AREA: full lengths along local x and y */
  uint32_t shape;       /* AREA: LANCER_RECTANGLE or LANCER_ELLIPSE */
  float spread;         /* AREA: full angle of emission, pi = all of the front side */
  uint32_t falloff;     /* CLASSIC: LANCER_FALLOFF_* */
  float falloff_radius; /* CLASSIC: r above */
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
/* The constant environment's radiance; black until set. */
LANCER_API lancer_status lancer_scene_set_world(lancer_scene scene, const float radiance[3]);

enum { LANCER_BVH = 0, LANCER_KDTREE = 1, LANCER_BRUTE_FORCE = 2 };
/* Starts the build on threads threads (0 = all): checks, normalises, finds features, builds the accelerator. Once only. */
LANCER_API lancer_status lancer_scene_commit(lancer_scene scene, uint32_t accelerator, uint32_t threads);
/* Waits at most the given time. LANCER_OK: committed, ready for sessions. */
LANCER_API lancer_status lancer_scene_wait(lancer_scene scene, uint32_t milliseconds);
LANCER_API lancer_status lancer_scene_cancel(lancer_scene scene);
/* What was left out or replaced while filling and committing, one line each, "object: what" (UTF-8, NUL-terminated).
 * Writes at most size bytes; *needed (may be NULL) gets the full size with the NUL. */
LANCER_API lancer_status lancer_scene_messages(lancer_scene scene, char *text, size_t size, size_t *needed);

/* ---- session: camera, settings, film ----------------------------------------------------------------------------- */

enum { LANCER_PERSPECTIVE = 0, LANCER_ORTHOGRAPHIC = 1 };

/* The camera looks along its local -z, y up. */
typedef struct lancer_camera {
  double matrix[12];                    /* camera to world; must be rigid (rotation or mirrored rotation, translation) */
  uint32_t kind;                        /* LANCER_PERSPECTIVE, LANCER_ORTHOGRAPHIC */
  uint32_t width, height;               /* full image, pixels */
  uint32_t x, y;                        /* lower left pixel of the rendered region */
  uint32_t region_width, region_height; /* size of the rendered region */
  double window[4];            /* left, right, bottom, top of the full image: on the plane z = -1 (PERSPECTIVE), at any depth
                                  (ORTHOGRAPHIC) */
  double clip_start, clip_end; /* along z */
  double lens_radius;          /* thin lens: aperture radius; 0 = everything sharp */
  double focal_distance;       /* along z, > 0 where lens_radius > 0 */
} lancer_camera;

enum { LANCER_PATH = 0, LANCER_CLASSIC = 1, LANCER_NORMALS = 2 };
enum { LANCER_FILTER_BOX = 0, LANCER_FILTER_BLACKMAN_HARRIS = 1 };
enum { LANCER_FEATURES_SCENE = 0, LANCER_FEATURES_ALL = 1 };

/* Passes; the film keeps those whose bit (1u << pass) is in lancer_settings.passes. Channels in brackets. */
enum {
  LANCER_PASS_COMBINED = 0,       /* [4] premultiplied */
  LANCER_PASS_DEPTH = 1,          /* [1] distance along the camera's z; 1e10 where nothing is. Sample 0 */
  LANCER_PASS_NORMAL = 2,         /* [3] shading normal, world, mean over samples */
  LANCER_PASS_ALBEDO = 3,         /* [3] sum of the lobes' colours, mean over samples */
  LANCER_PASS_POSITION = 4,       /* [3] world. Sample 0 */
  LANCER_PASS_OBJECT_INDEX = 5,   /* [1] sample 0 */
  LANCER_PASS_MATERIAL_INDEX = 6, /* [1] sample 0 */
  LANCER_PASS_COUNT = 7
};

typedef struct lancer_settings {
  uint32_t integrator; /* LANCER_PATH ... */
  uint32_t samples;    /* planned per pixel; CLASSIC with 1 takes the middle of pixel, lens and light */
  uint32_t seed;
  uint32_t max_bounces; /* PATH: scatterings after the first; CLASSIC: depth of the recursion */
  float
      contribution_threshold; /* CLASSIC: a ray that brings no more than this share of what it meets is not traced; 0 = never */
  float clamp_indirect;       /* PATH: largest channel of a sample's indirect light; 0 = off */
  uint32_t pixel_filter;      /* LANCER_FILTER_* */
  float filter_width;         /* full width in pixels */
  uint32_t film_transparent;  /* 1: the environment leaves alpha 0 */
  uint32_t features;          /* LANCER_FEATURES_SCENE: the kernel for what the scene uses; ALL: the general one. Same pixels */
  uint32_t passes;            /* bits 1u << LANCER_PASS_*; COMBINED is always kept */
  uint32_t threads;           /* 0 = one per processor */
  uint32_t tile_size;         /* pixels; 0 = Lancer's choice. Changes no pixel */
} lancer_settings;

typedef struct lancer_progress {
  double fraction;  /* of the range given to lancer_session_render, 0 ... 1 */
  double seconds;   /* rendering time of this session so far */
  uint64_t samples; /* pixel samples of this session so far */
  uint64_t rays;    /* rays of all kinds so far */
} lancer_progress;

typedef struct lancer_statistics {
  double build_seconds, render_seconds;
  uint64_t samples; /* pixel samples */
  uint64_t camera_rays, bounce_rays, shadow_rays;
  uint64_t invalid_samples;                      /* non-finite, dropped */
  uint32_t invalid_x, invalid_y, invalid_sample; /* the first of them, for lancer_debug_sample */
  uint32_t threads;
  uint64_t triangles, instances, lights;
  uint64_t geometry_bytes, accelerator_bytes, film_bytes;
  char features[256];       /* what the scene uses, separated by blanks */
  char kernel[64];          /* the integrator's specialisation that ran */
  char instruction_set[32]; /* e.g. "AVX2" */
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
/* Copies one pass of the region: [region_height][region_width][channels]; float_count must be exactly that. While rendering,
 * too. */
LANCER_API lancer_status lancer_session_read(lancer_session session, uint32_t pass, float *out, size_t float_count);
LANCER_API lancer_status lancer_session_statistics(lancer_session session, lancer_statistics *statistics);

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

/* f[count][3] and pdf[count] of a material for local directions wo, wi [count][3] (n = +z); f without cosine, pdf per solid
 * angle; lobes that are a single direction give 0 here. */
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
 * instance. (The constant environment is not among them: the BSDF's own samples find it best.) */
LANCER_API lancer_status lancer_probe_light(lancer_scene scene, uint32_t light, uint32_t count, const double *points,
                                            const float *u, lancer_light_sample *samples);
/* Density per solid angle with which that light would sample wi (unit, [count][3]) from points; 0 where the direction misses
 * it. */
LANCER_API lancer_status lancer_probe_light_pdf(lancer_scene scene, uint32_t light, uint32_t count, const double *points,
                                                const double *wi, float *pdf);

/* Rays for raster positions [count][2] (pixels of the full image, 0, 0 lower left corner) and lens [count][2] in [0, 1).
 * Directions have z component 1 along the camera's axis (PERSPECTIVE) or unit length (ORTHOGRAPHIC). */
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
