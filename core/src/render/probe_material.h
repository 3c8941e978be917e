// Materials and the world by themselves, for tests and panels: arrays in, arrays out, through the code that renders.
#pragma once

#include "lancer.h"
#include "scene/scene.h"

namespace lancer {

// Shapes, units and frames as in lancer.h.
void probe_bsdf(const Scene &scene, uint32_t material, uint32_t count, const float *wo, const float *wi, float *f, float *pdf);
void probe_bsdf_sample(const Scene &scene, uint32_t material, uint32_t count, const float *wo, const float *u,
                       lancer_bsdf_sample *samples);
void probe_lobes(const Scene &scene, uint32_t material, const float *wo, lancer_lobe_info *lobes, uint32_t capacity,
                 uint32_t *count, float *emission, float *transmittance);
void probe_node(const Scene &scene, uint32_t material, uint32_t node, uint32_t count, const float *uv, float *values);
void probe_world(const Scene &scene, uint32_t count, const double *directions, float *radiance, float *pdf);

} // namespace lancer
