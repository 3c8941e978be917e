// The inverse of the error function: turns a uniform number into a Gaussian one.
#pragma once

#include "sampling/elementary.h"

namespace lancer {

// Relative error below 4e-7 for |y| < 1. Giles, "Approximating the erfinv function", GPU Computing Gems 2, 2010.
template <class F> LANCER_LANE F erf_inverse(F y) {
  const F w = -log((1.0f - y) * (1.0f + y));
  const auto polynomial = [](F x, const float(&c)[9]) __attribute__((always_inline)) {
    F p = F(c[0]);
    for (int i = 1; i < 9; ++i)
      p = c[i] + p * x;
    return p;
  };
  constexpr float middle[9] = {2.81022636e-08f, 3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f, 0.00021858087f,
                               -0.00125372503f, -0.00417768164f, 0.246640727f,    1.50140941f};
  constexpr float tail[9] = {-0.000200214257f, 0.000100950558f, 0.00134934322f, -0.00367342844f, 0.00573950773f,
                             -0.0076224613f,   0.00943887047f,  1.00167406f,    2.83297682f};
  return select(w < 5.0f, polynomial(w - 2.5f, middle), polynomial(sqrt(w) - 3.0f, tail)) * y;
}

} // namespace lancer
