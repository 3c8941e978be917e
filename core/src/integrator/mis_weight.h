// How much a sample counts that another technique might have found, too.
#pragma once

namespace lancer {

// The power heuristic in ratio form: infinite densities give 0 or 1, never NaN.
inline float mis_weight(double pdf, double other) {
  const double ratio = other / pdf;
  return float(1.0 / (1.0 + ratio * ratio));
}

} // namespace lancer
