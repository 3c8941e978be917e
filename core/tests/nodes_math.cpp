// Math, Vector Math, Mapping and the colour nodes against closed forms in double, over pairs of values with all signs.
#include "nodes_lab.h"

#include "nodes/math_nodes.h"

#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>

using namespace lancer_test;

namespace {

const std::vector<float> kValues = {-2.75f, -1.0f, -0.5f, 0.0f, 0.25f, 0.5f, 1.0f, 1.5f, 3.25f};

using Scalar = std::function<double(double, double, double)>;

double fraction(double a) { return a - std::floor(a); }

// The definitions in Blender's manual, in double.
std::map<uint32_t, Scalar> scalar_functions() {
  const double pi = glm::pi<double>();
  const auto smooth_min = [](double a, double b, double k) {
    const double h = k == 0.0 ? 0.0 : std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * h * k / 6.0;
  };
  return {
      {LANCER_MATH_ADD, [](double a, double b, double) { return a + b; }},
      {LANCER_MATH_SUBTRACT, [](double a, double b, double) { return a - b; }},
      {LANCER_MATH_MULTIPLY, [](double a, double b, double) { return a * b; }},
      {LANCER_MATH_DIVIDE, [](double a, double b, double) { return b == 0.0 ? 0.0 : a / b; }},
      {LANCER_MATH_MULTIPLY_ADD, [](double a, double b, double c) { return a * b + c; }},
      {LANCER_MATH_POWER,
       [](double a, double b, double) {
         if (b == 0.0)
           return 1.0;
         return a == 0.0 || (a < 0.0 && b != std::floor(b)) ? 0.0 : std::pow(a, b);
       }},
      {LANCER_MATH_LOGARITHM,
       [](double a, double b, double) { return a <= 0.0 || b <= 0.0 || b == 1.0 ? 0.0 : std::log(a) / std::log(b); }},
      {LANCER_MATH_SQRT, [](double a, double, double) { return a > 0.0 ? std::sqrt(a) : 0.0; }},
      {LANCER_MATH_INVERSE_SQRT, [](double a, double, double) { return a > 0.0 ? 1.0 / std::sqrt(a) : 0.0; }},
      {LANCER_MATH_ABSOLUTE, [](double a, double, double) { return std::abs(a); }},
      {LANCER_MATH_EXPONENT, [](double a, double, double) { return std::exp(a); }},
      {LANCER_MATH_MINIMUM, [](double a, double b, double) { return std::min(a, b); }},
      {LANCER_MATH_MAXIMUM, [](double a, double b, double) { return std::max(a, b); }},
      {LANCER_MATH_LESS_THAN, [](double a, double b, double) { return a < b ? 1.0 : 0.0; }},
      {LANCER_MATH_GREATER_THAN, [](double a, double b, double) { return a > b ? 1.0 : 0.0; }},
      {LANCER_MATH_SIGN, [](double a, double, double) { return double((a > 0.0) - (a < 0.0)); }},
      {LANCER_MATH_COMPARE, [](double a, double b, double c) { return std::abs(a - b) <= std::max(c, 0x1p-23) ? 1.0 : 0.0; }},
      {LANCER_MATH_SMOOTH_MIN, smooth_min},
      {LANCER_MATH_SMOOTH_MAX, [=](double a, double b, double c) { return -smooth_min(-a, -b, c); }},
      {LANCER_MATH_ROUND, [](double a, double, double) { return std::floor(a + 0.5); }},
      {LANCER_MATH_FLOOR, [](double a, double, double) { return std::floor(a); }},
      {LANCER_MATH_CEIL, [](double a, double, double) { return std::ceil(a); }},
      {LANCER_MATH_TRUNC, [](double a, double, double) { return a < 0.0 ? -std::floor(-a) : std::floor(a); }},
      {LANCER_MATH_FRACT, [](double a, double, double) { return fraction(a); }},
      {LANCER_MATH_MODULO, [](double a, double b, double) { return b == 0.0 ? 0.0 : std::fmod(a, b); }},
      {LANCER_MATH_FLOORED_MODULO, [](double a, double b, double) { return b == 0.0 ? 0.0 : a - std::floor(a / b) * b; }},
      {LANCER_MATH_WRAP, [](double a, double b, double c) { return b == c ? c : c + (b - c) * fraction((a - c) / (b - c)); }},
      {LANCER_MATH_SNAP, [](double a, double b, double) { return b == 0.0 ? 0.0 : std::floor(a / b) * b; }},
      {LANCER_MATH_PINGPONG,
       [](double a, double b, double) { return b == 0.0 ? 0.0 : std::abs(fraction((a - b) / (2.0 * b)) * 2.0 * b - b); }},
      {LANCER_MATH_SINE, [](double a, double, double) { return std::sin(a); }},
      {LANCER_MATH_COSINE, [](double a, double, double) { return std::cos(a); }},
      {LANCER_MATH_TANGENT, [](double a, double, double) { return std::tan(a); }},
      {LANCER_MATH_ARCSINE, [](double a, double, double) { return std::asin(std::clamp(a, -1.0, 1.0)); }},
      {LANCER_MATH_ARCCOSINE, [](double a, double, double) { return std::acos(std::clamp(a, -1.0, 1.0)); }},
      {LANCER_MATH_ARCTANGENT, [](double a, double, double) { return std::atan(a); }},
      {LANCER_MATH_ARCTAN2, [](double a, double b, double) { return a == 0.0 && b == 0.0 ? 0.0 : std::atan2(a, b); }},
      {LANCER_MATH_SINH, [](double a, double, double) { return std::sinh(a); }},
      {LANCER_MATH_COSH, [](double a, double, double) { return std::cosh(a); }},
      {LANCER_MATH_TANH, [](double a, double, double) { return std::tanh(a); }},
      {LANCER_MATH_RADIANS, [=](double a, double, double) { return a * pi / 180.0; }},
      {LANCER_MATH_DEGREES, [=](double a, double, double) { return a * 180.0 / pi; }},
  };
}

TEST(NodesMath, EveryOperation) {
  const auto functions = scalar_functions();
  ASSERT_EQ(functions.size(), size_t(LANCER_MATH_COUNT));
  Stage stage;
  for (const auto &[operation, function] : functions)
    for (const float a : kValues)
      for (const float b : kValues)
        for (const float c : {0.0f, 0.5f, -1.0f}) {
          if (operation == LANCER_MATH_SMOOTH_MIN || operation == LANCER_MATH_SMOOTH_MAX)
            if (c < 0.0f)
              continue; // a distance
          const glm::vec4 got = stage.value({node(LANCER_NODE_MATH, operation, {constant(a), constant(b), constant(c)})});
          const double expected = function(double(a), double(b), double(c));
          // A few roundings of float, relative to the result or to the operands of a subtraction.
          const double tolerance = 4e-7 * std::max({std::abs(expected), 4.0});
          EXPECT_NEAR(got.x, expected, tolerance) << "operation " << operation << " of " << a << ", " << b << ", " << c;
          EXPECT_EQ(got, glm::vec4(got.x, got.x, got.x, 1.0f));
        }
}

// C99's fmin() and fmax(), except that of two zeros the first is returned, whose sign C99 leaves to each library.
TEST(NodesMath, TheFirstOfZerosAndTheNumberBesideNone) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (const uint32_t operation : {LANCER_MATH_MINIMUM, LANCER_MATH_MAXIMUM}) {
    EXPECT_TRUE(std::signbit(math(operation, -0.0f, 0.0f, 0.0f))) << operation;
    EXPECT_FALSE(std::signbit(math(operation, 0.0f, -0.0f, 0.0f))) << operation;
    EXPECT_EQ(math(operation, none, 2.0f, 0.0f), 2.0f) << operation;
    EXPECT_EQ(math(operation, 2.0f, none, 0.0f), 2.0f) << operation;
  }
}

