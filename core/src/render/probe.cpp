#include "render/probe.h"
#include "lights/sample_light.h"

#include "bsdf/classic_lobes.h"
#include "integrator/stages/light.h"
#include "scene/messages.h"

#include <cmath>

namespace lancer {

namespace {

glm::dvec3 dvec3_at(const double *array, size_t i) { return {array[3 * i], array[3 * i + 1], array[3 * i + 2]}; }

template <class Target, class Vector> void store(Target *target, const Vector &v) {
  for (int i = 0; i < 3; ++i)
    target[i] = Target(v[i]);
}

// t stays the same: origin and direction are scaled alike.
std::vector<Ray> rays_of(const Scene &scene, uint32_t count, const double *origins, const double *directions,
                         const double *tmin, const double *tmax) {
  std::vector<Ray> rays(count);
  for (uint32_t i = 0; i < count; ++i) {
    rays[i].o = scene.normalisation.to_normalised(dvec3_at(origins, i));
    rays[i].d = dvec3_at(directions, i) * scene.normalisation.scale;
    rays[i].tmin = tmin[i];
    rays[i].tmax = tmax[i];
  }
  return rays;
}

void check_light(const Scene &scene, uint32_t light) {
  if (light >= scene.lights.size())
    bad_argument("probe: light " + std::to_string(light) + " >= " + std::to_string(scene.lights.size()) + " lights");
}

} // namespace

void probe_intersect(const Scene &scene, uint32_t count, const double *origins, const double *directions, const double *tmin,
                     const double *tmax, lancer_hit *hits) {
  const std::vector<Ray> rays = rays_of(scene, count, origins, directions, tmin, tmax);
  std::vector<Hit> found(count);
  scene.accelerator->closest_hit(rays, found);
  for (uint32_t i = 0; i < count; ++i) {
    lancer_hit &hit = hits[i];
    hit = {};
    hit.t = found[i].t;
    hit.instance = hit.primitive = hit.material = kNone;
    if (!found[i].valid()) {
      hit.t = std::numeric_limits<double>::infinity();
      continue;
    }
    const Surface surface = surface_at(scene.geometry, scene.slots, rays[i], found[i]);
    const Instance &instance = scene.geometry.instances[found[i].instance];
    const SurfaceAttributes attributes = attributes_at(scene.geometry, surface);
    const bool mesh = instance.kind == ShapeKind::Mesh;
    hit.u = mesh ? found[i].u : double(attributes.uv.x);
    hit.v = mesh ? found[i].v : double(attributes.uv.y);
    store(hit.position, scene.normalisation.to_world(surface.p));
    store(hit.normal, surface.ns);
    store(hit.geometric_normal, surface.ng);
    store(hit.color, attributes.color);
    hit.uv[0] = attributes.uv.x;
    hit.uv[1] = attributes.uv.y;
    hit.instance = instance.number;
    hit.primitive = scene.face_number(found[i].instance, found[i].primitive);
    hit.material = surface.material;
  }
}

void probe_occluded(const Scene &scene, uint32_t count, const double *origins, const double *directions, const double *tmin,
                    const double *tmax, uint8_t *occluded) {
  const std::vector<Ray> rays = rays_of(scene, count, origins, directions, tmin, tmax);
  scene.accelerator->any_hit(rays, std::span(occluded, count));
}

void probe_traversal(const Scene &scene, uint32_t count, const double *origins, const double *directions, const double *tmin,
                     const double *tmax, bool any, uint64_t counts[4]) {
  const TraversalCounts all = scene.accelerator->count(rays_of(scene, count, origins, directions, tmin, tmax), any);
  counts[0] = all.nodes;
  counts[1] = all.triangle_blocks;
  counts[2] = all.sphere_blocks;
  counts[3] = all.instances;
}

void probe_microfacet(uint32_t count, const float *cos_nh, const float *cos_lh, const float *cos_nv, const float *alpha,
                      const float *ior, float *d, float *f, float *g1) {
  // A direction with the given cosine, in the plane y = 0.
  const auto direction = [](float cosine) {
    const double c = double(cosine);
    return glm::vec3(float(std::sqrt((1.0 - c) * (1.0 + c))), 0.0f, cosine);
  };
  for (uint32_t i = 0; i < count; ++i) {
    d[i] = cos_nh[i] > 0.0f ? coating_d(tan2_theta(direction(cos_nh[i])), alpha[i]) : 0.0f;
    f[i] = fresnel_dielectric(cos_lh[i], ior[i]);
    g1[i] = cos_nv[i] > 0.0f ? beckmann_g1(beckmann_a(direction(cos_nv[i]), alpha[i])) : 0.0f;
  }
}

void probe_light(const Scene &scene, uint32_t light, uint32_t count, const double *points, const float *u,
                 lancer_light_sample *samples) {
  check_light(scene, light);
  check_unit(u, size_t(2) * count);
  const double scale = scene.normalisation.scale;
  LightStage stage(scene, nullptr);
  Doubles p[3] = {};
  Floats time;
  std::fill_n(time, kBlockLanes, kMiddleTime);
  VertexNumbers numbers{};
  for (uint32_t first = 0; first < count; first += kBlockLanes) {
    const uint32_t lanes = std::min(uint32_t{kBlockLanes}, count - first);
    for (uint32_t lane = 0; lane < lanes; ++lane) {
      put(scene.normalisation.to_normalised(dvec3_at(points, first + lane)), p, lane);
      for (uint32_t k = 0; k < 2; ++k)
        numbers.of[kVertexLight + k][lane] = u[2 * (first + lane) + k];
    }
    stage.sample(light, (1u << lanes) - 1u, p, time, numbers);
    const LightSamples &found = stage.samples();
    for (uint32_t lane = 0; lane < lanes; ++lane) {
      lancer_light_sample &sample = samples[first + lane];
      sample = {};
      if (!(found.pdf[lane] > 0.0))
        continue;
      const bool far = found.far >> lane & 1;
      const double distance = far ? std::numeric_limits<double>::infinity() : found.distance[lane];
      store(sample.wi, get(found.wi, lane));
      sample.distance = distance / scale;
      store(sample.radiance, get(found.radiance, lane));
      sample.pdf = float(found.pdf[lane]);
      sample.delta = found.delta[lane];
    }
  }
}

void probe_light_pdf(const Scene &scene, uint32_t light, uint32_t count, const double *points, const double *wi, float *pdf) {
  check_light(scene, light);
  check_directions(wi, count);
  const size_t described = scene.lights.lamps().size();
  const double infinity = std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 p = scene.normalisation.to_normalised(dvec3_at(points, i));
    const glm::dvec3 w = dvec3_at(wi, i);
    if (light < described) {
      pdf[i] = float(meet(scene.lights.lamps()[light], p, w).pdf);
      continue;
    }
    if (light - described >= scene.lights.emitters().size()) {
      pdf[i] = float(scene.lights.environment().pdf(w, false));
      continue;
    }
    // Sum over all places where the direction hits the emitter: sampling may have chosen any of them.
    const Emitter &emitter = scene.lights.emitters()[light - described];
    double sum = 0.0;
    Ray ray;
    ray.o = p;
    ray.d = w;
    Hit hit;
    for (uint32_t crossing = 0; crossing < kMaxCrossings; ++crossing) {
      scene.accelerator->closest_hit(std::span(&ray, 1), std::span(&hit, 1));
      if (!hit.valid())
        break;
      const Surface surface = surface_at(scene.geometry, scene.slots, ray, hit);
      if (surface.instance == emitter.instance())
        sum += emitter.pdf(scene.geometry, p, surface);
      ray = ray_from(surface, w, infinity);
      hit = Hit{};
    }
    pdf[i] = float(sum);
  }
}

void probe_filter(const PixelFilter &filter, uint32_t count, const float *u, float *offset) {
  check_unit(u, count);
  for (uint32_t i = 0; i < count; ++i)
    offset[i] = filter.sample(u[i]);
}

void probe_camera(const Session &session, uint32_t count, const double *raster, const double *lens, double *origins,
                  double *directions) {
  const Normalisation &normalisation = session.scene().normalisation;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::dvec2 disk = session.camera().aperture({float(lens[2 * i]), float(lens[2 * i + 1])});
    const Ray ray = session.camera().ray({raster[2 * i], raster[2 * i + 1]}, disk);
    store(origins + size_t(3) * i, normalisation.to_world(ray.o));
    store(directions + size_t(3) * i, ray.tmax < 0.0 ? glm::dvec3(0.0) : ray.d);
  }
}

} // namespace lancer
