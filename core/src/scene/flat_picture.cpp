#include "scene/flat_picture.h"

namespace lancer {

namespace {

// The node that a value comes from, if it is of this kind.
const Node *source(const Program &program, const Parameter &parameter, uint32_t kind) {
  const Node *node = program.source(parameter);
  return node && node->kind == kind ? node : nullptr;
}

const Node *math_source(const Program &program, const Parameter &parameter, uint32_t operation, uint32_t flags) {
  const Node *node = source(program, parameter, LANCER_NODE_MATH);
  return node && node->option == operation && node->flags == flags ? node : nullptr;
}

} // namespace

FlatPicture flat_picture(const Program &program, const Parameter &color, const std::vector<Image> &images) {
  const Node *picture = source(program, color, LANCER_NODE_IMAGE);
  if (!picture || picture->option != LANCER_PROJECT_FLAT || picture->image_count != 1 || images[picture->image].tile != 0)
    return {};
  const Node *place = source(program, picture->inputs[0], LANCER_NODE_COORDINATE);
  if (!place || place->option != LANCER_COORDINATE_UV)
    return {};
  return {picture->image, place->name, static_cast<Extension>(picture->flags & 0xf),
          static_cast<Interpolation>(picture->flags >> 4 & 0xf)};
}

std::optional<PictureAlpha> picture_alpha(const Program &program, const Parameter &value) {
  // A sum with nothing, for the sake of its clamp.
  const Node *clamp = math_source(program, value, LANCER_MATH_ADD, 1);
  if (clamp && (clamp->inputs[1].varies() || clamp->inputs[1].value.x != 0.0f))
    return {};
  const Node *alpha = source(program, clamp ? clamp->inputs[0] : value, LANCER_NODE_ALPHA);
  if (!alpha)
    return {};
  return PictureAlpha{alpha->inputs[0], clamp != nullptr};
}

std::optional<Remainder> remainder_of(const Program &program, const Parameter &value) {
  const Node *difference = math_source(program, value, LANCER_MATH_SUBTRACT, 0);
  if (!difference || difference->inputs[0].varies())
    return {};
  return Remainder{difference->inputs[0].value.x, difference->inputs[1]};
}

} // namespace lancer