TEST(NodesMath, ClampedWhereAsked) {
  Stage stage;
  const auto sum = [&](float a) {
    return stage.value({flagged(node(LANCER_NODE_MATH, LANCER_MATH_ADD, {constant(a), constant(0.25f)}), 1)}).x;
  };
  EXPECT_EQ(sum(2.0f), 1.0f);
  EXPECT_EQ(sum(-2.0f), 0.0f);
  EXPECT_EQ(sum(0.5f), 0.75f);
}

TEST(NodesMath, EveryVectorOperation) {
  Stage stage;
  const glm::vec3 a(0.75f, -1.5f, 2.25f), b(-0.5f, 0.25f, 1.25f), c(0.1f, 0.2f, 0.3f);
  const glm::dvec3 n = glm::normalize(glm::dvec3(b));
  const auto each = [&](auto function) { return glm::vec3(function(a.x, b.x), function(a.y, b.y), function(a.z, b.z)); };
  const auto all = [](double value) { return glm::vec3(float(value)); };
  const std::map<uint32_t, glm::vec3> expected = {
      {LANCER_VECTOR_ADD, a + b},
      {LANCER_VECTOR_SUBTRACT, a - b},
      {LANCER_VECTOR_MULTIPLY, a * b},
      {LANCER_VECTOR_DIVIDE, a / b},
      {LANCER_VECTOR_MULTIPLY_ADD, a * b + c},
      {LANCER_VECTOR_CROSS_PRODUCT, glm::cross(a, b)},
      {LANCER_VECTOR_PROJECT, glm::vec3(glm::dot(glm::dvec3(a), n) * n)},
      {LANCER_VECTOR_REFLECT, glm::vec3(glm::dvec3(a) - 2.0 * glm::dot(glm::dvec3(a), n) * n)},
      {LANCER_VECTOR_DOT_PRODUCT, all(glm::dot(glm::dvec3(a), glm::dvec3(b)))},
      {LANCER_VECTOR_DISTANCE, all(glm::length(glm::dvec3(a) - glm::dvec3(b)))},
      {LANCER_VECTOR_LENGTH, all(glm::length(glm::dvec3(a)))},
      {LANCER_VECTOR_SCALE, 0.7f * a},
      {LANCER_VECTOR_NORMALIZE, glm::vec3(glm::normalize(glm::dvec3(a)))},
      {LANCER_VECTOR_ABSOLUTE, glm::vec3(0.75f, 1.5f, 2.25f)},
      {LANCER_VECTOR_MINIMUM, glm::vec3(-0.5f, -1.5f, 1.25f)},
      {LANCER_VECTOR_MAXIMUM, glm::vec3(0.75f, 0.25f, 2.25f)},
      {LANCER_VECTOR_FLOOR, glm::vec3(0, -2, 2)},
      {LANCER_VECTOR_CEIL, glm::vec3(1, -1, 3)},
      {LANCER_VECTOR_FRACTION, glm::vec3(0.75f, 0.5f, 0.25f)},
      {LANCER_VECTOR_MODULO, each([](float x, float y) { return std::fmod(x, y); })},
      {LANCER_VECTOR_SNAP, each([](float x, float y) { return std::floor(x / y) * y; })},
      {LANCER_VECTOR_SINE, each([](float x, float) { return float(std::sin(double(x))); })},
      {LANCER_VECTOR_COSINE, each([](float x, float) { return float(std::cos(double(x))); })},
      {LANCER_VECTOR_TANGENT, each([](float x, float) { return float(std::tan(double(x))); })},
  };
  ASSERT_EQ(expected.size(), size_t(LANCER_VECTOR_COUNT));
  for (const auto &[operation, value] : expected) {
    SCOPED_TRACE(operation);
    const lancer_node n4 = node(LANCER_NODE_VECTOR_MATH, operation,
                                {constant(a.x, a.y, a.z), constant(b.x, b.y, b.z), constant(c.x, c.y, c.z), constant(0.7f)});
    // Numbers up to 14.1, the tangent of 1.5, with two roundings.
    expect_near(glm::vec3(stage.value({n4})), value, 4e-6f);
  }
  // Undefined results are 0.
  for (const uint32_t operation : {LANCER_VECTOR_DIVIDE, LANCER_VECTOR_PROJECT, LANCER_VECTOR_MODULO, LANCER_VECTOR_SNAP})
    EXPECT_EQ(glm::vec3(stage.value({node(LANCER_NODE_VECTOR_MATH, operation, {constant(1.0f), constant(0.0f)})})),
              glm::vec3(0.0f));
  EXPECT_EQ(glm::vec3(stage.value({node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_NORMALIZE)})), glm::vec3(0.0f));
}

