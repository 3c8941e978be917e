#include "scene/passing.h"

#include <algorithm>

namespace lancer {

bool is_glass(const LobeDescription &lobe) {
  return lobe.kind == LobeKind::Dielectric || lobe.kind == LobeKind::Glass || lobe.kind == LobeKind::Refraction ||
         (lobe.principled && may_be_positive(lobe.principled->transmission));
}

bool lets_light_through(const Material &material) {
  return material.transmits() || std::any_of(material.lobes.begin(), material.lobes.end(), is_glass);
}

} // namespace lancer
