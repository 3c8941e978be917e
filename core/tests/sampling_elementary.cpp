// Elementary functions: accuracy, special values, and bits that must be equal with every processor and compiler.
#include "sampling/elementary.h"

#include "bits_hash.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <ostream>
#include <vector>

namespace lancer {
namespace {

using lancer_test::BitsHash;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Function {
  const char *name;
  float (*of_float)(float);
  double (*of_double)(double);
  double (*library)(double);
  long double (*longer)(long double);
  double units; // error bound of the double function, in units of the last place
  double low, high;
  uint64_t hash;
};

#define LANCER_FUNCTION(name, units, low, high, hash)                                                                          \
  {                                                                                                                            \
#name,                                                                                                                      \
   [](float x) { return lancer::name(x); },                                                                                    \
   [](double x) { return lancer::name(x); },                                                                                   \
   [](double x) { return std::name(x); },                                                                                      \
   [](long double x) { return std::name(x); },                                                                                 \
   units,                                                                                                                      \
   low,                                                                                                                        \
   high,                                                                                                                       \
   hash  \
  }

// Range of uniformly distributed doubles; doubles are also distributed by powers of two.
const Function kFunctions[] = {
    LANCER_FUNCTION(exp, 1.0, -100.0, 100.0, 0x44d47198874190ef), LANCER_FUNCTION(expm1, 3.0, -2.0, 2.0, 0x55b1d5826813de71),
    LANCER_FUNCTION(sinh, 3.0, -3.0, 3.0, 0xced58f17c19afae7),    LANCER_FUNCTION(cosh, 3.0, -3.0, 3.0, 0x50ee5cd862d85e01),
    LANCER_FUNCTION(tanh, 3.0, -3.0, 3.0, 0xbe95ae0485927398),    LANCER_FUNCTION(log, 1.0, 0.25, 4.0, 0x3e06ec8efc3737f3),
    LANCER_FUNCTION(log1p, 1.5, -0.9, 3.0, 0xa67337f2d4d4ddb9),   LANCER_FUNCTION(sin, 1.0, -10.0, 10.0, 0xc6d837a409ee49e7),
    LANCER_FUNCTION(cos, 1.0, -10.0, 10.0, 0x8eced90f2c33051a),   LANCER_FUNCTION(tan, 3.0, -10.0, 10.0, 0x0710bdb433f67d00),
    LANCER_FUNCTION(asin, 3.0, -1.0, 1.0, 0x1b58edd21ace5492),    LANCER_FUNCTION(acos, 3.0, -1.0, 1.0, 0x18b37bd7cacfd14c),
    LANCER_FUNCTION(atan, 3.0, -3.0, 3.0, 0xdd138e3cae0b9217),    LANCER_FUNCTION(erfc, 6.0, -3.0, 26.0, 0x2ce08f70398881b7),
};

void PrintTo(const Function &f, std::ostream *out) { *out << f.name; }

class Elementary : public testing::TestWithParam<Function> {};

// A random number generator of all sizes and both signs, the same everywhere.
class Numbers {
public:
  double even(double low, double high) { return low + (high - low) * (double(next() >> 11) * 0x1p-53); }
  double of_any_size(int lowest, int highest) {
    const double power = std::floor(even(lowest, highest + 1));
    const double size = std::ldexp(even(1.0, 2.0), int(power));
    return next() >> 63 ? -size : size;
  }

private:
  uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ull;
    uint64_t x = state_;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ x >> 27) * 0x94d049bb133111ebull;
    return x ^ x >> 31;
  }
  uint64_t state_ = 0;
};

std::vector<double> arguments(const Function &f) {
  Numbers numbers;
  std::vector<double> result;
  for (int i = 0; i < 20000; ++i) {
    result.push_back(numbers.even(f.low, f.high));
    result.push_back(numbers.of_any_size(-40, 8));
    result.push_back(numbers.of_any_size(-1000, 1000));
  }
  return result;
}

// Floats over the whole range: an odd step reaches every exponent with varying digits.
template <class Use> void over_floats(uint32_t step, Use use) {
  for (uint64_t bits = 0; bits < 1ull << 32; bits += step)
    use(std::bit_cast<float>(uint32_t(bits)));
}

