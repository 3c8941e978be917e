// Directions laid out on a square in which a lobe is resolved however narrow it is: the half vector's slope in polar form.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>

namespace lancer::testing {

// Coordinates (q, phi) in [0, 1)^2 of the half vector of wo and wi. Half of q is spent on slopes up to about scale, the lobe's
// width, half on all others: q = (r / (r + scale) + r / (r + 1)) / 2 for the slope r.
class HalfVectorDomain {
public:
  HalfVectorDomain(const glm::vec3 &wo, double scale) : wo_(wo), scale_(scale) {}

  glm::dvec2 to_square(const glm::vec3 &wi) const { return half_to_square(wo_ + glm::dvec3(wi)); }

  glm::dvec2 half_to_square(const glm::dvec3 &h) const {
    const double r = std::hypot(h.x, h.y) / h.z;
    const double q = 0.5 * (r / (r + scale_) + r / (r + 1.0));
    return {q, std::atan2(-h.y, -h.x) / (2.0 * std::numbers::pi) + 0.5};
  }

  // The half vector at a place and the solid angle of half vectors per area there.
  glm::dvec3 half(const glm::dvec2 &place, double &jacobian) const {
    const double q = place.x, phi = 2.0 * std::numbers::pi * (place.y - 0.5);
    // q(r) is a quadratic equation in r; its positive root without cancellation.
    const double a = 2.0 * (1.0 - q), b = (1.0 + scale_) * (1.0 - 2.0 * q), c = 2.0 * q * scale_;
    const double root = std::sqrt(b * b + 4.0 * a * c);
    const double r = b > 0.0 ? 2.0 * c / (b + root) : (root - b) / (2.0 * a);
    const double dq_dr = 0.5 * (scale_ / ((r + scale_) * (r + scale_)) + 1.0 / ((r + 1.0) * (r + 1.0)));
    const double cos_h = 1.0 / std::sqrt(1.0 + r * r);
    jacobian = cos_h * cos_h * cos_h * r / dq_dr * 2.0 * std::numbers::pi;
    return {-r * std::cos(phi) * cos_h, -r * std::sin(phi) * cos_h, cos_h};
  }

  // Integral over a rectangle of the square of a function of half vectors (per solid angle of h).
  double integrate_half(const std::function<double(const glm::dvec3 &)> &f, glm::dvec2 low, glm::dvec2 high, double tolerance) const {
    return refine(f, low, high, tolerance, gauss(f, low, high), 0);
  }

  // The same for a function of wi (per solid angle of wi), which is 0 below the horizon.
  double integrate(const std::function<double(const glm::vec3 &)> &f, glm::dvec2 low, glm::dvec2 high, double tolerance) const {
    const auto over_half = [&](const glm::dvec3 &h) {
      const double cos_oh = glm::dot(wo_, h);
      const glm::dvec3 wi = 2.0 * cos_oh * h - wo_;
      return cos_oh > 0.0 && wi.z > 0.0 ? 4.0 * cos_oh * f(glm::vec3(wi)) : 0.0;
    };
    return integrate_half(over_half, low, high, tolerance);
  }

  double integrate(const std::function<double(const glm::vec3 &)> &f, double tolerance) const {
    // Start from cells, so that no narrow peak falls between the nodes of the first guess.
    constexpr int cells = 16;
    double sum = 0.0;
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j)
        sum += integrate(f, glm::dvec2(i, j) / double{cells}, glm::dvec2(i + 1, j + 1) / double{cells}, tolerance / cells);
    return sum;
  }

private:
  // Gauss-Legendre with 5 x 5 nodes.
  double gauss(const std::function<double(const glm::dvec3 &)> &f, glm::dvec2 low, glm::dvec2 high) const {
    static constexpr std::array<double, 5> node{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
    static constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                                  0.2369268850561891};
    const glm::dvec2 middle = 0.5 * (low + high), radius = 0.5 * (high - low);
    double sum = 0.0;
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = 0; j < 5; ++j) {
        double jacobian;
        const glm::dvec3 h = half(middle + radius * glm::dvec2(node[i], node[j]), jacobian);
        sum += weight[i] * weight[j] * jacobian * f(h);
      }
    return sum * radius.x * radius.y;
  }

  // Halve both ways until four quarters agree with the whole, at best to the noise of a float function.
  double refine(const std::function<double(const glm::dvec3 &)> &f, glm::dvec2 low, glm::dvec2 high, double tolerance, double whole,
                int depth) const {
    const glm::dvec2 middle = 0.5 * (low + high);
    const std::array<std::array<glm::dvec2, 2>, 4> quarters{{{low, middle},
                                                              {glm::dvec2(middle.x, low.y), glm::dvec2(high.x, middle.y)},
                                                              {glm::dvec2(low.x, middle.y), glm::dvec2(middle.x, high.y)},
                                                              {middle, high}}};
    std::array<double, 4> parts;
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += parts[i] = gauss(f, quarters[i][0], quarters[i][1]);
    if (depth >= 9 || std::abs(sum - whole) <= std::max(tolerance, 0x1p-18 * std::abs(sum)))
      return sum;
    sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += refine(f, quarters[i][0], quarters[i][1], 0.5 * tolerance, parts[i], depth + 1);
    return sum;
  }

  glm::dvec3 wo_;
  double scale_;
};

} // namespace lancer::testing
