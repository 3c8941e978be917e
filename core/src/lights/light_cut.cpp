#include "lights/light_cut.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace lancer {

namespace {

constexpr int kBuckets = 12;
// The least energy of a light relative to the brightest: below lies what no float sum would notice.
constexpr double kLeastEnergy = 0x1p-60;

// What lights are sorted by.
glm::dvec3 place(const DescribedLight &light) { return light.light.centre; }

// The cheapest cut along one axis between twelve equal slices of the lights' centres.
void try_axis(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, int axis, double low, double extent,
              double regularization, LightCut &best) {
  LightBounds slices[kBuckets];
  uint32_t counts[kBuckets] = {};
  for (uint32_t i = begin; i < end; ++i) {
    const int slice = std::clamp(int(kBuckets * ((place(lights[i])[axis] - low) / extent)), 0, kBuckets - 1);
    slices[slice].add(lights[i].bounds);
    ++counts[slice];
  }
  // Collect from the right, then go along from the left.
  double right[kBuckets];
  LightBounds sum;
  for (int slice = kBuckets - 1; slice > 0; --slice) {
    sum.add(slices[slice]);
    right[slice] = sum.cost();
  }
  sum = {};
  uint32_t count = 0;
  for (int slice = 0; slice + 1 < kBuckets; ++slice) {
    sum.add(slices[slice]);
    count += counts[slice];
    const double cost = regularization * (sum.cost() + right[slice + 1]);
    if (cost < best.cost && count > 0 && begin + count < end)
      best = {axis, begin + count, cost};
  }
}

} // namespace

LightBounds bounds_of(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end) {
  LightBounds whole;
  for (uint32_t i = begin; i < end; ++i)
    whole.add(lights[i].bounds);
  return whole;
}

LightCut find_cut(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, double cost) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (uint32_t i = begin; i < end; ++i) {
    low = glm::min(low, place(lights[i]));
    high = glm::max(high, place(lights[i]));
  }
  LightCut cut{-1, begin + (end - begin) / 2, cost};
  const glm::dvec3 extent = high - low;
  const double widest = std::max({extent.x, extent.y, extent.z});
  for (int axis = 0; axis < 3; ++axis)
    if (extent[axis] > 0.0)
      try_axis(lights, begin, end, axis, low[axis], extent[axis], widest / extent[axis], cut);
  return cut;
}

void make_cut(std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, const LightCut &cut) {
  if (cut.axis < 0)
    return;
  // Ties go by number, and each side keeps its order, in which its lights are added up: so every machine builds the same tree.
  const auto key = [&](const DescribedLight &light) { return std::pair(place(light)[cut.axis], light.light.number); };
  std::vector<std::pair<double, uint32_t>> keys;
  for (uint32_t i = begin; i < end; ++i)
    keys.push_back(key(lights[i]));
  const auto middle = keys.begin() + (cut.middle - begin);
  std::nth_element(keys.begin(), middle, keys.end());
  std::stable_partition(lights.begin() + begin, lights.begin() + end,
                        [&, first = *middle](const DescribedLight &light) { return key(light) < first; });
}

LightBounds prepare(std::vector<DescribedLight> &lights) {
  std::erase_if(lights, [](const DescribedLight &light) { return !(light.bounds.energy > 0.0); });
  LightBounds whole;
  double brightest = 0.0;
  for (const DescribedLight &light : lights) {
    brightest = std::max(brightest, light.bounds.energy);
    whole.add(light.bounds);
  }
  const int exponent = lights.empty() ? 0 : -std::ilogb(brightest);
  for (DescribedLight &light : lights) {
    light.bounds.energy = std::max(std::ldexp(light.bounds.energy, exponent), kLeastEnergy);
    light.light.energy = float(light.bounds.energy);
  }
  return whole;
}

} // namespace lancer
