#include "lights/few_lights.h"

#include <algorithm>

namespace lancer {

namespace {

void raise(std::span<Importance> parts) {
  float strongest = 0.0f;
  for (const Importance &part : parts)
    strongest = std::max(strongest, part.most);
  const float least = kRaised / float(parts.size()) * strongest;
  for (Importance &part : parts)
    part.most = part.most > 0.0f ? std::max(part.most, least) : 0.0f;
}

// What each of several has of the sum of upper and of lower bounds, averaged; where no lower bound is positive, what can
// contribute shares that half evenly.
struct Sums {
  double most = 0.0, least = 0.0;
  int able = 0;

  explicit Sums(std::span<const Importance> parts) {
    for (const Importance &part : parts) {
      most += double(part.most);
      least += double(part.least);
      able += part.most > 0.0f;
    }
  }
  double share(const Importance &part) const {
    if (!(part.most > 0.0f))
      return 0.0;
    const double lower = least > 0.0 ? double(part.least) / least : 1.0 / able;
    return 0.5 * (double(part.most) / most + lower);
  }
};

} // namespace

Importance FewLights::weigh(const LightQuery &query, uint32_t number) const {
  const LightNode &node = nodes_[number];
  if (node.count == 1)
    return importance(query, lights_[node.first]);
  return node.distant ? importance_far(query, node.shape) : importance(query, node.shape);
}

glm::dvec2 FewLights::shares(const LightQuery &query, uint32_t pair) const {
  std::array<Importance, 2> parts{weigh(query, pair), weigh(query, pair + 1)};
  raise(parts);
  // A cluster's lower bound is mostly 0 and would share the choices evenly: five times the variance under 200 lamps.
  if (pair != 0 && (nodes_[pair].count != 1 || nodes_[pair + 1].count != 1)) {
    const double left = double(parts[0].most), right = double(parts[1].most), sum = left + right;
    return sum > 0.0 ? glm::dvec2(left, right) / sum : glm::dvec2(0.0);
  }
  const Sums sums(parts);
  return {sums.share(parts[0]), sums.share(parts[1])};
}

std::span<Importance> FewLights::weigh_leaf(const LightQuery &query, const LightNode &node,
                                            std::array<Importance, kLeafLights> &room) const {
  const std::span<Importance> parts(room.data(), node.count);
  for (uint32_t i = 0; i < node.count; ++i)
    parts[i] = importance(query, lights_[node.first + i]);
  raise(parts);
  return parts;
}

LightChoice FewLights::choose_of_leaf(const LightQuery &query, const LightNode &node, double u) const {
  if (node.count == 1)
    return {lights_[node.first].number, 1.0, u};
  std::array<Importance, kLeafLights> room;
  const std::span<Importance> parts = weigh_leaf(query, node, room);
  const Sums sums(parts);
  // Go along the shares; rounding at the end stays with the last that has one.
  LightChoice choice;
  for (uint32_t i = 0; i < node.count; ++i) {
    const double share = sums.share(parts[i]);
    if (!(share > 0.0))
      continue;
    choice = {lights_[node.first + i].number, share, std::min(u / share, kBelowOne)};
    if (u < share)
      break;
    u -= share;
  }
  return choice;
}

LightChoice FewLights::choose(const LightQuery &query, double u) const {
  if (empty())
    return {};
  // Go down by the children's shares.
  double probability = 1.0;
  uint32_t number = root_, pair = 0;
  while (number == kNone || nodes_[number].count == 0) {
    if (number != kNone)
      pair = nodes_[number].first;
    const glm::dvec2 share = shares(query, pair);
    const bool right = share.y > 0.0 && !(u < share.x);
    if (!(share.x > 0.0) && !right)
      return {};
    u = std::min((right ? u - share.x : u) / share[right], kBelowOne);
    probability *= share[right];
    number = pair + right;
  }
  LightChoice choice = choose_of_leaf(query, nodes_[number], u);
  choice.probability *= probability;
  return choice;
}

double FewLights::share_of_leaf(const LightQuery &query, const LightNode &node, uint32_t place) const {
  if (node.count == 1)
    return 1.0;
  std::array<Importance, kLeafLights> room;
  const std::span<Importance> parts = weigh_leaf(query, node, room);
  return Sums(parts).share(parts[place - node.first]);
}

double FewLights::probability(const LightQuery &query, uint32_t number) const {
  if (number >= place_of_.size() || place_of_[number] == kNone)
    return 0.0;
  // Go up from the light's leaf.
  const uint32_t place = place_of_[number];
  uint32_t at = node_of_[place];
  double probability = share_of_leaf(query, nodes_[at], place);
  while (at != root_ && probability > 0.0) {
    const uint32_t pair = at & ~1u;
    probability *= shares(query, pair)[at & 1];
    at = pair == 0 ? kNone : parent_[pair / 2];
  }
  return probability;
}

} // namespace lancer
