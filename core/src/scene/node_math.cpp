// Arithmetic of numbers and vectors, as Blender's Math, Vector Math and Mapping nodes have it: what is undefined gives 0.
#include "sampling/elementary.h"
#include "scene/node_site.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace lancer {

namespace {

// Of a number and what is none the number, as C99's fmin() and fmax(); of zeros of both signs the first, which those leave
// open.
float least(float a, float b) { return b < a || a != a ? b : a; }
float largest(float a, float b) { return b > a || a != a ? b : a; }

float divide(float a, float b) { return b != 0.0f ? a / b : 0.0f; }
float modulo(float a, float b) { return b != 0.0f ? std::fmod(a, b) : 0.0f; }
float fraction(float a) { return a - std::floor(a); }

float power(float a, float b) {
  if (a < 0.0f && b != std::trunc(b))
    return 0.0f;
  if (b == 0.0f)
    return 1.0f;
  return a == 0.0f ? 0.0f : pow(a, b);
}

float logarithm(float a, float base) { return a > 0.0f && base > 0.0f ? divide(log(a), log(base)) : 0.0f; }

// The smaller, rounded off over the distance k.
float smooth_minimum(float a, float b, float k) {
  const float smaller = least(a, b);
  if (k == 0.0f)
    return smaller;
  const float h = largest(k - std::abs(a - b), 0.0f) / k;
  return smaller - h * h * h * k / 6.0f;
}

float wrap(float a, float high, float low) {
  const float range = high - low;
  return range != 0.0f ? a - range * std::floor((a - low) / range) : low;
}

float pingpong(float a, float b) { return b != 0.0f ? std::abs(fraction((a - b) / (2.0f * b)) * 2.0f * b - b) : 0.0f; }

// One function of every component.
template <class Function> glm::vec3 each(const glm::vec3 &a, Function f) { return {f(a.x), f(a.y), f(a.z)}; }
template <class Function> glm::vec3 each(const glm::vec3 &a, const glm::vec3 &b, Function f) {
  return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}

} // namespace

glm::mat3 rotation(const glm::vec3 &angles) {
  const glm::vec3 c = each(angles, [](float a) { return cos(a); }), s = each(angles, [](float a) { return sin(a); });
  const glm::mat3 x(1.0f, 0.0f, 0.0f, 0.0f, c.x, s.x, 0.0f, -s.x, c.x);
  const glm::mat3 y(c.y, 0.0f, -s.y, 0.0f, 1.0f, 0.0f, s.y, 0.0f, c.y);
  const glm::mat3 z(c.z, s.z, 0.0f, -s.z, c.z, 0.0f, 0.0f, 0.0f, 1.0f);
  return z * y * x;
}

float math(uint32_t operation, float a, float b, float c) {
  constexpr float pi = glm::pi<float>();
  switch (operation) {
  case LANCER_MATH_ADD:
    return a + b;
  case LANCER_MATH_SUBTRACT:
    return a - b;
  case LANCER_MATH_MULTIPLY:
    return a * b;
  case LANCER_MATH_DIVIDE:
    return divide(a, b);
  case LANCER_MATH_MULTIPLY_ADD:
    return a * b + c;
  case LANCER_MATH_POWER:
    return power(a, b);
  case LANCER_MATH_LOGARITHM:
    return logarithm(a, b);
  case LANCER_MATH_SQRT:
    return a > 0.0f ? std::sqrt(a) : 0.0f;
  case LANCER_MATH_INVERSE_SQRT:
    return a > 0.0f ? 1.0f / std::sqrt(a) : 0.0f;
  case LANCER_MATH_ABSOLUTE:
    return std::abs(a);
  case LANCER_MATH_EXPONENT:
    return exp(a);
  case LANCER_MATH_MINIMUM:
    return least(a, b);
  case LANCER_MATH_MAXIMUM:
    return largest(a, b);
  case LANCER_MATH_LESS_THAN:
    return a < b ? 1.0f : 0.0f;
  case LANCER_MATH_GREATER_THAN:
    return a > b ? 1.0f : 0.0f;
  case LANCER_MATH_SIGN:
    return a == 0.0f ? 0.0f : a < 0.0f ? -1.0f : 1.0f;
  case LANCER_MATH_COMPARE:
    // Blender's smallest tolerance: one unit in the last place of 1.
    return a == b || std::abs(a - b) <= largest(c, std::numeric_limits<float>::epsilon()) ? 1.0f : 0.0f;
  case LANCER_MATH_SMOOTH_MIN:
    return smooth_minimum(a, b, c);
  case LANCER_MATH_SMOOTH_MAX:
    return -smooth_minimum(-a, -b, c);
  case LANCER_MATH_ROUND:
    return std::floor(a + 0.5f);
  case LANCER_MATH_FLOOR:
    return std::floor(a);
  case LANCER_MATH_CEIL:
    return std::ceil(a);
  case LANCER_MATH_TRUNC:
    return std::trunc(a);
  case LANCER_MATH_FRACT:
    return fraction(a);
  case LANCER_MATH_MODULO:
    return modulo(a, b);
  case LANCER_MATH_FLOORED_MODULO:
    return b != 0.0f ? a - std::floor(a / b) * b : 0.0f;
  case LANCER_MATH_WRAP:
    return wrap(a, b, c);
  case LANCER_MATH_SNAP:
    return std::floor(divide(a, b)) * b;
  case LANCER_MATH_PINGPONG:
    return pingpong(a, b);
  case LANCER_MATH_SINE:
    return sin(a);
  case LANCER_MATH_COSINE:
    return cos(a);
  case LANCER_MATH_TANGENT:
    return tan(a);
  case LANCER_MATH_ARCSINE:
    return asin(std::clamp(a, -1.0f, 1.0f));
  case LANCER_MATH_ARCCOSINE:
    return acos(std::clamp(a, -1.0f, 1.0f));
  case LANCER_MATH_ARCTANGENT:
    return atan(a);
  case LANCER_MATH_ARCTAN2:
    return a == 0.0f && b == 0.0f ? 0.0f : atan2(a, b);
  case LANCER_MATH_SINH:
    return sinh(a);
  case LANCER_MATH_COSH:
    return cosh(a);
  case LANCER_MATH_TANH:
    return tanh(a);
  case LANCER_MATH_RADIANS:
    return a * (pi / 180.0f);
  case LANCER_MATH_DEGREES:
    return a * (180.0f / pi);
  default:
    return 0.0f;
  }
}

