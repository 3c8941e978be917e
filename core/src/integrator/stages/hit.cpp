#include "integrator/stages/hit.h"

#include <algorithm>
#include <array>

namespace lancer {

namespace {

// Bound of the computed value of a barycentric weight whose exact value is 0. Corners 1 and 2 give exactly 0; corner 0 gives
// the rounding error of 1 minus both quotients. Each quotient, and the determinant that they share, has an error of 2^-53 of a
// sum of 1: less than 2.5 * 2^-53 in all.
constexpr double kNoWeight = 0x1p-52;

bool on_border(const Hit &hit) { return hit.u == 0.0 || hit.v == 0.0 || 1.0 - hit.u - hit.v <= kNoWeight; }

// Returns the vertices between which a place on a triangle's border lies: two for an edge, one for a corner.
std::array<uint32_t, 2> border_vertices(const MeshView &mesh, const Hit &hit) {
  const glm::uvec3 triangle = mesh.triangles[hit.primitive];
  const bool has[3] = {1.0 - hit.u - hit.v > kNoWeight, hit.u != 0.0, hit.v != 0.0};
  std::array<uint32_t, 2> vertices{kNone, kNone};
  size_t count = 0;
  for (int corner = 0; corner < 3; ++corner)
    if (has[corner] && count < 2)
      vertices[count++] = triangle[corner];
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

} // namespace

Crossing *Crossings::find(size_t ray, const Hit &hit) {
  for (uint32_t number = rays_[ray].first; number != kNone; number = crossings_[number].next) {
    const Hit &other = crossings_[number].hit;
    if (other.instance != hit.instance)
      continue;
    const Instance &instance = geometry_.instances[hit.instance];
    if (instance.kind != ShapeKind::Mesh) {
      if (other.t == hit.t)
        return &crossings_[number];
      continue;
    }
    if (other.primitive == hit.primitive)
      return &crossings_[number];
    if (!on_border(hit) || !on_border(other))
      continue;
    const MeshView &mesh = geometry_.meshes[instance.mesh];
    if (border_vertices(mesh, hit) == border_vertices(mesh, other))
      return &crossings_[number];
  }
  return nullptr;
}

void Crossings::put(Crossing *known, size_t ray, const Hit &hit, const glm::vec3 &transmittance) {
  if (known) {
    if (closer(hit.t, hit.instance, hit.primitive, known->hit)) {
      known->hit = hit;
      known->transmittance = transmittance;
    }
    return;
  }
  crossings_.push_back({hit, transmittance, rays_[ray].first});
  rays_[ray].first = uint32_t(crossings_.size() - 1);
  ++rays_[ray].count;
}

uint32_t Crossings::count_before(size_t ray, const Hit &hit) const {
  uint32_t count = 0;
  for (uint32_t number = rays_[ray].first; number != kNone; number = crossings_[number].next) {
    const Hit &passed = crossings_[number].hit;
    count += closer(passed.t, passed.instance, passed.primitive, hit);
  }
  return count;
}

std::span<const Crossing> Crossings::sort(size_t ray, bool clear) {
  sorted_.clear();
  for (uint32_t number = rays_[ray].first; number != kNone; number = crossings_[number].next)
    if (clear || crossings_[number].transmittance != glm::vec3(1.0f))
      sorted_.push_back(crossings_[number]);
  if (sorted_.size() > 1)
    std::sort(sorted_.begin(), sorted_.end(),
              [](const Crossing &a, const Crossing &b) { return closer(a.hit.t, a.hit.instance, a.hit.primitive, b.hit); });
  return sorted_;
}

HitStage::HitStage(const Scene &scene, const Camera &camera)
    : HitFilter(scene.perforated_instances.data()), scene_(scene), shader_(scene, &camera), crossings_(scene.geometry),
      crosses_((scene.features & kFeatureTransparency) &&
               std::ranges::find(scene.perforated_instances, 1) != scene.perforated_instances.end()) {}

void HitStage::find(std::span<const Ray> rays, std::span<const uint32_t> left, std::vector<Hit> &hits) {
  hits.resize(rays.size());
  if (!crosses_)
    return scene_.accelerator->closest_hit(rays, hits);
  left_ = left;
  crossings_.begin(rays.size());
  scene_.accelerator->closest_hit(rays, hits, *this);
}

bool HitStage::counts(size_t ray, const Hit &hit) {
  const uint32_t material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
  if (!scene_.cutouts[material].may_end)
    return true;
  Crossing *known = crossings_.find(ray, hit);
  if (known && known->hit.primitive == hit.primitive)
    return false;
  // Surfaces behind as many crossings as the path may still pass are out of reach.
  if (!known && crossings_.count_before(ray, hit) >= left_[ray])
    return true;
  if (shader_.is_there(material, hit))
    return true;
  crossings_.put(known, ray, hit, glm::vec3(1.0f));
  return false;
}

} // namespace lancer
