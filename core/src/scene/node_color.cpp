// Mixing and changing colours, as Blender's Mix and Gamma nodes have it.
#include "sampling/elementary.h"
#include "scene/node_site.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

glm::vec3 blend(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &t) { return a * (1.0f - t) + b * t; }

// One function of every pair of channels.
template <class Function> glm::vec3 channels(const glm::vec3 &a, const glm::vec3 &b, Function f) {
  return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}

// Hue in 0 ... 1, saturation, value: the hexcone model.
glm::vec3 to_hsv(const glm::vec3 &c) {
  const float high = std::max({c.x, c.y, c.z}), span = high - std::min({c.x, c.y, c.z});
  const float saturation = high != 0.0f ? span / high : 0.0f;
  if (saturation == 0.0f)
    return {0.0f, saturation, high};
  float sector;
  if (c.x == high)
    sector = (c.y - c.z) / span;
  else if (c.y == high)
    sector = 2.0f + (c.z - c.x) / span;
  else
    sector = 4.0f + (c.x - c.y) / span;
  const float hue = sector / 6.0f;
  return {hue < 0.0f ? hue + 1.0f : hue, saturation, high};
}

glm::vec3 to_rgb(const glm::vec3 &hsv) {
  // Each channel is a trapezoid over the circle of hues, a third of it apart from the others.
  const float hue = hsv.x == 1.0f ? 0.0f : hsv.x;
  const auto channel = [&](float turn) {
    const float place = (hue + turn - std::floor(hue + turn)) * 6.0f;
    const float share = std::clamp(std::abs(place - 3.0f) - 1.0f, 0.0f, 1.0f);
    return hsv.z * (1.0f - hsv.y * (1.0f - share));
  };
  return {channel(0.0f), channel(2.0f / 3.0f), channel(1.0f / 3.0f)};
}

// Those modes that take hue, saturation or value of the second colour.
glm::vec3 mix_hsv(uint32_t mode, float t, const glm::vec3 &a, const glm::vec3 &b) {
  glm::vec3 hsv = to_hsv(a);
  const glm::vec3 other = to_hsv(b);
  switch (mode) {
  case LANCER_MIX_HUE:
  case LANCER_MIX_COLOR:
    // A grey has no hue to give.
    if (other.y == 0.0f)
      return a;
    hsv.x = other.x;
    if (mode == LANCER_MIX_COLOR)
      hsv.y = other.y;
    return blend(a, to_rgb(hsv), glm::vec3(t));
  case LANCER_MIX_SATURATION:
    if (hsv.y == 0.0f)
      return a;
    hsv.y = (1.0f - t) * hsv.y + t * other.y;
    return to_rgb(hsv);
  default:
    hsv.z = (1.0f - t) * hsv.z + t * other.z;
    return to_rgb(hsv);
  }
}

glm::vec3 mix_mode(uint32_t mode, const glm::vec3 &factor, const glm::vec3 &a, const glm::vec3 &b) {
  const float t = factor.x, rest = 1.0f - t;
  switch (mode) {
  case LANCER_MIX_MIX:
    return blend(a, b, factor);
  case LANCER_MIX_DARKEN:
    return blend(a, glm::min(a, b), glm::vec3(t));
  case LANCER_MIX_LIGHTEN:
    return blend(a, glm::max(a, b), glm::vec3(t));
  case LANCER_MIX_MULTIPLY:
    return blend(a, a * b, glm::vec3(t));
  case LANCER_MIX_ADD:
    return a + t * b;
  case LANCER_MIX_SUBTRACT:
    return a - t * b;
  case LANCER_MIX_SCREEN:
    return 1.0f - (rest + t * (1.0f - b)) * (1.0f - a);
  case LANCER_MIX_OVERLAY:
    return channels(a, b, [&](float x, float y) {
      return x < 0.5f ? x * (rest + 2.0f * t * y) : 1.0f - (rest + 2.0f * t * (1.0f - y)) * (1.0f - x);
    });
  case LANCER_MIX_DIVIDE:
    return channels(a, b, [&](float x, float y) { return y != 0.0f ? rest * x + t * x / y : x; });
  case LANCER_MIX_DIFFERENCE:
    return blend(a, glm::abs(a - b), glm::vec3(t));
  case LANCER_MIX_EXCLUSION:
    return glm::max(blend(a, a + b - 2.0f * a * b, glm::vec3(t)), 0.0f);
  case LANCER_MIX_DODGE:
    return channels(a, b, [&](float x, float y) {
      const float light = 1.0f - t * y;
      return x == 0.0f ? x : light <= 0.0f ? 1.0f : std::min(x / light, 1.0f);
    });
  case LANCER_MIX_BURN:
    return channels(a, b, [&](float x, float y) {
      const float light = rest + t * y;
      return light <= 0.0f ? 0.0f : std::clamp(1.0f - (1.0f - x) / light, 0.0f, 1.0f);
    });
  case LANCER_MIX_SOFT_LIGHT:
    return rest * a + t * ((1.0f - a) * b * a + a * (1.0f - (1.0f - b) * (1.0f - a)));
  case LANCER_MIX_LINEAR_LIGHT:
    return a + t * (2.0f * b - 1.0f);
  default:
    return mix_hsv(mode, t, a, b);
  }
}

} // namespace

glm::vec4 mix(const Inputs &in) {
  glm::vec3 factor = in[0];
  if (in.node.flags & 1)
    factor = glm::clamp(factor, 0.0f, 1.0f);
  const glm::vec3 result = mix_mode(in.node.option, factor, in[1], in[2]);
  return solid(in.node.flags & 2 ? glm::clamp(result, 0.0f, 1.0f) : result);
}

glm::vec4 gamma(const Inputs &in) {
  const float exponent = in.scalar(1);
  if (exponent == 0.0f)
    return scalar(1.0f);
  glm::vec3 c = in[0];
  for (int i = 0; i < 3; ++i)
    c[i] = c[i] > 0.0f ? pow(c[i], exponent) : c[i];
  return solid(c);
}

} // namespace lancer