TEST(NodesMath, MappingIsScaleThenRotationThenLocation) {
  Stage stage;
  const glm::dvec3 v(0.3, -0.7, 1.1), location(1, 2, 3), angles(0.4, -1.2, 2.5), scale(2.0, 0.5, -1.5);
  const glm::dmat4 one(1.0);
  const glm::dmat3 turn(glm::rotate(one, angles.z, glm::dvec3(0, 0, 1)) * glm::rotate(one, angles.y, glm::dvec3(0, 1, 0)) *
                        glm::rotate(one, angles.x, glm::dvec3(1, 0, 0)));
  const auto parameter = [](const glm::dvec3 &p) { return constant(float(p.x), float(p.y), float(p.z)); };
  const auto mapped = [&](uint32_t option) {
    return glm::vec3(stage.value(
        {node(LANCER_NODE_MAPPING, option, {parameter(v), parameter(location), parameter(angles), parameter(scale)})}));
  };
  expect_near(mapped(LANCER_MAPPING_POINT), glm::vec3(turn * (v * scale) + location));
  expect_near(mapped(LANCER_MAPPING_VECTOR), glm::vec3(turn * (v * scale)));
  // Numbers up to 7, because it divides by a scale of a half, with a dozen roundings of 2^-24 relative to this.
  expect_near(mapped(LANCER_MAPPING_TEXTURE), glm::vec3(glm::inverse(turn) * (v - location) / scale), 1e-5f);
  expect_near(mapped(LANCER_MAPPING_NORMAL), glm::vec3(glm::normalize(turn * (v / scale))));
}

