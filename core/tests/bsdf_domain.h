// Parametrisations of directions by the unit square, to count densities in cells and integrate them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>

namespace lancer::testing {

using SquareFunction = std::function<double(const glm::dvec2 &)>;

// Gauss-Legendre with 5 x 5 nodes over a rectangle.
inline double gauss_square(const SquareFunction &f, glm::dvec2 low, glm::dvec2 high) {
  static constexpr std::array<double, 5> node{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                              0.9061798459386640};
  static constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                                0.2369268850561891};
  const glm::dvec2 middle = 0.5 * (low + high), radius = 0.5 * (high - low);
  double sum = 0.0;
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j)
      sum += weight[i] * weight[j] * f(middle + radius * glm::dvec2(node[i], node[j]));
  return sum * radius.x * radius.y;
}

// Limits of the subdivision: the noise of a float function, and a maximum depth.
struct Refinement {
  double noise = 0x1p-16;
  int deepest = 7;
};

// Halves both axes until four quarters agree with the whole.
inline double refine_square(const SquareFunction &f, glm::dvec2 low, glm::dvec2 high, double tolerance, double whole,
                            const Refinement &refinement, int depth = 0) {
  const glm::dvec2 middle = 0.5 * (low + high);
  const glm::dvec2 corner[4] = {low, {middle.x, low.y}, {low.x, middle.y}, middle};
  double part[4], sum = 0.0;
  for (int i = 0; i < 4; ++i)
    sum += part[i] = gauss_square(f, corner[i], corner[i] + middle - low);
  if (depth >= refinement.deepest || std::abs(sum - whole) <= std::max(tolerance, refinement.noise * std::abs(sum)))
    return sum;
  sum = 0.0;
  for (int i = 0; i < 4; ++i)
    sum += refine_square(f, corner[i], corner[i] + middle - low, 0.5 * tolerance, part[i], refinement, depth + 1);
  return sum;
}

// Starts from cells x cells, so that no narrow peak falls between the nodes of the first estimate.
inline double integrate_square(const SquareFunction &f, int cells, double tolerance, glm::dvec2 low = glm::dvec2(0.0),
                               glm::dvec2 high = glm::dvec2(1.0), const Refinement &refinement = {}) {
  const glm::dvec2 size = (high - low) / static_cast<double>(cells);
  double sum = 0.0;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      const glm::dvec2 corner = low + size * glm::dvec2(i, j);
      sum += refine_square(f, corner, corner + size, tolerance, gauss_square(f, corner, corner + size), refinement);
    }
  return sum;
}

inline double turn(double y, double x) { return std::atan2(y, x) / (2.0 * std::numbers::pi) + 0.5; }

// A parametrisation of directions wi on one side of the plane, by default the upper one. density converts a function per solid
// angle of wi to one per area of the square.
struct Domain {
  std::function<glm::dvec2(const glm::vec3 &)> place;
  std::function<SquareFunction(const std::function<double(const glm::vec3 &)> &)> density;
};

// Height and azimuth: the horizon is an edge of the square. For lobes that are wide or end at the horizon.
inline Domain direction_domain() {
  return {[](const glm::vec3 &wi) { return glm::dvec2(wi.z, turn(wi.y, wi.x)); },
          [](const std::function<double(const glm::vec3 &)> &f) -> SquareFunction {
            return [f](const glm::dvec2 &place) {
              const double sine = std::sqrt((1.0 - place.x) * (1.0 + place.x)), phi = 2.0 * std::numbers::pi * (place.y - 0.5);
              return 2.0 * std::numbers::pi * f(glm::vec3(glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), place.x)));
            };
          }};
}

// The half vector's slope in polar form, which resolves a microfacet lobe of any width. Half of the square's x is for slopes r
// up to about scale, half for all others: x = (r / (r + scale) + r / (r + 1)) / 2.
inline double slope_to_x(double r, double scale) { return 0.5 * (r / (r + scale) + r / (r + 1.0)); }

