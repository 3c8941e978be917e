// On which side of a triangle's edges a ray passes that meets one exactly. It passes by one of them, whichever triangle asks:
// of all triangles around an edge or a corner one is met for each time that their surface is crossed.
// Plain doubles and forced inlining, as in object_ray.h.
#pragma once

#include "accel/object_ray.h"

namespace lancer {

// a b = product + rest, exactly, by Veltkamp's splitting.
LANCER_INLINE double rest_of_product(double a, double b, double product) {
  const double sa = 134217729.0 * a, sb = 134217729.0 * b;
  const double high_a = sa - (sa - a), high_b = sb - (sb - b), low_a = a - high_a, low_b = b - high_b;
  return ((high_a * high_b - product) + high_a * low_b + low_a * high_b) + low_a * low_b;
}

// a b - c d, to its last digit.
LANCER_INLINE double difference_of_products(double a, double b, double c, double d) {
  const double p = a * b, q = c * d;
  return (p - q) + (rest_of_product(a, b, p) - rest_of_product(c, d, q));
}

// Whether the origin lies within a triangle with the corners (x, y), where a few of its edge functions w have rounded to zero;
// w[i] = x[k] y[j] - y[k] x[j] with the corners j and k after i. What is not zero exactly gets its digits. Where the origin is
// on an edge the ray is taken to pass beside it: by a next to nothing towards +x, and by next to nothing of that towards +y.
LANCER_INLINE bool within_edges(const double x[3], const double y[3], double w[3]) {
  int sides = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1, k = j == 2 ? 0 : j + 1;
    // Both products have rounded to the same number: their rests differ, or nothing does.
    if (w[i] == 0.0)
      w[i] = difference_of_products(x[k], y[j], y[k], x[j]);
    const double side = w[i] != 0.0 ? w[i] : y[k] != y[j] ? y[k] - y[j] : x[j] - x[k];
    sides += (side > 0.0) - (side < 0.0);
  }
  return sides == 3 || sides == -3;
}

// a + b + c whatever their order: the same bits.
LANCER_INLINE double sum_in_any_order(double a, double b, double c) {
  const double low = a < b ? a : b, high = a > b ? a : b;
  const double lowest = low < c ? low : c, highest = high > c ? high : c, below = high < c ? high : c;
  return (lowest + highest) + (low > below ? low : below);
}

} // namespace lancer
