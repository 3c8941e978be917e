// Colour nodes: Blender's Mix, Gamma, Invert, RGB to BW, Separate and Combine Color. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/vector_nodes.h"

namespace lancer {
namespace {

template <class F> LANCER_LANE Vector3<F> blend(const Vector3<F> &a, const Vector3<F> &b, const Vector3<F> &t) {
  return a * (Vector3<F>(F(1.0f)) - t) + b * t;
}
template <class F> LANCER_LANE Vector3<F> blend(const Vector3<F> &a, const Vector3<F> &b, const F &t) {
  return blend(a, b, Vector3<F>(t));
}

// Hue in 0 ... 1, saturation, value: the hexcone model.
template <class F> Vector3<F> to_hsv(const Vector3<F> &c) {
  const F zero(0.0f), high = max(max(c.x, c.y), c.z), span = high - min(min(c.x, c.y), c.z);
  const F saturation = select(high != zero, span / high, zero);
  const F sector =
      select(c.x == high, (c.y - c.z) / span, select(c.y == high, F(2.0f) + (c.z - c.x) / span, F(4.0f) + (c.x - c.y) / span));
  const F hue = sector / F(6.0f), turned = select(hue < zero, hue + F(1.0f), hue);
  return {select(saturation == zero, zero, turned), saturation, high};
}

template <class F> Vector3<F> from_hsv(const Vector3<F> &hsv) {
  // Each channel is a trapezoid over the circle of hues, shifted by a third of it.
  const F one(1.0f), hue = select(hsv.x == one, F(0.0f), hsv.x);
  const auto channel = [&](float turn) {
    const F at = hue + F(turn), place = (at - floor(at)) * F(6.0f);
    const F share = clamp01(F(abs(place - F(3.0f)) - one));
    return hsv.z * (one - hsv.y * (one - share));
  };
  const Vector3<F> inside{channel(0.0f), channel(2.0f / 3.0f), channel(1.0f / 3.0f)};
  // Hues outside 0 ... 1 are treated as the last sixth, as in Cycles.
  const F sixths = hue * F(6.0f), least = hsv.z * (one - hsv.y);
  const F falling = hsv.z * (one - hsv.y * (sixths - floor(sixths)));
  return select((hue < F(0.0f)) | (hue >= one), Vector3<F>{hsv.z, least, falling}, inside);
}

// Hue in 0 ... 1, saturation, lightness.
template <class F> Vector3<F> to_hsl(const Vector3<F> &c) {
  const F zero(0.0f), high = max(max(c.x, c.y), c.z), low = min(min(c.x, c.y), c.z), both = high + low;
  const F light = min(F(0.5f) * both, F(1.0f));
  const F saturation = (high - low) / select(light > F(0.5f), F(2.0f) - both, both);
  const auto grey = high == low;
  return {select(grey, zero, to_hsv(c).x), select(grey, zero, saturation), light};
}

template <class F> Vector3<F> from_hsl(const Vector3<F> &hsl) {
  const F one(1.0f), two(2.0f), six = F(6.0f) * hsl.x;
  const F chroma = (one - abs(two * hsl.z - one)) * hsl.y;
  const auto channel = [&](F full) { return (clamp01(full) - F(0.5f)) * chroma + hsl.z; };
  return {channel(abs(six - F(3.0f)) - one), channel(two - abs(six - two)), channel(two - abs(six - F(4.0f)))};
}

// Modes that use hue, saturation or value of the second colour.
template <class F> Vector3<F> mix_hsv(uint32_t mode, const F &t, const Vector3<F> &a, const Vector3<F> &b) {
  const F zero(0.0f), rest = F(1.0f) - t;
  Vector3<F> hsv = to_hsv(a);
  const Vector3<F> other = to_hsv(b);
  switch (mode) {
  case MixMode::Hue:
  case MixMode::Color:
    hsv.x = other.x;
    if (mode == MixMode::Color)
      hsv.y = other.y;
    // A grey has no hue.
    return select(other.y == zero, a, blend(a, from_hsv(hsv), t));
  case MixMode::Saturation: {
    const auto grey = hsv.y == zero;
    hsv.y = rest * hsv.y + t * other.y;
    return select(grey, a, from_hsv(hsv));
  }
  default:
    hsv.z = rest * hsv.z + t * other.z;
    return from_hsv(hsv);
  }
}

template <class F> Vector3<F> mix_mode(uint32_t mode, const Vector3<F> &factor, const Vector3<F> &a, const Vector3<F> &b) {
  using V3 = Vector3<F>;
  const F t = factor.x, zero(0.0f), one(1.0f), two(2.0f), rest = one - t;
  const V3 white(one);
  switch (mode) {
  case MixMode::Mix:
    return blend(a, b, factor);
  case MixMode::Darken:
    return blend(a, min(a, b), t);
  case MixMode::Lighten:
    return blend(a, max(a, b), t);
  case MixMode::Multiply:
    return blend(a, a * b, t);
  case MixMode::Add:
    return a + t * b;
  case MixMode::Subtract:
    return a - t * b;
  case MixMode::Screen:
    return white - (V3(rest) + t * (white - b)) * (white - a);
  case MixMode::Overlay:
    return componentwise(a, b, [&](const F &x, const F &y) {
      return select(x < F(0.5f), x * (rest + two * t * y), one - (rest + two * t * (one - y)) * (one - x));
    });
  case MixMode::Divide:
    return componentwise(a, b, [&](const F &x, const F &y) { return select(y != zero, rest * x + t * x / y, x); });
  case MixMode::Difference:
    return blend(a, abs(a - b), t);
  case MixMode::Exclusion:
    return max(blend(a, a + b - two * a * b, t), V3(zero));
  case MixMode::Dodge:
    return componentwise(a, b, [&](const F &x, const F &y) {
      const F light = one - t * y;
      return select(x == zero, x, select(light <= zero, one, min(x / light, one)));
    });
  case MixMode::Burn:
    return componentwise(a, b, [&](const F &x, const F &y) {
      const F light = rest + t * y;
      return select(light <= zero, zero, clamp01(F(one - (one - x) / light)));
    });
  case MixMode::SoftLight:
    return rest * a + t * ((white - a) * b * a + a * (white - (white - b) * (white - a)));
  case MixMode::LinearLight:
    return a + t * (two * b - white);
  default:
    return mix_hsv(mode, t, a, b);
  }
}

template <class F> Value<F> mix_node(const Inputs<F> &in) {
  const Vector3<F> factor = in.node.flags & 1 ? clamp01(in[0]) : in[0];
  const Vector3<F> result = mix_mode(in.node.option, factor, in[1], in[2]);
  return solid(in.node.flags & 2 ? clamp01(result) : result);
}

template <class F> Value<F> gamma_node(const Inputs<F> &in) {
  const F zero(0.0f), exponent = in.scalar(1);
  const Vector3<F> raised = componentwise(in[0], [&](const F &x) { return select(x > zero, pow(x, exponent), x); });
  return solid(select(exponent == zero, Vector3<F>(F(1.0f)), raised));
}

template <class F> Value<F> invert_node(const Inputs<F> &in) {
  const F factor = in.scalar(0), one(1.0f);
  const Vector3<F> color = in[1];
  return solid(factor * (Vector3<F>(one) - color) + F(one - factor) * color);
}

template <class F> Value<F> color_model_node(const Inputs<F> &in) {
  const Vector3<F> c = in[0];
  switch (in.node.option) {
  case ColorModel::ToHsv:
    return solid(to_hsv(c));
  case ColorModel::FromHsv:
    return solid(from_hsv(c));
  case ColorModel::ToHsl:
    return solid(to_hsl(c));
  default:
    return solid(from_hsl(c));
  }
}

template <class In, class F = typename In::Number> Value<F> grey_node(const In &in) {
  const float *weights = in.node.matrix;
  return scalar(F(dot(in[0], Vector3<F>(F(weights[0]), F(weights[1]), F(weights[2])))));
}

template <class In, class F = typename In::Number> Value<F> separate_node(const In &in) {
  const Vector3<F> v = in[0];
  return scalar(in.node.option == 0 ? v.x : in.node.option == 1 ? v.y : v.z);
}
template <class In, class F = typename In::Number> Value<F> combine_node(const In &in) {
  return solid(Vector3<F>(in.scalar(0), in.scalar(1), in.scalar(2)));
}

} // namespace
} // namespace lancer
