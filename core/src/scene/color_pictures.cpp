#include "scene/color_pictures.h"

#include "lancer.h"

namespace lancer {

namespace {

bool is_alpha_of(const Node *node, int32_t picture) {
  return node && node->kind == LANCER_NODE_ALPHA && node->inputs[0].node == picture;
}

// Whether what passes straight on is a constant minus the alpha of the picture.
bool clears(const Program &program, const Parameter &transmittance, int32_t picture, float &whole) {
  const Node *node = program.source(transmittance);
  if (!node || node->kind != LANCER_NODE_MATH || node->option != LANCER_MATH_SUBTRACT || (node->flags & 1) ||
      node->inputs[0].varies())
    return false;
  whole = node->inputs[0].value.x;
  return is_alpha_of(program.source(node->inputs[1]), picture);
}

ColorPicture find(const Material &material, const std::vector<Image> &images) {
  const LobeDescription &lobe = material.lobes.front();
  const Parameter &color = lobe.principled ? lobe.principled->base_color : lobe.color;
  const Program &program = material.program;
  const Node *node = program.source(color);
  if (!node || material.emission.varies())
    return {};
  ColorPicture found;
  found.covers = lobe.weight.varies();
  if (found.covers && !is_alpha_of(program.source(lobe.weight), color.node))
    return {};
  found.clears = material.transmittance.varies();
  if (found.clears && !clears(program, material.transmittance, color.node, found.whole))
    return {};
  const Node *place = program.source(node->inputs[0]);
  if (node->kind != LANCER_NODE_IMAGE || node->option != LANCER_PROJECT_FLAT || node->image_count == 0 || !place ||
      place->kind != LANCER_NODE_COORDINATE || place->option != LANCER_COORDINATE_UV)
    return {};
  const Image &image = images[node->image];
  const std::optional<WideImage> wide = wide_image(image, node->flags, found.clears || found.covers);
  if (!wide)
    return {};
  found.image = &image;
  found.wide = *wide;
  found.extension = static_cast<Extension>(node->flags & 0xf);
  found.uv_map = place->name;
  if (!found.covers)
    found.weight = evaluate(lobe.weight, {});
  found.weighted = !lobe.principled;
  return found;
}

} // namespace

std::vector<ColorPicture> make_color_pictures(const std::vector<Material> &materials, const std::vector<WideMaterial> &wide,
                                              const std::vector<Image> &images) {
  std::vector<ColorPicture> all;
  for (size_t i = 0; i < materials.size(); ++i)
    all.push_back(wide[i].nodes ? find(materials[i], images) : ColorPicture{});
  return all;
}

} // namespace lancer
