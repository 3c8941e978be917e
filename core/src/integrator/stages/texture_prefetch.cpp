#include "integrator/stages/texture_prefetch.h"

#include "nodes/image.h"
#include "scene/enums.h"
#include "scene/image.h"
#include "scene/surface.h"

namespace lancer {

namespace {

// Smaller images stay in the caches without a prefetch.
constexpr size_t kLarge = size_t(4) << 20;

} // namespace

TexturePrefetch::TexturePrefetch(const Scene &scene) : scene_(scene) {
  for (const MaterialView &material : scene.materials) {
    pictures_.push_back(find(material));
    any_ = any_ || pictures_.back().image;
  }
}

TexturePrefetch::Source TexturePrefetch::find(const MaterialView &material) {
  const std::span<const Node> nodes = material.program.nodes;
  for (const Node &node : nodes) {
    if (node.kind != NodeKind::Image || node.option != ImageProjection::Flat || node.image_count != 1 ||
        !node.inputs[0].varies())
      continue;
    const Node &source = nodes[size_t(node.inputs[0].node)];
    const ImageView &image = material.program.images[node.image];
    // A prefetch brings no page of a file into memory.
    if (source.kind == NodeKind::Coordinate && source.option == Coordinate::Uv && image.bytes() >= kLarge && !image.in_blocks &&
        image.levels == 1)
      return {&image, source.name, static_cast<Extension>(node.flags & 0xf)};
  }
  return {};
}

ComingLookup TexturePrefetch::coming(const Hit &hit) const {
  const Instance &instance = scene_.geometry.instances[hit.instance];
  if (instance.kind != ShapeKind::Mesh)
    return {};
  const uint32_t material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
  if (material == kNone || !pictures_[material].image)
    return {};
  const Source &picture = pictures_[material];
  glm::vec2 uv[3];
  if (!corner_uvs(scene_.geometry.meshes[instance.mesh], picture.uv_map, hit.primitive, uv))
    return {};
  const float u = float(hit.u), v = float(hit.v);
  return {picture.image, (1.0f - u - v) * uv[0] + u * uv[1] + v * uv[2], picture.extension};
}

void TexturePrefetch::ask(const Hit &hit) const {
  const ComingLookup next = coming(hit);
  if (next.image)
    prefetch(*next.image, next.uv, next.extension);
}

} // namespace lancer
