#include "scene/cutout.h"

#include "scene/attribute.h"

#include <algorithm>

namespace lancer {

namespace {

// The node that a value comes from, if it is of this kind.
const Node *source(const Program &program, const Parameter &parameter, uint32_t kind) {
  if (!parameter.varies())
    return nullptr;
  const Node &node = program.nodes[size_t(parameter.node)];
  return node.kind == kind ? &node : nullptr;
}

Cutout recognise(const Material &material, const std::vector<Image> &images) {
  // Follow 1 - alpha back to the picture and its UV map.
  const Program &program = material.program;
  const Node *rest = source(program, material.transmittance, LANCER_NODE_MATH);
  if (!rest || rest->option != LANCER_MATH_SUBTRACT || (rest->flags & 1) || rest->inputs[0].varies() ||
      rest->inputs[0].value.x != 1.0f)
    return {};
  const Parameter &alpha = rest->inputs[1];
  const Node *alpha_node = source(program, alpha, LANCER_NODE_ALPHA);
  const Node *picture = alpha_node ? source(program, alpha_node->inputs[0], LANCER_NODE_IMAGE) : nullptr;
  if (!picture || picture->option != LANCER_PROJECT_FLAT || picture->image_count != 1 || images[picture->image].tile != 0)
    return {};
  const Node *place = source(program, picture->inputs[0], LANCER_NODE_COORDINATE);
  if (!place || place->option != LANCER_COORDINATE_UV)
    return {};
  Cutout cutout{picture->image, place->name, static_cast<Extension>(picture->flags & 0xf),
                static_cast<Interpolation>(picture->flags >> 4 & 0xf), true};
  // All that it scatters is weighted by the same alpha.
  for (const LobeDescription &lobe : material.lobes)
    cutout.nothing_beside &= lobe.weight.node == alpha.node;
  cutout.nothing_beside &= !material.emits() && !material.holdout.varies() && material.holdout.value == glm::vec3(0.0f);
  return cutout;
}

} // namespace

std::vector<Cutout> make_cutouts(const std::vector<Material> &materials, const std::vector<Image> &images) {
  std::vector<Cutout> cutouts;
  for (const Material &material : materials)
    cutouts.push_back(recognise(material, images));
  return cutouts;
}

float cutout_transmittance(const Cutout &cutout, const std::vector<Image> &images, const Mesh &mesh, uint32_t triangle,
                           const glm::dvec2 &bary) {
  glm::vec2 corner[3], uv(0.0f);
  if (corner_uvs(mesh, cutout.uv_map, triangle, corner))
    uv = (1.0 - bary.x - bary.y) * glm::dvec2(corner[0]) + bary.x * glm::dvec2(corner[1]) + bary.y * glm::dvec2(corner[2]);
  return std::max(1.0f - lookup_alpha(images[cutout.image], uv, cutout.extension, cutout.interpolation), 0.0f);
}

} // namespace lancer