// Modes per channel: the result with a factor of 1.
double full_mix(uint32_t mode, double a, double b) {
  switch (mode) {
  case LANCER_MIX_MIX:
    return b;
  case LANCER_MIX_DARKEN:
    return std::min(a, b);
  case LANCER_MIX_LIGHTEN:
    return std::max(a, b);
  case LANCER_MIX_MULTIPLY:
    return a * b;
  case LANCER_MIX_ADD:
    return a + b;
  case LANCER_MIX_SUBTRACT:
    return a - b;
  case LANCER_MIX_DIVIDE:
    return a / b;
  case LANCER_MIX_DIFFERENCE:
    return std::abs(a - b);
  case LANCER_MIX_EXCLUSION:
    return a + b - 2.0 * a * b;
  case LANCER_MIX_SCREEN:
    return 1.0 - (1.0 - a) * (1.0 - b);
  case LANCER_MIX_OVERLAY:
    return a < 0.5 ? 2.0 * a * b : 1.0 - 2.0 * (1.0 - a) * (1.0 - b);
  case LANCER_MIX_SOFT_LIGHT:
    return (1.0 - a) * a * b + a * (1.0 - (1.0 - a) * (1.0 - b));
  case LANCER_MIX_LINEAR_LIGHT:
    return a + 2.0 * b - 1.0;
  default:
    return NAN;
  }
}

TEST(NodesMath, MixModesAreStraightBetweenTheirEnds) {
  Stage stage;
  const glm::vec3 a(0.2f, 0.6f, 0.9f), b(0.7f, 0.3f, 0.5f);
  for (uint32_t mode = 0; mode < LANCER_MIX_COUNT; ++mode) {
    if (std::isnan(full_mix(mode, 0.5, 0.5)))
      continue;
    SCOPED_TRACE(mode);
    for (const float t : {0.0f, 0.35f, 1.0f}) {
      glm::vec3 expected;
      for (int i = 0; i < 3; ++i)
        expected[i] = float((1.0 - double(t)) * double(a[i]) + double(t) * full_mix(mode, double(a[i]), double(b[i])));
      const lancer_node mix = node(LANCER_NODE_MIX, mode, {constant(t), constant(a.x, a.y, a.z), constant(b.x, b.y, b.z)});
      // Numbers up to 2 (a quotient of 0.9 and 0.5), and eight roundings of 2^-24 relative to this and to the result.
      expect_near(glm::vec3(stage.value({mix})), expected, 1e-6f);
    }
  }
}

