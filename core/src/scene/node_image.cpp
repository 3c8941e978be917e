// From vectors to pictures: flat, box, sphere and tube projection, tiles, and the environment's maps.
#include "sampling/angle.h"
#include "sampling/elementary.h"
#include "scene/node_site.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lancer {

namespace {

// What stands where a picture is missing.
const glm::vec4 kMissing(1.0f, 0.0f, 1.0f, 1.0f);

const Image *picture(const Inputs &in, const Site &site, uint32_t number) {
  return number < in.node.image_count ? &(*site.context->images)[in.node.image + number] : nullptr;
}

glm::vec4 look_up(const Inputs &in, const Image &image, const glm::vec2 &uv) {
  const uint32_t flags = in.node.flags;
  return lookup(image, uv, static_cast<Extension>(flags & 0xf), static_cast<Interpolation>(flags >> 4 & 0xf), flags & 256);
}

// The tile that holds uv, and uv within it. Like Blender, cuts off the fraction: just below 0 still is the first tile.
const Image *tile_at(const Inputs &in, const Site &site, glm::vec2 &uv) {
  if (!(std::abs(uv.x) < 1e6f) || !(std::abs(uv.y) < 1e6f))
    return nullptr;
  const int across = int(uv.x), up = int(uv.y);
  if (across < 0 || across > 9 || up < 0)
    return nullptr;
  const uint32_t tile = 1001 + uint32_t(across) + 10 * uint32_t(up);
  for (uint32_t i = 0; i < in.node.image_count; ++i) {
    const Image *image = picture(in, site, i);
    if (image->tile != tile)
      continue;
    uv -= glm::vec2(float(across), float(up));
    return image;
  }
  return nullptr;
}

// Longitude and latitude of a box that is -1 ... 1.
glm::vec2 on_sphere(const glm::vec3 &p) {
  if (p == glm::vec3(0.0f))
    return glm::vec2(0.0f);
  const float radius = hypot(p.x, p.y);
  const float u = radius > 0.0f ? 0.5f - atan2(p.x, p.y) / glm::two_pi<float>() : 0.0f;
  return {u, 0.5f + atan2(p.z, radius) / glm::pi<float>()};
}

glm::vec2 on_tube(const glm::vec3 &p) {
  if (p.x == 0.0f && p.y == 0.0f)
    return glm::vec2(0.0f);
  return {0.5f - atan2(p.x, p.y) / glm::two_pi<float>(), 0.5f * (p.z + 1.0f)};
}

// Shares of the three sides of a box for a normal with n.x + n.y + n.z = 1, all positive. Think of a triangle whose corners are
// the sides: near a corner one picture stands alone, near an edge two are mixed, in the middle three.
glm::vec3 box_shares(const glm::vec3 &n, float blend) {
  const float limit = 0.5f * (1.0f + blend);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    glm::vec3 alone(0.0f);
    alone[i] = 1.0f;
    if (n[i] > limit * (n[i] + n[j]) && n[i] > limit * (n[i] + n[k]))
      return alone;
  }
  if (!(blend > 0.0f))
    return {1.0f, 0.0f, 0.0f};
  // Leave out z, x, y in turn.
  for (const int out : {2, 0, 1}) {
    const int i = out == 0 ? 1 : 0, j = out == 2 ? 1 : 2;
    if (!(n[out] < (1.0f - limit) * (n[i] + n[j])))
      continue;
    glm::vec3 shares(0.0f);
    shares[i] = glm::clamp((n[i] / (n[i] + n[j]) - 0.5f * (1.0f - blend)) / blend, 0.0f, 1.0f);
    shares[j] = 1.0f - shares[i];
    return shares;
  }
  return ((2.0f - limit) * n + (limit - 1.0f)) / (2.0f * limit - 1.0f);
}

glm::vec4 box(const Inputs &in, const Site &site, const Image &image) {
  const glm::vec3 p = in[0], n = site.normal_to_object(site.ns);
  const glm::vec3 size = glm::abs(n);
  const float sum = size.x + size.y + size.z;
  const glm::vec3 shares = box_shares(sum > 0.0f ? size / sum : glm::vec3(1.0f, 0.0f, 0.0f), in.scalar(1));
  // Turn each side so that no picture is mirrored.
  const glm::vec2 places[3] = {
      {n.x < 0.0f ? 1.0f - p.y : p.y, p.z}, {n.y > 0.0f ? 1.0f - p.x : p.x, p.z}, {n.z > 0.0f ? 1.0f - p.y : p.y, p.x}};
  glm::vec4 result(0.0f);
  for (int i = 0; i < 3; ++i)
    if (shares[i] > 0.0f)
      result += shares[i] * look_up(in, image, places[i]);
  return result;
}

// The side that a direction leaves a cube through, and where; upright for one who stands inside with +z up, and for +z and -z
// for one who looks towards +y first and then raises or lowers his head.
glm::vec4 cube(const Inputs &in, const Site &site, const glm::vec3 &d) {
  const glm::vec3 size = glm::abs(d);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const bool negative = d[axis] < 0.0f;
  const Image *image = picture(in, site, uint32_t(2 * axis + negative));
  if (!image)
    return kMissing;
  if (size[axis] == 0.0f)
    return glm::vec4(0.0f);
  const float sign = negative ? -1.0f : 1.0f;
  const glm::vec2 right_up = axis == 0   ? glm::vec2(-sign * d.y, d.z)
                             : axis == 1 ? glm::vec2(sign * d.x, d.z)
                                         : glm::vec2(d.x, -sign * d.y);
  return look_up(in, *image, 0.5f + 0.5f * right_up / size[axis]);
}

} // namespace

glm::vec4 image(const Inputs &in, const Site &site) {
  const Image *first = picture(in, site, 0);
  if (!first)
    return kMissing;
  const glm::vec3 p = in[0];
  glm::vec2 uv(p);
  switch (in.node.option) {
  case LANCER_PROJECT_BOX:
    return box(in, site, *first);
  case LANCER_PROJECT_SPHERE:
    uv = on_sphere(2.0f * p - 1.0f);
    break;
  case LANCER_PROJECT_TUBE:
    uv = on_tube(2.0f * p - 1.0f);
    break;
  default:
    break;
  }
  if (first->tile != 0)
    first = tile_at(in, site, uv);
  return first ? look_up(in, *first, uv) : kMissing;
}

glm::vec4 environment(const Inputs &in, const Site &site) {
  if (in.node.option == LANCER_ENVIRONMENT_CUBE)
    return cube(in, site, unit_or_zero(in[0]));
  const Image *first = picture(in, site, 0);
  if (!first)
    return kMissing;
  glm::vec2 uv(0.0f);
  if (in.node.option == LANCER_ENVIRONMENT_MIRROR_BALL) {
    // The ball, seen along +y, is bent half way between the viewer and d.
    const glm::vec3 d = unit_or_zero(in[0]), half(d.x, d.y - 1.0f, d.z);
    const float size = 2.0f * std::sqrt(std::max(-0.5f * half.y, 0.0f));
    uv = 0.5f * (glm::vec2(half.x, half.z) / (size > 0.0f ? size : 1.0f) + 1.0f);
  } else if (const glm::dvec3 d(in[0]); d != glm::dvec3(0.0)) {
    const MapPlace<double> place = place_on_map(d.x, d.y, d.z, std::sqrt(d.x * d.x + d.y * d.y));
    uv = {float(0.5 - place.x), float(0.5 + place.y)};
  }
  return look_up(in, *first, uv);
}

} // namespace lancer
