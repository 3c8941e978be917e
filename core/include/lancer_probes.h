/* Probes of Lancer's tracer: single stages, vectorised, for its tests. No renderer needs them.
 *
 * Conventions are those of lancer.h; a scene must be committed. */
#ifndef LANCER_PROBES_H
#define LANCER_PROBES_H

#include "lancer.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lancer_hit {
  double t;           /* in units of the direction's length; infinity on a miss */
  double u, v;        /* barycentric weights of vertices 1 and 2; exact surfaces: their parametrisation */
  double position[3]; /* world */
  float normal[3];    /* shading normal, world, unit, on the side of the outward geometric normal */
  float geometric_normal[3];
  float uv[2];
  float color[3];     /* vertex colour; 1 if there is none */
  uint32_t instance;  /* in order of adding; UINT32_MAX on a miss */
  uint32_t primitive; /* triangle as given to add_mesh; 0 for exact surfaces */
  uint32_t material;  /* UINT32_MAX if the instance has no slot */
} lancer_hit;

/* The parts that a scene's commit made; it took all others from the objects or from the scene before. */
typedef struct lancer_made {
  uint32_t placements;     /* 1: instances were placed, and the tree of the world was built */
  uint32_t mesh_trees;     /* trees of meshes */
  uint32_t triangles;      /* in all these trees */
  uint32_t changed_meshes; /* meshes that were displaced or flattened */
  uint32_t materials;      /* materials that were made ready */
  uint32_t emitters;       /* trees of emitting faces */
  uint32_t skies;          /* 1: the world's sampling maps were made */
  uint32_t plane_searches; /* 1: coplanar faces were searched */
} lancer_made;
LANCER_API lancer_status lancer_probe_made(lancer_scene scene, lancer_made *made);

/* Finds closest hits with tmin < t < tmax. origins, directions [count][3]; tmin, tmax [count]. */
LANCER_API lancer_status lancer_probe_intersect(lancer_scene scene, uint32_t count, const double *origins,
                                                const double *directions, const double *tmin, const double *tmax,
                                                lancer_hit *hits);
/* Sets occluded[i] = 1 if the ray hits anything with tmin < t < tmax. */
LANCER_API lancer_status lancer_probe_occluded(lancer_scene scene, uint32_t count, const double *origins,
                                               const double *directions, const double *tmin, const double *tmax,
                                               uint8_t *occluded);

/* Counts the work of the wide BVH in lancer_probe_occluded (any = 1) or lancer_probe_intersect (any = 0) over all these
 * rays; zeros with another accelerator. counts[4]: nodes of eight boxes (256 bytes each); blocks of four triangles (160);
 * blocks of four exact spheres (416); trees of meshes entered plus single exact surfaces. */
LANCER_API lancer_status lancer_probe_traversal(lancer_scene scene, uint32_t count, const double *origins,
                                                const double *directions, const double *tmin, const double *tmax, uint32_t any,
                                                uint64_t *counts);

/* Evaluates f[count][3] and pdf[count] of a material for local directions wo, wi [count][3] (n = +z, tangent +x; nodes are
 * evaluated at the middle of a unit square); f without cosine, pdf per solid angle; lobes of a single direction give 0 here. */
LANCER_API lancer_status lancer_probe_bsdf(lancer_scene scene, uint32_t material, uint32_t count, const float *wo,
                                           const float *wi, float *f, float *pdf);

typedef struct lancer_bsdf_sample {
  float wi[3];
  float weight[3]; /* f |cos| / pdf; for a single direction its weight / probability; 0 = no sample */
  float pdf;       /* per solid angle; for a single direction its probability */
  uint32_t delta;  /* 1 for a single direction */
} lancer_bsdf_sample;
/* Samples a material: wo [count][3], u [count][3] in [0, 1). */
LANCER_API lancer_status lancer_probe_bsdf_sample(lancer_scene scene, uint32_t material, uint32_t count, const float *wo,
                                                  const float *u, lancer_bsdf_sample *samples);

/* A lobe for one wo, after nodes and layers. */
typedef struct lancer_lobe_info {
  uint32_t kind;      /* LANCER_LAMBERT ...; never PRINCIPLED */
  uint32_t component; /* 0 diffuse, 1 glossy, 2 transmission */
  float weight[3];    /* factor of the lobe's value */
  float albedo[3];    /* scattered share of light from wo, weight included */
  float roughness[2]; /* alpha along tangent and bitangent */
  float ior;
  float probability; /* of being sampled */
} lancer_lobe_info;
/* Lists the lobes of a material for the local direction wo (float[3]). lobes receives the first capacity of them, *count
 * their total number. emission and transmittance (float[3] each) may be NULL. */
LANCER_API lancer_status lancer_probe_lobes(lancer_scene scene, uint32_t material, const float *wo, lancer_lobe_info *lobes,
                                            uint32_t capacity, uint32_t *count, float *emission, float *transmittance);
/* Evaluates a node of a material at UV coordinates [count][2] of a unit square in the plane z = 0 of its object, seen along
 * its normal: values [count][4]. */
LANCER_API lancer_status lancer_probe_node(lancer_scene scene, uint32_t material, uint32_t node, uint32_t count,
                                           const float *uv, float *values);
/* Evaluates the world's radiance [count][3] in unit directions [count][3], and the density per solid angle with which each
 * direction is sampled. */
LANCER_API lancer_status lancer_probe_world(lancer_scene scene, uint32_t count, const double *directions, float *radiance,
                                            float *pdf);

/* Evaluates the terms of BECKMANN for cosines against n and h: D(n.h), F(l.h), G1 of a direction with cosine n.v and v.h >
 * 0. Arrays [count]. */
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
/* Samples one light from points [count][3] with u [count][2]. Lights are numbered in order of adding, then one per emitting
 * instance, then the environment if its radiance varies (a constant one is better found by BSDF samples). */
LANCER_API lancer_status lancer_probe_light(lancer_scene scene, uint32_t light, uint32_t count, const double *points,
                                            const float *u, lancer_light_sample *samples);
/* Returns the density per solid angle with which that light would sample wi (unit, [count][3]) from points; 0 if the
 * direction misses the light. */
LANCER_API lancer_status lancer_probe_light_pdf(lancer_scene scene, uint32_t light, uint32_t count, const double *points,
                                                const double *wi, float *pdf);

/* Generates rays for raster positions [count][2] (pixels of the full image, 0, 0 lower left corner) and lens [count][2] in
 * [0, 1). Directions have z component 1 along the camera's axis (PERSPECTIVE) or unit length; 0, 0, 0 outside a panorama's
 * field of view. */
LANCER_API lancer_status lancer_probe_camera(lancer_session session, uint32_t count, const double *raster, const double *lens,
                                             double *origins, double *directions);

/* Returns the sampler's numbers for dimensions 0 ... dimensions - 1 of one address: out[dimensions] in [0, 1). */
LANCER_API lancer_status lancer_probe_sampler(uint32_t seed, uint32_t x, uint32_t y, uint32_t sample, uint32_t dimensions,
                                              float *out);
/* Returns the offsets from the pixel's centre, in pixels, that a filter of that kind and full width samples for u [count]. */
LANCER_API lancer_status lancer_probe_filter(uint32_t filter, float width, uint32_t count, const float *u, float *offset);

#ifdef __cplusplus
}
#endif
#endif