// Half a unit from rounding, and double's own error, which is 2^-29 of a float's unit.
TEST_P(Elementary, FloatsAreTheNearest) {
  const Function &f = GetParam();
  over_floats(16411, [&](float x) {
    const double want = f.library(double(x));
    const float got = f.of_float(x), nearest = float(want);
    if (std::isnan(want)) {
      EXPECT_TRUE(std::isnan(got)) << f.name << " of " << x;
      return;
    }
    if (got == nearest)
      return;
    const double unit = std::ldexp(1.0, std::max(std::ilogb(want), -126) - 23);
    EXPECT_LE(std::abs(double(got) - want), 0.500001 * unit) << f.name << " of " << x;
  });
}

TEST_P(Elementary, DoublesAreWithinTheirUnits) {
  const Function &f = GetParam();
  // If long double has no more digits, the library's own error is up to a unit.
  const double units = f.units + (LDBL_MANT_DIG > DBL_MANT_DIG ? 0.01 : 1.0);
  for (const double x : arguments(f)) {
    const long double want = f.longer(static_cast<long double>(x));
    const double got = f.of_double(x), nearest = double(want);
    if (got == nearest || (std::isnan(got) && std::isnan(nearest)) || std::abs(want) < std::numeric_limits<double>::min())
      continue;
    const double unit = std::ldexp(1.0, std::ilogb(nearest) - 52);
    EXPECT_LE(double(std::abs(static_cast<long double>(got) - want)), units * unit) << f.name << " of " << x;
  }
}

TEST_P(Elementary, TheSameBitsEverywhere) {
  const Function &f = GetParam();
  BitsHash hash;
  // NaN has many representations.
  over_floats(65521, [&](float x) { hash.add(std::isnan(f.of_float(x)) ? 0.0f : f.of_float(x)); });
  for (const double x : arguments(f))
    hash.add(std::isnan(f.of_double(x)) ? 0.0 : f.of_double(x));
  EXPECT_EQ(hash.value(), f.hash) << f.name;
}

INSTANTIATE_TEST_SUITE_P(All, Elementary, testing::ValuesIn(kFunctions),
                         [](const testing::TestParamInfo<Function> &f) { return f.param.name; });

void expect_bits(double got, double want, const char *what) {
  if (std::isnan(want))
    EXPECT_TRUE(std::isnan(got)) << what;
  else
    EXPECT_EQ(std::bit_cast<uint64_t>(got), std::bit_cast<uint64_t>(want)) << what << " " << got << " " << want;
}

