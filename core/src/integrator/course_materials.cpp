#include "integrator/course_materials.h"

#include "bsdf/build.h"
#include "sampling/plain_vectors.h"
#include "scene/ready_lobes.h"

#include <algorithm>
#include <memory>

namespace lancer {

namespace {

// Neither nodes nor normals of its own have a say; nothing passes straight on.
bool is_plain(const Material &material) {
  const std::span<const ReadyLobe> lobes(material.ready.get(), material.lobes.size());
  return material.fixed() && !material.layered_emission && !material.transmits() && !material.normal.varies() &&
         material.holdout.value.x <= 0.0f && std::all_of(lobes.begin(), lobes.end(), [](const ReadyLobe &ready) {
           const bool course = ready.inputs.kind == LobeKind::Lambert || ready.inputs.kind == LobeKind::Beckmann;
           return course && ready.inputs.normal == glm::vec3(0.0f) && ready.inputs.tangent == glm::vec3(0.0f);
         });
}

void fill(const Material &material, Bsdf<float> &bsdf, WideCourse &wide) {
  if (!is_plain(material))
    return;
  // Colour, roughness and index are the same from everywhere: look from above.
  const glm::vec3 up(0.0f, 0.0f, 1.0f);
  bsdf.begin(up, up, up, false, true);
  for (size_t i = 0; i < material.lobes.size(); ++i)
    add_lobe(bsdf, material.ready[i].inputs);
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe<float> &lobe = bsdf.lobes[i];
    const bool matte = lobe.shape == LobeShape::Lambert;
    // One of each at most, so that their order has no say.
    if (lobe.delta || (matte ? wide.matte : wide.coated))
      return;
    (matte ? wide.matte : wide.coated) = true;
    copy(lobe.color, matte ? wide.kd : wide.ks);
    if (!matte) {
      wide.alpha = lobe.alpha_x;
      wide.ior = lobe.ior;
    }
  }
  wide.shines = material.emits() || material.ambient.value != glm::vec3(0.0f);
  wide.known = true;
}

} // namespace

std::vector<WideCourse> make_course_materials(const std::vector<Material> &materials) {
  const auto bsdf = std::make_unique<Bsdf<float>>();
  std::vector<WideCourse> all(materials.size());
  for (size_t i = 0; i < materials.size(); ++i)
    fill(materials[i], *bsdf, all[i]);
  return all;
}

} // namespace lancer
