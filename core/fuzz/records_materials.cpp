// Parts of materials and worlds.
#include "records.h"

#include "scene/lobe_inputs.h"

#include <algorithm>
#include <cmath>

namespace lancer_fuzz {

namespace {

constexpr uint32_t kMostNodes = 12, kMostLobes = 4;

} // namespace

lancer_parameter Records::parameter(float usual, float low, float high) {
  if (node_count_ && bytes_.rarely(90))
    return {{0, 0, 0}, int32_t(bytes_.reference(node_count_))};
  if (bytes_.rarely(1))
    return {{0, 0, 0}, -2};
  const float x = bytes_.number(usual, low, high);
  if (!bytes_.rarely(60))
    return {{x, x, x}, -1};
  const float y = bytes_.number(usual, low, high);
  return {{x, y, bytes_.number(usual, low, high)}, -1};
}

lancer_parameter Records::vector() {
  if (bytes_.rarely(50))
    return parameter(0.5f, -1.0f, 1.0f);
  return {{0, 0, 0}, -1};
}

lancer_node Records::node(const Filled &filled, uint32_t at) {
  lancer_node node = {};
  node.name = name();
  node.kind = bytes_.choice(LANCER_NODE_COUNT);
  node.option = bytes_.byte();
  const bool steady = node.option & 0x80;
  // Most options are valid for their kind: the largest kinds have 41 and 24.
  if (node.kind == LANCER_NODE_MATH)
    node.option %= LANCER_MATH_COUNT + 1;
  else if (node.kind == LANCER_NODE_VECTOR_MATH)
    node.option %= LANCER_VECTOR_COUNT + 1;
  else if (node.kind == LANCER_NODE_COORDINATE)
    node.option %= LANCER_COORDINATE_COUNT + 1;
  else if (node.kind == LANCER_NODE_MIX)
    node.option %= LANCER_MIX_COUNT + 1;
  else
    node.option %= node.kind == LANCER_NODE_NORMAL_MAP || node.kind == LANCER_NODE_NOISE || node.kind == LANCER_NODE_VORONOI ? 6
                   : node.kind == LANCER_NODE_GRADIENT                                                                       ? 8
                   : node.kind == LANCER_NODE_SEPARATE || node.kind == LANCER_NODE_WAVE                                      ? 3
                   : node.kind == LANCER_NODE_MAGIC                                           ? 12
                   : node.kind == LANCER_NODE_GABOR || node.kind == LANCER_NODE_RADIAL_TILING ? 2
                                                                                              : 4;
  const bool picture = node.kind == LANCER_NODE_IMAGE || node.kind == LANCER_NODE_ENVIRONMENT || node.kind == LANCER_NODE_IES;
  if (picture) {
    // In separate statements: the compiler chooses the order of operands.
    node.flags = bytes_.choice(4);
    node.flags |= bytes_.choice(3) << 4;
    node.flags |= flag() << 8;
  } else if (bytes_.rarely(100))
    node.flags = bytes_.below(node.kind == LANCER_NODE_WAVE || node.kind == LANCER_NODE_VECTOR_TRANSFORM ? 16
                              : node.kind == LANCER_NODE_BUMP                                            ? 8
                              : node.kind == LANCER_NODE_MIX || node.kind == LANCER_NODE_OCCLUSION       ? 4
                                                                                                         : 2);
  else if (bytes_.rarely(2))
    node.flags = ~0u;
  if (steady)
    node.flags |= LANCER_NODE_STEADY;
  if (picture && filled.images) {
    node.image = bytes_.reference(filled.images);
    node.image_count = node.image < filled.images ? 1 + bytes_.below(filled.images - node.image) : 1;
    if (bytes_.rarely(3))
      node.image_count = ~0u;
  }
  if (node.kind == LANCER_NODE_BUMP)
    node.first = bytes_.below(at + 2);
  node_count_ = at;
  for (lancer_parameter &input : node.inputs)
    input = parameter(0.5f, -2.0f, 2.0f);
  for (int i = 0; i < 12; ++i)
    node.matrix[i] = i % 5 == 0 ? 1.0f : 0.0f;
  if (flag(40))
    for (float &value : node.matrix)
      value = bytes_.number(0.5f, -2.0f, 2.0f);
  return node;
}

uint32_t Records::nodes(const Filled &filled, const lancer_node *&out) {
  node_count_ = 0;
  std::vector<lancer_node> nodes(bytes_.rarely(140) ? bytes_.below(kMostNodes + 1) : 0);
  for (uint32_t i = 0; i < nodes.size(); ++i)
    nodes[i] = node(filled, i);
  const auto count = uint32_t(nodes.size());
  out = keep(std::move(nodes));
  node_count_ = count;
  // More than the maximum, and more than the array has: rejected before any is read.
  if (bytes_.rarely(1))
    return 4097 + bytes_.word() / 2;
  if (bytes_.rarely(1)) {
    out = nullptr;
    return count + 1;
  }
  return count;
}

lancer_principled Records::principled() {
  lancer_principled p = {};
  p.rules = bytes_.choice(LANCER_RULES_BLENDER_52 + 1);
  p.distribution = bytes_.rarely(100) ? uint32_t(LANCER_DISTRIBUTION_MULTI_GGX) : bytes_.choice(4);
  p.option = bytes_.choice(2);
  p.subsurface_option = p.rules + 2 * p.option;
  using lancer::ParameterKind;
  const auto value = [&](ParameterKind kind, float given) {
    switch (kind) {
    case ParameterKind::Direction:
    case ParameterKind::Vector:
      return vector();
    case ParameterKind::Index:
    case ParameterKind::Denser:
      return parameter(given, 0.5f, 3.0f);
    case ParameterKind::Color:
      return parameter(given, 0.0f, 4.0f);
    default:
      return parameter(given);
    }
  };
#define LANCER_FILL(kind, name, spoken, given) p.name = value(ParameterKind::kind, given);
  LANCER_PRINCIPLED_PARAMETERS(LANCER_FILL)
#undef LANCER_FILL
  return p;
}

lancer_lobe Records::lobe() {
  lancer_lobe lobe = {};
  // The last kind is one past the others, in the place of an invalid one, so that the corpus keeps its meaning.
  lobe.kind = bytes_.choice(LANCER_MINNAERT);
  lobe.distribution = bytes_.choice(4);
  lobe.option = bytes_.choice(2);
  lobe.rules = bytes_.choice(LANCER_RULES_BLENDER_52 + 1);
  lobe.weight = parameter(1.0f);
  lobe.color = parameter(0.8f);
  lobe.roughness = parameter(0.3f);
  lobe.ior = parameter(1.5f, 0.5f, 3.0f);
  lobe.shininess = parameter(20.0f, 0.0f, 200.0f);
  lobe.edge = parameter(1.0f);
  lobe.anisotropy = parameter(0.0f, -1.0f, 1.0f);
  lobe.rotation = parameter(0.0f, -1.0f, 1.0f);
  lobe.normal = vector();
  lobe.tangent = vector();
  // Kinds of later versions stand in the place of mirrors with a distribution, so that the corpus keeps its meaning.
  if (lobe.kind == LANCER_MIRROR && lobe.distribution > 0) {
    lobe.kind = std::min<uint32_t>(LANCER_TOON + 2 * (lobe.distribution - 1) + lobe.option, LANCER_LOBE_KIND_COUNT);
    lobe.roughness_across = lobe.edge;
    lobe.offset = lobe.rotation;
    lobe.option += lobe.kind == LANCER_SUBSURFACE ? lobe.rules : 0;
  }
  if (lobe.kind == LANCER_PRINCIPLED && !bytes_.rarely(3))
    lobe.principled = keep(std::vector<lancer_principled>{principled()});
  return lobe;
}

lancer_material Records::material(const Filled &filled) {
  lancer_material material = {};
  material.name = name();
  material.node_count = nodes(filled, material.nodes);
  std::vector<lancer_lobe> lobes(bytes_.rarely(3) ? 64 : bytes_.rarely(60) ? bytes_.below(kMostLobes + 1) : 1);
  for (lancer_lobe &lobe : lobes)
    lobe = this->lobe();
  material.lobe_count = uint32_t(lobes.size());
  material.lobes = keep(std::move(lobes));
  if (bytes_.rarely(1))
    material.lobe_count = ~0u;
  material.material_index = bytes_.byte();
  material.flags = bytes_.rarely(60) ? bytes_.below(16) : bytes_.rarely(2) ? ~0u : 0u;
  material.emission = parameter(0.0f, 0.0f, 4.0f);
  material.transmittance = parameter(0.0f);
  material.holdout = parameter(0.0f);
  material.ambient = parameter(0.0f);
  material.displacement = vector();
  material.normal = vector();
  material.output_count = outputs(material.outputs);
  material.matte = wide_ ? matte() : 0;
  // A portal is described by parts of the material, so that the corpus keeps its meaning.
  if (material.material_index % 8 == 7) {
    lancer_portal portal = {};
    portal.moves = material.flags & 3;
    portal.weight = material.transmittance;
    portal.position = material.displacement;
    portal.direction = material.normal;
    material.portal_count = 1;
    material.portals = keep(std::vector<lancer_portal>{portal});
  }
  node_count_ = 0;
  return material;
}

} // namespace lancer_fuzz