TEST(ElementaryFunctions, SpecialValuesOfTheStandard) {
  const struct {
    const char *what;
    double got, want;
  } values[] = {{"exp inf", exp(kInfinity), kInfinity},
                {"exp -inf", exp(-kInfinity), 0.0},
                {"exp 0", exp(-0.0), 1.0},
                {"exp large", exp(709.9), kInfinity},
                {"exp small", exp(-745.2), 0.0},
                {"exp least", exp(-745.0), 0x1p-1074},
                {"exp none", exp(kNone), kNone},
                {"expm1 -0", expm1(-0.0), -0.0},
                {"expm1 -inf", expm1(-kInfinity), -1.0},
                {"expm1 inf", expm1(kInfinity), kInfinity},
                {"sinh -0", sinh(-0.0), -0.0},
                {"sinh -inf", sinh(-kInfinity), -kInfinity},
                {"cosh -inf", cosh(-kInfinity), kInfinity},
                {"tanh -0", tanh(-0.0), -0.0},
                {"tanh -inf", tanh(-kInfinity), -1.0},
                {"tanh none", tanh(kNone), kNone},
                {"log 1", log(1.0), 0.0},
                {"log -0", log(-0.0), -kInfinity},
                {"log -1", log(-1.0), kNone},
                {"log inf", log(kInfinity), kInfinity},
                {"log none", log(kNone), kNone},
                {"log1p -0", log1p(-0.0), -0.0},
                {"log1p -1", log1p(-1.0), -kInfinity},
                {"log1p -2", log1p(-2.0), kNone},
                {"log1p inf", log1p(kInfinity), kInfinity},
                {"sin -0", sin(-0.0), -0.0},
                {"sin inf", sin(kInfinity), kNone},
                {"cos 0", cos(-0.0), 1.0},
                {"cos none", cos(kNone), kNone},
                {"tan -0", tan(-0.0), -0.0},
                {"tan -inf", tan(-kInfinity), kNone},
                {"asin -0", asin(-0.0), -0.0},
                {"asin 1", asin(1.0), 0x1.921fb54442d18p+0},
                {"asin 1.1", asin(1.1), kNone},
                {"acos 1", acos(1.0), 0.0},
                {"acos -1", acos(-1.0), 0x1.921fb54442d18p+1},
                {"acos none", acos(kNone), kNone},
                {"atan -0", atan(-0.0), -0.0},
                {"atan -inf", atan(-kInfinity), -0x1.921fb54442d18p+0},
                {"atan2 0 -0", atan2(0.0, -0.0), 0x1.921fb54442d18p+1},
                {"atan2 -0 -1", atan2(-0.0, -1.0), -0x1.921fb54442d18p+1},
                {"atan2 -0 1", atan2(-0.0, 1.0), -0.0},
                {"atan2 inf -inf", atan2(kInfinity, -kInfinity), 0x1.2d97c7f3321d2p+1},
                {"atan2 1 -inf", atan2(1.0, -kInfinity), 0x1.921fb54442d18p+1},
                {"atan2 -1 inf", atan2(-1.0, kInfinity), -0.0},
                {"atan2 least", atan2(0x1p-1074, 0x1p-1073), 0x1.dac670561bb4fp-2},
                {"atan2 large", atan2(0x1p1023, 0x1p1023), 0x1.921fb54442d18p-1},
                {"hypot none inf", hypot(kNone, -kInfinity), kInfinity},
                {"hypot large", hypot(0x1.8p1022, 0x1p1023), 0x1.4p1023},
                {"hypot least", hypot(0x3p-1074, 0x4p-1074), 0x5p-1074},
                {"erf -inf", erf(-kInfinity), -1.0},
                {"erf -0", erf(-0.0), -0.0},
                {"erfc -inf", erfc(-kInfinity), 2.0},
                {"erfc inf", erfc(kInfinity), 0.0},
                {"erfc none", erfc(kNone), kNone}};
  for (const auto &value : values)
    expect_bits(value.got, value.want, value.what);
}

TEST(ElementaryFunctions, PowersOfTheStandard) {
  constexpr float inf = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
  constexpr float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
  const float values[] = {0.0f, -0.0f, 1.0f,  -1.0f,  0.5f, -0.5f, 2.0f,    -2.0f,    3.0f,        -3.0f,       inf,
                          -inf, none,  least, -least, most, -most, 0x1p24f, -0x1p24f, 16777215.0f, -16777215.0f};
  for (const float x : values)
    for (const float y : values) {
      const float got = lancer::pow(x, y), want = std::pow(x, y);
      EXPECT_EQ(std::isnan(got), std::isnan(want)) << x << " " << y;
      if (!std::isnan(want)) {
        EXPECT_EQ(std::bit_cast<uint32_t>(got), std::bit_cast<uint32_t>(want)) << x << " " << y << " " << got << " " << want;
      }
    }
}

// Half a unit from rounding, and double's 2^-46 of a product of at most 104: 2^-22 of a float's unit.
TEST(ElementaryFunctions, PowersAreTheNearest) {
  Numbers numbers;
  BitsHash hash;
  for (int i = 0; i < 200000; ++i) {
    const float x = std::abs(float(numbers.of_any_size(i % 2 ? -2 : -120, i % 2 ? 2 : 120)));
    const float y = float(numbers.of_any_size(-8, i % 2 ? 8 : 3));
    const float got = lancer::pow(x, y);
    const double want = std::pow(double(x), double(y));
    hash.add(got);
    if (got != float(want)) {
      const double unit = std::ldexp(1.0, std::max(std::ilogb(want), -126) - 23);
      EXPECT_LE(std::abs(double(got) - want), 0.500001 * unit) << x << " " << y;
    }
  }
  EXPECT_EQ(hash.value(), 0xc32489f40023ba2cu);
}