glm::vec4 vector_math(const Inputs &in) {
  const glm::vec3 a = in[0], b = in[1];
  switch (in.node.option) {
  case LANCER_VECTOR_ADD:
    return solid(a + b);
  case LANCER_VECTOR_SUBTRACT:
    return solid(a - b);
  case LANCER_VECTOR_MULTIPLY:
    return solid(a * b);
  case LANCER_VECTOR_DIVIDE:
    return solid(each(a, b, divide));
  case LANCER_VECTOR_MULTIPLY_ADD:
    return solid(a * b + in[2]);
  case LANCER_VECTOR_CROSS_PRODUCT:
    return solid(glm::cross(a, b));
  case LANCER_VECTOR_PROJECT: {
    const float length2 = glm::dot(b, b);
    return solid(length2 != 0.0f ? glm::dot(a, b) / length2 * b : glm::vec3(0.0f));
  }
  case LANCER_VECTOR_REFLECT: {
    const glm::vec3 n = unit_or_zero(b);
    return solid(a - 2.0f * glm::dot(a, n) * n);
  }
  case LANCER_VECTOR_DOT_PRODUCT:
    return scalar(glm::dot(a, b));
  case LANCER_VECTOR_DISTANCE:
    return scalar(glm::length(a - b));
  case LANCER_VECTOR_LENGTH:
    return scalar(glm::length(a));
  case LANCER_VECTOR_SCALE:
    return solid(a * in.scalar(3));
  case LANCER_VECTOR_NORMALIZE:
    return solid(unit_or_zero(a));
  case LANCER_VECTOR_ABSOLUTE:
    return solid(glm::abs(a));
  case LANCER_VECTOR_MINIMUM:
    return solid(glm::min(a, b));
  case LANCER_VECTOR_MAXIMUM:
    return solid(glm::max(a, b));
  case LANCER_VECTOR_FLOOR:
    return solid(glm::floor(a));
  case LANCER_VECTOR_CEIL:
    return solid(glm::ceil(a));
  case LANCER_VECTOR_FRACTION:
    return solid(each(a, fraction));
  case LANCER_VECTOR_MODULO:
    return solid(each(a, b, modulo));
  case LANCER_VECTOR_SNAP:
    return solid(glm::floor(each(a, b, divide)) * b);
  case LANCER_VECTOR_SINE:
    return solid(each(a, [](float x) { return sin(x); }));
  case LANCER_VECTOR_COSINE:
    return solid(each(a, [](float x) { return cos(x); }));
  case LANCER_VECTOR_TANGENT:
    return solid(each(a, [](float x) { return tan(x); }));
  default:
    return solid(glm::vec3(0.0f));
  }
}

glm::vec4 mapping(const Inputs &in) {
  const glm::vec3 v = in[0], location = in[1], scale = in[3];
  const glm::mat3 turn = rotation(in[2]);
  switch (in.node.option) {
  case LANCER_MAPPING_POINT:
    return solid(turn * (v * scale) + location);
  case LANCER_MAPPING_TEXTURE:
    return solid(each(glm::transpose(turn) * (v - location), scale, divide));
  case LANCER_MAPPING_VECTOR:
    return solid(turn * (v * scale));
  default:
    return solid(unit_or_zero(turn * each(v, scale, divide)));
  }
}

} // namespace lancer
