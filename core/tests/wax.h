// Surfaces that light enters, and means of pictures with their standard errors.
#pragma once

#include "picture_lab.h"
#include "statistics.h"

#include <cmath>

namespace lancer_test {

inline lancer_lobe wax(uint32_t method, float color, float radius, float g = 0.0f, float roughness = 1.0f) {
  lancer_lobe result = lobe(LANCER_SUBSURFACE, color, roughness);
  result.rules = LANCER_RULES_BLENDER_52;
  result.option = method;
  result.edge = constant(radius);
  result.anisotropy = constant(g);
  result.ior = constant(1.4f);
  return result;
}

struct Mean {
  double value, error; // and its standard error
};

// Returns the mean of the red channel, whose pixels are independent and have one expectation.
inline Mean mean_of(const std::vector<float> &pixels) {
  double sum = 0.0, squares = 0.0;
  const double count = double(pixels.size() / 4);
  for (size_t i = 0; i < pixels.size(); i += 4) {
    sum += double(pixels[i]);
    squares += double(pixels[i]) * double(pixels[i]);
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

// Returns how probable it is that means of one expectation are as far apart. bias: by which the expectations may differ.
inline double same_mean_p_value(const Mean &a, const Mean &b, double bias = 0.0) {
  const double apart = std::max(std::abs(a.value - b.value) - bias, 0.0);
  return apart == 0.0 ? 1.0 : lancer::testing::normal_p_value(apart / std::hypot(a.error, b.error));
}

} // namespace lancer_test