TEST(NodesMath, DodgeAndBurn) {
  Stage stage;
  const auto mixed = [&](uint32_t mode, float t, float a, float b) {
    return stage.value({node(LANCER_NODE_MIX, mode, {constant(t), constant(a), constant(b)})}).x;
  };
  // Numbers below 1 with three roundings of 2^-24.
  EXPECT_NEAR(mixed(LANCER_MIX_DODGE, 0.5f, 0.3f, 0.6f), 0.3 / 0.7, 2e-7);
  EXPECT_EQ(mixed(LANCER_MIX_DODGE, 1.0f, 0.8f, 0.6f), 1.0f);
  EXPECT_EQ(mixed(LANCER_MIX_DODGE, 1.0f, 0.0f, 1.0f), 0.0f);
  EXPECT_NEAR(mixed(LANCER_MIX_BURN, 0.5f, 0.8f, 0.6f), 1.0 - 0.2 / 0.8, 2e-7);
  EXPECT_EQ(mixed(LANCER_MIX_BURN, 1.0f, 0.1f, 0.2f), 0.0f);
  EXPECT_EQ(mixed(LANCER_MIX_BURN, 1.0f, 0.5f, 0.0f), 0.0f);
}

TEST(NodesMath, HueSaturationValueOfTheOther) {
  Stage stage;
  // Orange (hue 1/12) and a dull blue (hue 2/3, saturation 1/2, value 0.4).
  const lancer_parameter orange = constant(0.8f, 0.4f, 0.0f), blue = constant(0.2f, 0.2f, 0.4f), grey = constant(0.3f);
  const auto mixed = [&](uint32_t mode, float t, const lancer_parameter &a, const lancer_parameter &b) {
    return glm::vec3(stage.value({node(LANCER_NODE_MIX, mode, {constant(t), a, b})}));
  };
  expect_near(mixed(LANCER_MIX_HUE, 1.0f, orange, blue), glm::vec3(0.0f, 0.0f, 0.8f));
  expect_near(mixed(LANCER_MIX_SATURATION, 1.0f, orange, blue), glm::vec3(0.8f, 0.6f, 0.4f));
  expect_near(mixed(LANCER_MIX_VALUE, 1.0f, orange, blue), glm::vec3(0.4f, 0.2f, 0.0f));
  expect_near(mixed(LANCER_MIX_COLOR, 1.0f, orange, blue), glm::vec3(0.4f, 0.4f, 0.8f));
  // Halfway: hue and colour in RGB, saturation and value by themselves.
  expect_near(mixed(LANCER_MIX_HUE, 0.5f, orange, blue), glm::vec3(0.4f, 0.2f, 0.4f));
  expect_near(mixed(LANCER_MIX_SATURATION, 0.5f, orange, blue), glm::vec3(0.8f, 0.5f, 0.2f));
  expect_near(mixed(LANCER_MIX_VALUE, 0.5f, orange, blue), glm::vec3(0.6f, 0.3f, 0.0f));
  // A grey has no hue and receives no saturation.
  expect_near(mixed(LANCER_MIX_HUE, 1.0f, orange, grey), glm::vec3(0.8f, 0.4f, 0.0f));
  expect_near(mixed(LANCER_MIX_SATURATION, 1.0f, grey, blue), glm::vec3(0.3f));
}

TEST(NodesMath, MixFlagsAndFactorByComponent) {
  Stage stage;
  const lancer_parameter black = constant(0.0f), two = constant(2.0f);
  const auto mixed = [&](const lancer_parameter &t, uint32_t flags) {
    return glm::vec3(stage.value({flagged(node(LANCER_NODE_MIX, LANCER_MIX_MIX, {t, black, two}), flags)}));
  };
  EXPECT_EQ(mixed(constant(1.5f), 0), glm::vec3(3.0f));
  EXPECT_EQ(mixed(constant(1.5f), 1), glm::vec3(2.0f));
  EXPECT_EQ(mixed(constant(1.5f), 2), glm::vec3(1.0f));
  EXPECT_EQ(mixed(constant(0.0f, 0.25f, 1.0f), 0), glm::vec3(0.0f, 0.5f, 2.0f));
}

