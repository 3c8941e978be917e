// The formulas of shading and the records that kernels read, compiled for a graphics processor: `make device-check`. A container, an
// owning pointer, a virtual call or a variable of the host in one of them is an error there. Nothing of it is shipped.
#define __host__ __attribute__((host))
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))

// Headers of the system that the rooms' headers include: they are the host's alone.
#include <cstdlib>
#include <new>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <immintrin.h>
#include <limits>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <thread>
#include <type_traits>
#include <unordered_map>
#include <vector>

#pragma clang force_cuda_host_device begin
#include <glm/glm.hpp>

#include "bsdf/bsdf.h"
#include "bsdf/build.h"
#include "bsdf/material_lobes.h"
#include "lights/sample_light.h"
#include "nodes/dispatch.h"
#include "sampling/direction_map.h"
#include "sampling/sobol.h"
#include "scene/hit_surface.h"
#include "scene/quadric_point.h"
#pragma clang force_cuda_host_device end

namespace lancer {

// Records are copied to a device as bytes.
template <class... Records> constexpr bool are_flat = (std::is_trivially_copyable_v<Records> && ...);
static_assert(are_flat<MeshView, GeometryView, Instance, ObjectInfo, ObjectAttributeView, MeshAttribute, PolygonCenter>);
static_assert(are_flat<MaterialView, LobeDescription, Portal, ReadyLobe, CachedPlan, ProgramView, Node, ImageView, WorldView>);
static_assert(are_flat<Light, NodeScene, NodeBlock, NodeLanes, LookingLanes>);

extern "C" {

__global__ void run_program(const ProgramView *program, ScheduleView schedule, const NodeBlock *block, NodeLanes *values) {
  run_block<float>(*program, schedule, *block, values);
}

// Makes the lobes of a material, samples a direction and evaluates another.
__global__ void shade(const MaterialView *const *materials, std::span<const glm::vec4> values, const glm::vec3 *wo,
                      const glm::vec3 *ns, const glm::vec3 *ng, const Vec3<float> *wi, Sampler sampler, Bsdf<float> *bsdf,
                      BsdfSample<float> *sample, BsdfValue<float> *value) {
  find_lobes<float>(materials, PlaceValues{values}, false, *wo, *ns, *ng, *bsdf, {});
  const auto u = sampler.get8(0);
  *sample = bsdf->sample(u[0], u[1], u[2]);
  *value = bsdf->eval_lit(*wi);
}

__global__ void sample_and_meet(const Light *light, const glm::dvec3 *p, const glm::vec2 *u, LightSample *found, LightHit *hit) {
  *found = sample(*light, *p, *u);
  *hit = meet(*light, *p, found->wi);
}

__global__ void sample_sky(const DirectionTable *table, const glm::vec2 *u, const glm::vec3 *wi, double *direction, double *pdf) {
  const auto sample = sample_direction<float>(*table, u->x, u->y);
  direction[0] = sample.direction.x;
  *pdf = direction_pdf<float>(*table, Vec3<float>(*wi));
}

__global__ void find_surface(const double *const *placement, const Vector3<float> *corners, const Vector3<float> *normals,
                             double u, double v, SurfaceLanes<float> *surface) {
  *surface = triangle_surface(Placements<float>(placement), *reinterpret_cast<const Vector3<float>(*)[3]>(corners),
                              *reinterpret_cast<const Vector3<float>(*)[3]>(normals), true, u, v);
}

} // extern "C"

} // namespace lancer