// Returns the half vector at a place; jacobian: solid angle of half vectors per area of the square.
inline glm::dvec3 half_vector_at(const glm::dvec2 &place, double scale, double &jacobian) {
  const double phi = 2.0 * std::numbers::pi * (place.y - 0.5);
  // x(r) is a quadratic equation in r; its positive root without cancellation.
  const double a = 2.0 * (1.0 - place.x), b = (1.0 + scale) * (1.0 - 2.0 * place.x), c = 2.0 * place.x * scale;
  const double root = std::sqrt(b * b + 4.0 * a * c);
  const double r = b > 0.0 ? 2.0 * c / (b + root) : (root - b) / (2.0 * a);
  const double dx_dr = 0.5 * (scale / ((r + scale) * (r + scale)) + 1.0 / ((r + 1.0) * (r + 1.0)));
  const double cos_h = 1.0 / std::sqrt(1.0 + r * r);
  jacobian = cos_h * cos_h * cos_h * r / dx_dr * 2.0 * std::numbers::pi;
  return {r * std::cos(phi) * cos_h, r * std::sin(phi) * cos_h, cos_h};
}

inline Domain half_vector_domain(const glm::vec3 &wo_float, double scale) {
  const glm::dvec3 wo(wo_float);
  return {[wo, scale](const glm::vec3 &wi) {
            const glm::dvec3 h = wo + glm::dvec3(wi);
            return glm::dvec2(slope_to_x(std::hypot(h.x, h.y) / h.z, scale), turn(h.y, h.x));
          },
          [wo, scale](const std::function<double(const glm::vec3 &)> &f) -> SquareFunction {
            return [wo, scale, f](const glm::dvec2 &place) {
              double jacobian;
              const glm::dvec3 h = half_vector_at(place, scale, jacobian);
              const double cos_oh = glm::dot(wo, h);
              const glm::dvec3 wi = 2.0 * cos_oh * h - wo;
              // The solid angle of wi is 4 wo.h times that of half vectors.
              return cos_oh > 0.0 && wi.z > 0.0 ? jacobian * 4.0 * cos_oh * f(glm::vec3(wi)) : 0.0;
            };
          }};
}

// Directions below the plane, by the facet that refracts wo into them.
inline Domain bent_domain(const glm::vec3 &wo_float, double scale, double eta) {
  const glm::dvec3 wo(wo_float);
  return {[wo, scale, eta](const glm::vec3 &wi) {
            glm::dvec3 h = wo + eta * glm::dvec3(wi);
            if (h.z < 0.0)
              h = -h;
            return glm::dvec2(slope_to_x(std::hypot(h.x, h.y) / h.z, scale), turn(h.y, h.x));
          },
          [wo, scale, eta](const std::function<double(const glm::vec3 &)> &f) -> SquareFunction {
            return [wo, scale, eta, f](const glm::dvec2 &place) {
              double jacobian;
              const glm::dvec3 h = half_vector_at(place, scale, jacobian);
              const double cos_oh = glm::dot(wo, h), cos2_t = 1.0 - (1.0 - cos_oh * cos_oh) / (eta * eta);
              if (!(cos_oh > 0.0 && cos2_t > 0.0))
                return 0.0;
              const glm::dvec3 wi = (cos_oh / eta - std::sqrt(cos2_t)) * h - wo / eta;
              const double cos_ih = glm::dot(wi, h), sum = cos_oh + eta * cos_ih;
              // Ratio of the solid angle of wi to that of half vectors.
              return wi.z < 0.0 ? jacobian * sum * sum / (eta * eta * -cos_ih) * f(glm::vec3(wi)) : 0.0;
            };
          }};
}

// Height below the plane, and azimuth.
inline Domain below_domain() {
  const Domain above = direction_domain();
  const glm::vec3 flip(1.0f, 1.0f, -1.0f);
  return {[above, flip](const glm::vec3 &wi) { return above.place(wi * flip); },
          [above, flip](const std::function<double(const glm::vec3 &)> &f) {
            return above.density([f, flip](const glm::vec3 &wi) { return f(wi * flip); });
          }};
}

} // namespace lancer::testing
