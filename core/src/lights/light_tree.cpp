#include "lights/light_tree.h"

#include "lights/float4.h"

namespace lancer {

namespace {

constexpr double kBelowOne = 1.0 - 0x1p-53;

} // namespace

// importance() of clusters, its upper bound only, four at a time.
LightTree::Weights LightTree::weigh(const Node &node, const LightQuery &query) {
  Weights weights;
  const glm::vec3 p = query.p_float, n = query.n, flat = glm::abs(n);
  const float slack = query.transmits ? std::numeric_limits<float>::infinity() : query.slack;
  const float behind = query.transmits ? -1.0f : 1.0f;
  const Float4 zero = all4(0.0f), one = all4(1.0f), little = all4(kCosineSlack);
  for (int i = 0; i < kWidth; i += 4) {
    const Float4 x = load4(node.centre[0] + i) - p.x, y = load4(node.centre[1] + i) - p.y, z = load4(node.centre[2] + i) - p.z;
    const Float4 hx = load4(node.half[0] + i), hy = load4(node.half[1] + i), hz = load4(node.half[2] + i);
    const Float4 d2 = x * x + y * y + z * z, r2 = hx * hx + hy * hy + hz * hz;
    const Float4 per_d = 1.0f / sqrt4(larger4(d2, all4(kNearest2)));
    const Float4 along = n.x * x + n.y * y + n.z * z, above = along + (flat.x * hx + flat.y * hy + flat.z * hz) + slack;
    // The half angle that it fills.
    const Float4 ratio = sqrt4(r2) * per_d, sin_u = d2 > r2 ? ratio : zero, cos_u = d2 > r2 ? sine4(ratio) : -one;
    // The smallest angle at which light may arrive, and that at which it may leave.
    const Float4 one_side = along * per_d, cos_i = larger4(one_side, behind * one_side);
    const Float4 arrives = cos_i >= cos_u ? one : cos_i * cos_u + sine4(cos_i) * sin_u;
    const Float4 cos_o = load4(node.cos_o + i), energy = load4(node.energy + i);
    const Float4 cos_theta = -(load4(node.axis[0] + i) * x + load4(node.axis[1] + i) * y + load4(node.axis[2] + i) * z) * per_d;
    const Float4 inner = cos_theta * cos_u + sine4(cos_theta) * sin_u;
    const Float4 turned = inner >= cos_o ? one : inner * cos_o + sine4(inner) * load4(node.sin_o + i);
    const Float4 leaves = cos_theta >= cos_u ? one : turned;
    const Float4 near2 = larger4(larger4(d2, 0.25f * r2), all4(kNearest2));
    const Float4 most = larger4(energy * larger4(arrives, little) * larger4(leaves, little) / near2, all4(kLeastImportance));
    // 0 where nothing can arrive: no child, below the surface, outside the cone.
    const Float4 edge = cos_theta >= cos_u ? one : inner - (load4(node.cos_all + i) - little);
    const Float4 kept = energy > zero ? most : zero, visible = above > zero ? kept : zero;
    *reinterpret_cast<Float4 *>(weights.most + i) = edge > zero ? visible : zero;
  }
  for (const float most : weights.most)
    weights.sum += double(most);
  return weights;
}

LightChoice LightTree::choose(const LightQuery &query, double u) const {
  LightChoice choice{0, 1.0, u};
  for (uint32_t number = 0; !empty();) {
    const Weights weights = weigh(nodes_[number], query);
    if (!(weights.sum > 0.0))
      break;
    // Go along the weights; rounding at the end stays with the last that has one.
    double left = choice.u * weights.sum;
    int child = 0;
    for (int i = 0; i < kWidth; ++i) {
      if (!(weights.most[i] > 0.0f))
        continue;
      child = i;
      if (left < double(weights.most[i]))
        break;
      left -= double(weights.most[i]);
    }
    const double most = double(weights.most[child]);
    choice.u = std::min(left / most, kBelowOne);
    choice.probability *= most / weights.sum;
    number = nodes_[number].child[child];
    if (number & kLight) {
      choice.number = number & ~kLight;
      return choice;
    }
  }
  return {};
}

double LightTree::probability(const LightQuery &query, uint32_t number) const {
  if (number >= place_of_.size() || place_of_[number] == kNone)
    return 0.0;
  // Go up from the light.
  double probability = 1.0;
  for (uint32_t slot = place_of_[number]; slot != kNone && probability > 0.0; slot = slot_of_[slot / kWidth]) {
    const Weights weights = weigh(nodes_[slot / kWidth], query);
    probability *= weights.sum > 0.0 ? double(weights.most[slot % kWidth]) / weights.sum : 0.0;
  }
  return probability;
}

} // namespace lancer
