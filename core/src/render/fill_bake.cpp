#include "render/fill_bake.h"

#include "lancer.h"
#include "scene/messages.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace lancer {

namespace {

// Returns the index of an instance in the geometry; kNone if it was left out.
uint32_t index_of(const Scene &scene, uint32_t number) {
  const auto &instances = scene.geometry.instances;
  const auto found = std::ranges::find(instances, number, &Instance::number);
  return found == instances.end() ? kNone : uint32_t(found - instances.begin());
}

// Returns the primitive of each triangle of the user's mesh; kNone for one that was left out, and beyond the end.
std::vector<uint32_t> primitives(const Scene &scene, uint32_t instance) {
  const Instance &placed = scene.geometry.instances[instance];
  const size_t count = scene.geometry.meshes[placed.mesh].triangles.size();
  std::vector<uint32_t> result;
  for (uint32_t primitive = 0; primitive < count; ++primitive) {
    const uint32_t given = scene.face_number(instance, primitive);
    if (given >= result.size())
      result.resize(size_t(given) + 1, kNone);
    result[given] = primitive;
  }
  return result;
}

bool finite(const lancer_texel &texel) {
  return std::ranges::all_of(texel.weights, [](float x) { return x >= 0.0f && x <= 1.0f; }) &&
         std::ranges::all_of(texel.dx, [](float x) { return std::isfinite(x); }) &&
         std::ranges::all_of(texel.dy, [](float x) { return std::isfinite(x); });
}

} // namespace

Bake read_bake(const lancer_bake &source, const Scene &scene, const Camera &camera) {
  const uint64_t count = uint64_t(camera.width) * camera.height;
  if (source.texel_count != count)
    bad_argument("bake: " + std::to_string(source.texel_count) + " texels, the camera has " + std::to_string(count) +
                 " pixels");
  if (!source.texels)
    bad_argument("bake: texels is NULL");
  if (source.view > LANCER_BAKE_SKY)
    bad_argument("bake: view " + std::to_string(source.view) + " is not one of 0 ... " + std::to_string(LANCER_BAKE_SKY));
  constexpr uint32_t all = LANCER_BAKE_LACKS_DIFFUSE | LANCER_BAKE_LACKS_GLOSSY | LANCER_BAKE_LACKS_TRANSMISSION;
  if (source.lacks & ~all)
    bad_argument("bake: lacks " + std::to_string(source.lacks) + " has unknown bits");
  if (!(source.bare_roughness >= 0.0f && source.bare_roughness <= 1.0f))
    bad_argument("bake: bare roughness " + std::to_string(source.bare_roughness) + " is not in 0 ... 1");
  Bake result{.instance = index_of(scene, source.instance),
              .view = BakeView(source.view),
              .lacks = source.lacks,
              .bare_roughness = source.bare_roughness,
              .texels = {}};
  result.texels.resize(count);
  if (result.instance == kNone)
    return result;
  if (scene.geometry.instances[result.instance].kind != ShapeKind::Mesh)
    bad_argument("bake: instance " + std::to_string(source.instance) + " is no mesh");
  const std::vector<uint32_t> primitive_of = primitives(scene, result.instance);
  for (uint64_t i = 0; i < count; ++i) {
    const lancer_texel &texel = source.texels[i];
    if (texel.triangle >= primitive_of.size() || !finite(texel))
      continue;
    result.texels[i] = {.primitive = primitive_of[texel.triangle],
                        .weights = {texel.weights[0], texel.weights[1]},
                        .dx = {texel.dx[0], texel.dx[1]},
                        .dy = {texel.dy[0], texel.dy[1]}};
  }
  return result;
}

} // namespace lancer
