#include "scene/color_pictures.h"

#include "scene/flat_picture.h"

namespace lancer {

namespace {

ColorPicture find(const Material &material, const std::vector<Image> &images) {
  const LobeDescription &lobe = material.lobes.front();
  const Parameter &color = lobe.principled ? lobe.principled->base_color : lobe.color;
  const Program &program = material.program;
  const FlatPicture picture = flat_picture(program, color, images);
  if (!picture.known() || material.emission.varies())
    return {};
  ColorPicture found;
  found.covers = lobe.weight.varies();
  found.clears = material.transmittance.varies();
  const std::optional<Remainder> rest = remainder_of(program, material.transmittance);
  if (found.clears && !rest)
    return {};
  if (found.covers || found.clears) {
    // One alpha of the same picture says both.
    const Parameter &share = found.covers ? lobe.weight : rest->share;
    const std::optional<PictureAlpha> alpha = picture_alpha(program, share);
    if (!alpha || alpha->picture.node != color.node || (found.clears && rest->share.node != share.node))
      return {};
    found.clamped = alpha->clamped;
  }
  if (found.clears)
    found.whole = rest->whole;
  const Image &image = images[picture.image];
  const std::optional<WideImage> wide = wide_image(image, program.source(color)->flags, found.clears || found.covers);
  if (!wide)
    return {};
  found.image = &image;
  found.wide = *wide;
  found.extension = picture.extension;
  found.uv_map = picture.uv_map;
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
