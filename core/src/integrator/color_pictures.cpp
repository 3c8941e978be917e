#include "integrator/color_pictures.h"

#include "lancer.h"

namespace lancer {

namespace {

ColorPicture find(const Scene &scene, const Material &material) {
  const LobeDescription &lobe = material.lobes.front();
  const Parameter &color = lobe.principled ? lobe.principled->base_color : lobe.color;
  if (!color.varies() || lobe.weight.varies() || material.emission.varies() || material.transmittance.varies())
    return {};
  const std::vector<Node> &nodes = material.program.nodes;
  const Node &node = nodes[size_t(color.node)];
  if (node.kind != LANCER_NODE_IMAGE || node.option != LANCER_PROJECT_FLAT || node.image_count == 0 || !node.inputs[0].varies())
    return {};
  const Node &source = nodes[size_t(node.inputs[0].node)];
  const std::optional<WideImage> image = wide_image(scene.images[node.image], node.flags);
  if (!image || source.kind != LANCER_NODE_COORDINATE || source.option != LANCER_COORDINATE_UV)
    return {};
  return {*image, source.name, evaluate(lobe.weight, {}), !lobe.principled};
}

} // namespace

ColorPictures::ColorPictures(const Scene &scene) {
  for (size_t i = 0; i < scene.materials.size(); ++i)
    of_.push_back(scene.wide[i].nodes ? find(scene, scene.materials[i]) : ColorPicture{});
}

} // namespace lancer
