// Selects one of several items in proportion to weights.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lancer {

// Upper bound on the remainder of a random number.
inline constexpr double kBelowOne = 1.0 - 0x1p-53;

class WeightedChoice {
public:
  struct Choice {
    uint32_t index = 0;
    float pmf = 0.0f; // 0: nothing to select
    float u = 0.0f;   // position of u within the selected interval, uniform in [0, 1): a new random number
  };

  WeightedChoice() = default;

  // Weights that are negative or not finite count as 0. If all are 0, nothing is selected.
  explicit WeightedChoice(const std::vector<double> &weights) : cdf_(weights.size() + 1, 0.0) {
    const auto usable = [](double w) { return w > 0.0 && std::isfinite(w) ? w : 0.0; };
    double largest = 0.0;
    for (double w : weights)
      largest = std::max(largest, usable(w));
    if (largest == 0.0)
      return;
    // Divide by the largest first, so that the sum of huge weights stays finite.
    for (std::size_t i = 0; i < weights.size(); ++i)
      cdf_[i + 1] = cdf_[i] + usable(weights[i]) / largest;
    const double total = cdf_.back();
    for (double &c : cdf_)
      c /= total;
    // Record the entry at equal steps of the number, where a search begins.
    guide_.resize(guide_steps(weights.size()));
    uint32_t entry = 0;
    for (std::size_t step = 0; step < guide_.size(); ++step) {
      while (entry + 1 < weights.size() && !(cdf_[entry + 1] > static_cast<double>(step) / static_cast<double>(guide_.size())))
        ++entry;
      guide_[step] = entry;
    }
  }

  // Returns the number of steps in the guide of this many weights.
  static constexpr std::size_t guide_steps(std::size_t size) { return size / kPerStep + 1; }
  // For searches outside this class: sums() returns the sums of the weights up to each entry, of which the last is 1; guide()
  // returns the entries at equal steps of the number. If nothing can be selected, the sums are 0 and the guide is empty.
  const std::vector<double> &sums() const { return cdf_; }
  const std::vector<uint32_t> &guide() const { return guide_; }

  std::size_t size() const { return cdf_.empty() ? 0 : cdf_.size() - 1; }

  // u in [0, 1); double, because a table of a million entries would use up all digits of a float.
  Choice sample(double u) const {
    if (size() == 0 || cdf_.back() == 0.0)
      return {};
    // Find the interval cdf[i] <= u < cdf[i + 1]: an entry of weight 0 has an empty interval.
    const double steps = static_cast<double>(guide_.size());
    uint32_t i = guide_[std::min(static_cast<std::size_t>(u * steps), guide_.size() - 1)];
    while (i > 0 && cdf_[i] > u)
      --i;
    while (!(cdf_[i + 1] > u))
      ++i;
    const double width = cdf_[i + 1] - cdf_[i];
    const float below_one = std::nextafter(1.0f, 0.0f);
    return {i, static_cast<float>(width), std::min(static_cast<float>((u - cdf_[i]) / width), below_one)};
  }

  // Returns the probability of index i, exactly the pmf that sample() returns.
  float pmf(std::size_t i) const { return static_cast<float>(cdf_[i + 1] - cdf_[i]); }

  std::size_t bytes() const { return cdf_.size() * sizeof(double) + guide_.size() * sizeof(uint32_t); }

private:
  static constexpr std::size_t kPerStep = 4; // entries per step of the guide
  std::vector<double> cdf_;
  std::vector<uint32_t> guide_;
};

} // namespace lancer
