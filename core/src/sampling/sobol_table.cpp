// The generator matrices behind the table, from the published direction numbers; all of it is computed by the compiler.
#include "sampling/scramble.h"

namespace lancer::sobol {
namespace {

// A primitive polynomial over GF(2) of the given degree (inner coefficients as bits) and the first direction numbers m.
struct Polynomial {
  uint32_t degree, coefficients;
  uint32_t m[6];
};

// Joe and Kuo 2008, criterion D(6), dimensions 2 to 16; the first dimension is the van der Corput sequence.
constexpr Polynomial kPolynomials[kJointDimensions - 1] = {
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
};

// Columns of the generator matrix of one dimension, bit 0 being the first digit after the binary point.
constexpr std::array<uint32_t, 32> reversed_columns(uint32_t dimension) {
  std::array<uint32_t, 32> column{};
  if (dimension == 0) {
    for (uint32_t k = 0; k < 32; ++k)
      column[k] = 1u << k;
    return column;
  }
  const Polynomial &p = kPolynomials[dimension - 1];
  std::array<uint32_t, 32> v{};
  for (uint32_t k = 0; k < 32; ++k) {
    if (k < p.degree) {
      v[k] = p.m[k] << (31 - k);
    } else {
      v[k] = v[k - p.degree] ^ v[k - p.degree] >> p.degree;
      for (uint32_t j = 1; j < p.degree; ++j)
        if (p.coefficients >> (p.degree - 1 - j) & 1)
          v[k] ^= v[k - j];
    }
    column[k] = reverse_bits(v[k]);
  }
  return column;
}

constexpr NibbleTable make_nibble_table() {
  NibbleTable table{};
  for (uint32_t d = 0; d < kJointDimensions; ++d) {
    const std::array<uint32_t, 32> column = reversed_columns(d);
    for (uint32_t group = 0; group < 8; ++group)
      for (uint32_t value = 0; value < 16; ++value)
        for (uint32_t bit = 0; bit < 4; ++bit)
          if (value >> bit & 1)
            table[d][group][value] ^= column[4 * group + bit];
  }
  return table;
}

} // namespace

constinit const NibbleTable kNibbles = make_nibble_table();

} // namespace lancer::sobol
