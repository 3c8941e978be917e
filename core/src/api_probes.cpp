// The probes of the C interface: single queries of scenes and sessions.
#include "nodes/sky_table.h"
#include "objects.h"
#include "render/probe.h"
#include "render/session.h"
#include "render/thread_pool.h"
#include "sampling/sobol.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace lancer;

// Arrays may be NULL only where count is 0.
void require_arrays(uint32_t count, std::initializer_list<const void *> arrays) {
  for (const void *array : arrays)
    if (count)
      require(array, "probe: an array");
}

// Calls ask with a committed scene. Arrays may be NULL only if count is 0.
template <class Ask>
lancer_status probe_scene(lancer_scene handle, uint32_t count, std::initializer_list<const void *> arrays, Ask &&ask) {
  return guard([&] {
    const auto object = scene_of(handle);
    require_arrays(count, arrays);
    std::shared_ptr<const Scene> scene;
    {
      const std::lock_guard lock(object->mutex);
      scene = object->committed();
    }
    ask(*scene);
    return LANCER_OK;
  });
}

} // namespace

extern "C" {

lancer_status lancer_probe_intersect(lancer_scene scene, uint32_t count, const double *origins, const double *directions,
                                     const double *tmin, const double *tmax, lancer_hit *hits) {
  return probe_scene(scene, count, {origins, directions, tmin, tmax, hits},
                     [&](const Scene &s) { probe_intersect(s, count, origins, directions, tmin, tmax, hits); });
}

lancer_status lancer_probe_occluded(lancer_scene scene, uint32_t count, const double *origins, const double *directions,
                                    const double *tmin, const double *tmax, uint8_t *occluded) {
  return probe_scene(scene, count, {origins, directions, tmin, tmax, occluded},
                     [&](const Scene &s) { probe_occluded(s, count, origins, directions, tmin, tmax, occluded); });
}

lancer_status lancer_probe_traversal(lancer_scene scene, uint32_t count, const double *origins, const double *directions,
                                     const double *tmin, const double *tmax, uint32_t any, uint64_t *counts) {
  return probe_scene(scene, count, {origins, directions, tmin, tmax}, [&](const Scene &s) {
    require(counts, "probe: an array");
    probe_traversal(s, count, origins, directions, tmin, tmax, any != 0, counts);
  });
}

lancer_status lancer_probe_bsdf(lancer_scene scene, uint32_t material, uint32_t count, const float *wo, const float *wi,
                                float *f, float *pdf) {
  return probe_scene(scene, count, {wo, wi, f, pdf}, [&](const Scene &s) { probe_bsdf(s, material, count, wo, wi, f, pdf); });
}

lancer_status lancer_probe_bsdf_sample(lancer_scene scene, uint32_t material, uint32_t count, const float *wo, const float *u,
                                       lancer_bsdf_sample *samples) {
  return probe_scene(scene, count, {wo, u, samples},
                     [&](const Scene &s) { probe_bsdf_sample(s, material, count, wo, u, samples); });
}

lancer_status lancer_probe_lobes(lancer_scene scene, uint32_t material, const float *wo, lancer_lobe_info *lobes,
                                 uint32_t capacity, uint32_t *count, float *emission, float *transmittance) {
  return guard([&] {
    require(count, "probe: count");
    if (capacity)
      require(lobes, "probe: lobes");
    return probe_scene(scene, 1, {wo},
                       [&](const Scene &s) { probe_lobes(s, material, wo, lobes, capacity, count, emission, transmittance); });
  });
}

lancer_status lancer_probe_node(lancer_scene scene, uint32_t material, uint32_t node, uint32_t count, const float *uv,
                                float *values) {
  return probe_scene(scene, count, {uv, values}, [&](const Scene &s) { probe_node(s, material, node, count, uv, values); });
}

lancer_status lancer_evaluate_node(const lancer_node *node, float *value) {
  return guard([&] {
    require(node, "node");
    require(value, "value");
    evaluate_node(*node, value);
    return LANCER_OK;
  });
}

lancer_status lancer_compute_sky(uint32_t model, double elevation, double diameter, double altitude, const double *densities,
                                 float *xyz, float *rims) {
  return guard([&] {
    require(densities, "sky: densities");
    require(xyz, "sky: xyz");
    require(rims, "sky: rims");
    if (model < LANCER_SKY_NISHITA || model >= LANCER_SKY_COUNT)
      bad_argument("sky: model " + std::to_string(model) + " has no atmosphere");
    static_assert(LANCER_SKY_WIDTH == kSkyWidth);
    const Atmosphere atmosphere{model, elevation, diameter, altitude, {densities[0], densities[1], densities[2]}};
    for (const double number : {elevation, diameter, altitude, densities[0], densities[1], densities[2]})
      if (!std::isfinite(number))
        bad_argument("sky: a number is not finite");
    if (diameter <= 0.0 || std::min({densities[0], densities[1], densities[2]}) < 0.0)
      bad_argument("sky: the sun's diameter must be above 0, and no density below");
    compute_sky(atmosphere, {ThreadPool::resolved(0)}, xyz, rims);
    return LANCER_OK;
  });
}

lancer_status lancer_probe_world(lancer_scene scene, uint32_t count, const double *directions, float *radiance, float *pdf) {
  return probe_scene(scene, count, {directions, radiance, pdf},
                     [&](const Scene &s) { probe_world(s, count, directions, radiance, pdf); });
}

lancer_status lancer_probe_microfacet(uint32_t count, const float *cos_nh, const float *cos_lh, const float *cos_nv,
                                      const float *alpha, const float *ior, float *d, float *f, float *g1) {
  return guard([&] {
    require_arrays(count, {cos_nh, cos_lh, cos_nv, alpha, ior, d, f, g1});
    probe_microfacet(count, cos_nh, cos_lh, cos_nv, alpha, ior, d, f, g1);
    return LANCER_OK;
  });
}

lancer_status lancer_probe_light(lancer_scene scene, uint32_t light, uint32_t count, const double *points, const float *u,
                                 lancer_light_sample *samples) {
  return probe_scene(scene, count, {points, u, samples},
                     [&](const Scene &s) { probe_light(s, light, count, points, u, samples); });
}

lancer_status lancer_probe_light_pdf(lancer_scene scene, uint32_t light, uint32_t count, const double *points, const double *wi,
                                     float *pdf) {
  return probe_scene(scene, count, {points, wi, pdf},
                     [&](const Scene &s) { probe_light_pdf(s, light, count, points, wi, pdf); });
}

lancer_status lancer_probe_camera(lancer_session session, uint32_t count, const double *raster, const double *lens,
                                  double *origins, double *directions) {
  return guard([&] {
    const auto object = session_of(session);
    require_arrays(count, {raster, lens, origins, directions});
    const std::lock_guard lock(object->mutex);
    probe_camera(object->session, count, raster, lens, origins, directions);
    return LANCER_OK;
  });
}

lancer_status lancer_probe_sampler(uint32_t seed, uint32_t x, uint32_t y, uint32_t sample, uint32_t dimensions, float *out) {
  return guard([&] {
    if (dimensions)
      require(out, "probe: out");
    const Sampler sampler(seed, x, y, sample);
    for (uint32_t i = 0; i < dimensions; ++i)
      out[i] = sampler.get1(i);
    return LANCER_OK;
  });
}

lancer_status lancer_probe_filter(uint32_t filter, float width, uint32_t count, const float *u, float *offset) {
  return guard([&] {
    const PixelFilter pixel(read_filter(filter, width), width);
    require_arrays(count, {u, offset});
    probe_filter(pixel, count, u, offset);
    return LANCER_OK;
  });
}

} // extern "C"