TEST(ElementaryFunctions, OfTwoNumbers) {
  Numbers numbers;
  BitsHash hash;
  const double more = LDBL_MANT_DIG > DBL_MANT_DIG ? 0.01 : 1.0;
  for (int i = 0; i < 100000; ++i) {
    const int reach = i % 2 ? 3 : 500;
    const double x = numbers.of_any_size(-reach, reach), y = numbers.of_any_size(-reach, reach);
    const double arc = lancer::atan2(y, x), side = lancer::hypot(x, y);
    hash.add(arc);
    hash.add(side);
    const long double wide_x = x, wide_y = y, want_arc = std::atan2(wide_y, wide_x), want_side = std::hypot(wide_x, wide_y);
    const auto units = [](double got, long double want) {
      return double(std::abs(got - want)) / std::ldexp(1.0, std::ilogb(double(want)) - 52);
    };
    if (std::abs(double(want_arc)) >= std::numeric_limits<double>::min()) {
      EXPECT_LE(units(arc, want_arc), 3.0 + more) << y << " " << x;
    }
    EXPECT_LE(units(side, want_side), 1.5 + more) << x << " " << y;
  }
  EXPECT_EQ(hash.value(), 0x08abbc948fe76c17u);
}

TEST(ElementaryFunctions, TheErrorFunction) {
  Numbers numbers;
  const double units = 1.5 + (LDBL_MANT_DIG > DBL_MANT_DIG ? 0.01 : 1.0);
  for (int i = 0; i < 60000; ++i) {
    const double x = i % 2 ? numbers.even(-6.0, 6.0) : numbers.of_any_size(-60, 3);
    const long double want = std::erf(static_cast<long double>(x));
    const double unit = std::ldexp(1.0, std::ilogb(double(want)) - 52);
    EXPECT_LE(double(std::abs(lancer::erf(x) - want)), units * unit) << x;
  }
}

// To 800 digits, rounded. The second is nearer to a multiple of pi / 2 than any other double.
TEST(ElementaryFunctions, SineAndCosineOfLargeAngles) {
  const double values[][3] = {
      {0x1.0f0cf064dd592p+73, -0x1.b453ab76bf397p-1, 0x1.0be2cef01c8f4p-1},
      {0x1.6ac5b262ca1ffp+849, 0x1p+0, -0x1.14ae72e6ba22fp-61},
      {0x1p+1000, -0x1.460b8ae1c886ep-3, 0x1.f9785160c8815p-1},
      {0x1.fffffffffffffp+1023, 0x1.452fc98b34e97p-8, -0x1.fffe62ecfab75p-1},
      {0x1.93e5939a08ceap+99, 0x1.31c608f107767p-7, -0x1.fffa4b11f1b45p-1},
      {0x1.6p+3, -0x1.fffeb762e93ebp-1, 0x1.220ae41ee2fdfp-8},
      {0x1.921fb54442d18p+0, 0x1p+0, 0x1.1a62633145c07p-54},
      {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53, -0x1p+0},
      {0x1.86a0p+16, 0x1.24daa9c527e96p-5, -0x1.ffac3841b3da7p-1},
      {0x1p+20, 0x1.526ccb2fc8656p-2, 0x1.e33ada92fe2aep-1},
  };
  for (const auto &v : values) {
    const auto within = [](double got, double want) {
      // A unit, and half of one from the rounding of the expected value.
      return std::abs(got - want) <= 1.5 * std::ldexp(1.0, std::ilogb(want) - 52);
    };
    EXPECT_PRED2(within, lancer::sin(v[0]), v[1]) << v[0];
    EXPECT_PRED2(within, lancer::cos(v[0]), v[2]) << v[0];
    EXPECT_EQ(lancer::sin(-v[0]), -lancer::sin(v[0]));
    EXPECT_EQ(lancer::cos(-v[0]), lancer::cos(v[0]));
  }
}

TEST(ElementaryFunctions, NeverFallWhereTheyRise) {
  float (*const rising[])(float) = {[](float x) { return lancer::exp(x); },  [](float x) { return lancer::expm1(x); },
                                    [](float x) { return lancer::sinh(x); }, [](float x) { return lancer::tanh(x); },
                                    [](float x) { return lancer::atan(x); }, [](float x) { return lancer::asin(x); },
                                    [](float x) { return lancer::log(x); },  [](float x) { return lancer::log1p(x); }};
  for (const auto f : rising)
    over_floats(40009, [&](float x) {
      const float next = std::nextafter(x, std::numeric_limits<float>::infinity());
      if (!std::isnan(f(x)) && !std::isnan(f(next))) {
        EXPECT_LE(f(x), f(next)) << x;
      }
    });
}

} // namespace
} // namespace lancer
