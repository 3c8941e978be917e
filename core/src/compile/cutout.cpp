#include "compile/cutout.h"

#include "nodes/image.h"
#include "scene/surface.h"

#include <algorithm>

namespace lancer {

namespace {

// Returns the node whose result is the parameter, if the node is of this kind; otherwise null.
const Node *source(const ProgramView &program, const Parameter &parameter, uint32_t kind) {
  const Node *node = program.source(parameter);
  return node && node->kind == kind ? node : nullptr;
}

const Node *math_source(const ProgramView &program, const Parameter &parameter, uint32_t operation, uint32_t flags) {
  const Node *node = source(program, parameter, NodeKind::Math);
  return node && node->option == operation && node->flags == flags ? node : nullptr;
}

} // namespace

FlatImage flat_image(const ProgramView &program, const Parameter &color) {
  const Node *picture = source(program, color, NodeKind::Image);
  if (!picture || picture->option != ImageProjection::Flat || picture->image_count != 1 ||
      program.images[picture->image].tile != 0)
    return {};
  const Node *place = source(program, picture->inputs[0], NodeKind::Coordinate);
  if (!place || place->option != Coordinate::Uv)
    return {};
  return {&program.images[picture->image], place->name, static_cast<Extension>(picture->flags & 0xf),
          static_cast<Interpolation>(picture->flags >> 4 & 0xf)};
}

std::optional<ImageAlpha> image_alpha(const ProgramView &program, const Parameter &value) {
  // A node that adds 0 serves only to clamp its result.
  const Node *clamp = math_source(program, value, MathOperation::Add, 1);
  if (clamp && (clamp->inputs[1].varies() || clamp->inputs[1].value.x != 0.0f))
    return {};
  const Node *alpha = source(program, clamp ? clamp->inputs[0] : value, NodeKind::Alpha);
  if (!alpha)
    return {};
  return ImageAlpha{alpha->inputs[0], clamp != nullptr};
}

std::optional<Remainder> remainder_of(const ProgramView &program, const Parameter &value) {
  const Node *difference = math_source(program, value, MathOperation::Subtract, 0);
  if (!difference || difference->inputs[0].varies())
    return {};
  return Remainder{difference->inputs[0].value.x, difference->inputs[1]};
}

namespace {

// Follows the transmittance 1 - alpha back to the image and its UV map. share: receives the parameter of alpha.
AlphaImage find_alpha(const MaterialView &material, Parameter &share) {
  const std::optional<Remainder> rest = remainder_of(material.program, material.transmittance);
  if (!rest || rest->whole != 1.0f)
    return {};
  share = rest->share;
  const std::optional<ImageAlpha> alpha = image_alpha(material.program, share);
  if (!alpha)
    return {};
  return {flat_image(material.program, alpha->picture), alpha->clamped};
}

// Whether a node reads only its inputs, the triangle and the place within it.
bool is_painted(const Node &node) {
  switch (node.kind) {
  case NodeKind::Coordinate:
    return node.option == Coordinate::Uv || node.option == Coordinate::Parametric;
  case NodeKind::Image:
    return node.option != ImageProjection::Box;
  case NodeKind::Attribute:
  case NodeKind::Noise:
  case NodeKind::Voronoi:
  case NodeKind::Gradient:
  case NodeKind::Curves:
  case NodeKind::Sky:
    return true;
  default:
    return asks_no_place(node.kind);
  }
}

bool all_painted(const ProgramView &program, ScheduleView schedule) {
  return std::ranges::all_of(schedule, [&](uint16_t node) { return is_painted(program.nodes[node]); });
}

} // namespace

Cutout make_cutout(const MaterialView &material) {
  Cutout cutout;
  // Levels of images are chosen by the ray.
  if (!material.transmittance.varies() || material.program.mipmapped)
    return cutout;
  Parameter share;
  cutout.alpha = find_alpha(material, share);
  cutout.painted = all_painted(material.program, material.transmittance_nodes);
  cutout.ends_with_alpha = cutout.alpha.known();
  // The surface may vanish where it neither emits nor is a holdout, and where each lobe's weight varies.
  std::vector<Parameter> deciding{material.transmittance};
  cutout.may_end =
      material.portals.empty() && !material.emits() && !material.holdout.varies() && material.holdout.value == glm::vec3(0.0f);
  for (const LobeDescription &lobe : material.lobes) {
    cutout.may_end &= lobe.weight.varies();
    deciding.push_back(lobe.weight);
    cutout.ends_with_alpha &= lobe.weight.node == share.node;
  }
  cutout.nodes = material.program.schedule(deciding);
  cutout.may_end &= all_painted(material.program, cutout.nodes);
  return cutout;
}

float alpha_at(const AlphaImage &picture, const MeshView &mesh, uint32_t triangle, const glm::dvec2 &bary) {
  const glm::vec2 uv = uv_at(mesh, picture.uv_map, triangle, bary);
  const float alpha = lookup_alpha(*picture.image, uv, picture.extension, picture.interpolation);
  return clamped_alpha(alpha, picture.clamped);
}

} // namespace lancer