TEST(NodesMath, ColorModelsAreEachOthersInverse) {
  Stage stage;
  // An orange: a hue of 1/12, saturation 2/3 and value 3/4; lightness 1/2, of which chroma is a half.
  const glm::vec3 orange(0.75f, 0.5f, 0.25f);
  const auto converted = [&](uint32_t option, const glm::vec3 &c) {
    return glm::vec3(stage.value({node(LANCER_NODE_COLOR_MODEL, option, {constant(c.x, c.y, c.z)})}));
  };
  const glm::vec3 hsv = converted(LANCER_COLOR_TO_HSV, orange), hsl = converted(LANCER_COLOR_TO_HSL, orange);
  // Quotients by 3 and 12: a few roundings.
  EXPECT_LT(glm::distance(hsv, glm::vec3(1.0f / 12.0f, 2.0f / 3.0f, 0.75f)), 1e-6f);
  EXPECT_LT(glm::distance(hsl, glm::vec3(1.0f / 12.0f, 0.5f, 0.5f)), 1e-6f);
  EXPECT_LT(glm::distance(converted(LANCER_COLOR_FROM_HSV, hsv), orange), 1e-6f);
  EXPECT_LT(glm::distance(converted(LANCER_COLOR_FROM_HSL, hsl), orange), 1e-6f);
  // Greys and black have no hue and no saturation; hues outside the circle are treated as its last sixth.
  for (const uint32_t option : {LANCER_COLOR_TO_HSV, LANCER_COLOR_TO_HSL})
    for (const float grey : {0.0f, 0.25f, 1.0f})
      EXPECT_EQ(converted(option, glm::vec3(grey)), glm::vec3(0.0f, 0.0f, grey));
  EXPECT_EQ(converted(LANCER_COLOR_FROM_HSV, {1.5f, 0.5f, 1.0f}), glm::vec3(1.0f, 0.5f, 1.0f));
}

TEST(NodesMath, SmallOnes) {
  Stage stage;
  const lancer_parameter color = constant(0.25f, 0.5f, -0.5f);
  for (uint32_t i = 0; i < 3; ++i)
    EXPECT_EQ(stage.value({node(LANCER_NODE_SEPARATE, i, {color})}).x, color.value[i]);
  EXPECT_EQ(glm::vec3(stage.value({node(LANCER_NODE_COMBINE, 0, {constant(1.0f), constant(2.0f), constant(3.0f)})})),
            glm::vec3(1, 2, 3));
  lancer_node grey = node(LANCER_NODE_GREY, 0, {color});
  grey.matrix[0] = 0.5f;
  grey.matrix[1] = 0.25f;
  grey.matrix[2] = 0.125f;
  EXPECT_EQ(stage.value({grey}).x, 0.125f + 0.125f - 0.0625f);
  EXPECT_EQ(stage.value({node(LANCER_NODE_CLAMP, 0, {constant(5.0f), constant(0.5f), constant(2.0f)})}).x, 2.0f);
  EXPECT_EQ(stage.value({node(LANCER_NODE_CLAMP, 0, {constant(-5.0f), constant(0.5f), constant(2.0f)})}).x, 0.5f);
  EXPECT_EQ(glm::vec3(stage.value({node(LANCER_NODE_INVERT, 0, {constant(0.5f), color})})), glm::vec3(0.5f));
  EXPECT_EQ(glm::vec3(stage.value({node(LANCER_NODE_INVERT, 0, {constant(1.0f), color})})), glm::vec3(0.75f, 0.5f, 1.5f));
  // A negative channel has no power; the exponent 0 gives white.
  expect_near(glm::vec3(stage.value({node(LANCER_NODE_GAMMA, 0, {color, constant(2.0f)})})), glm::vec3(0.0625f, 0.25f, -0.5f));
  EXPECT_EQ(glm::vec3(stage.value({node(LANCER_NODE_GAMMA, 0, {color, constant(0.0f)})})), glm::vec3(1.0f));
}

} // namespace
