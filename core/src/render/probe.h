// Probes: queries of formulas and materials without a picture.
#pragma once

#include "compile/scene.h"
#include "lancer_probes.h"
#include "render/session.h"
#include "scene/messages.h"

#include <cmath>
#include <cstddef>
#include <string>

namespace lancer {

// Checks of a probe's input: numbers in [0, 1), and finite directions.

inline void check_unit(const float *u, size_t count) {
  for (size_t i = 0; i < count; ++i)
    if (!(u[i] >= 0.0f && u[i] < 1.0f))
      bad_argument("probe: u " + std::to_string(u[i]) + " is not in [0, 1)");
}

inline void check_directions(const double *directions, size_t count) {
  for (size_t i = 0; i < 3 * count; ++i)
    if (!std::isfinite(directions[i]))
      bad_argument("probe: direction " + std::to_string(i / 3) + " holds " + std::to_string(directions[i]));
}

// Probes of single stages, for tests: arrays in, arrays out, through the code that renders.

// Shapes, units and frames as in lancer.h.
void probe_intersect(const Scene &scene, uint32_t count, const double *origins, const double *directions, const double *tmin,
                     const double *tmax, lancer_hit *hits);
void probe_occluded(const Scene &scene, uint32_t count, const double *origins, const double *directions, const double *tmin,
                    const double *tmax, uint8_t *occluded);
void probe_traversal(const Scene &scene, uint32_t count, const double *origins, const double *directions, const double *tmin,
                     const double *tmax, bool any, uint64_t counts[4]);
void probe_microfacet(uint32_t count, const float *cos_nh, const float *cos_lh, const float *cos_nv, const float *alpha,
                      const float *ior, float *d, float *f, float *g1);
void probe_light(const Scene &scene, uint32_t light, uint32_t count, const double *points, const float *u,
                 lancer_light_sample *samples);
void probe_light_pdf(const Scene &scene, uint32_t light, uint32_t count, const double *points, const double *wi, float *pdf);
void probe_filter(const PixelFilter &filter, uint32_t count, const float *u, float *offset);
void probe_camera(const Session &session, uint32_t count, const double *raster, const double *lens, double *origins,
                  double *directions);

// Probes of materials and the world, for tests and panels: arrays in, arrays out, through the code that renders.

// Shapes, units and frames as in lancer.h.
void probe_bsdf(const Scene &scene, uint32_t material, uint32_t count, const float *wo, const float *wi, float *f, float *pdf);
void probe_bsdf_sample(const Scene &scene, uint32_t material, uint32_t count, const float *wo, const float *u,
                       lancer_bsdf_sample *samples);
void probe_lobes(const Scene &scene, uint32_t material, const float *wo, lancer_lobe_info *lobes, uint32_t capacity,
                 uint32_t *count, float *emission, float *transmittance);
// Computes the value (float[4]) of a node whose inputs are constants. Throws Error for a node that depends on the shading
// point.
void evaluate_node(const lancer_node &node, float *value);
void probe_node(const Scene &scene, uint32_t material, uint32_t node, uint32_t count, const float *uv, float *values);
void probe_world(const Scene &scene, uint32_t count, const double *directions, float *radiance, float *pdf);

} // namespace lancer
