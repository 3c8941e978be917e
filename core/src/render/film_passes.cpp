// The passes of a film: their channels, their place in a sample, and their reading, also of the luminances with errors.
#include "render/film.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cstddef>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <type_traits>

namespace lancer {

static_assert(uint32_t(LANCER_PASS_EMISSION) + kLightPasses == LANCER_PASS_TRANSMISSION_COLOR + 1);
static_assert(uint32_t(LANCER_PASS_EMISSION) + kLightComponents == LANCER_PASS_DIFFUSE_DIRECT);

uint32_t channels(Pass pass) {
  switch (pass) {
  case Pass::Combined:
  case Pass::Vector:
    return 4;
  case Pass::Depth:
  case Pass::ObjectIndex:
  case Pass::MaterialIndex:
  case Pass::Mist:
  case Pass::DenoisingDepth:
  case Pass::Error:
  case Pass::Roughness:
    return 1;
  default:
    return 3;
  }
}

uint32_t kept_channels(Pass pass) { return channels(pass) + (pass == Pass::Vector ? 1 : 0); }

bool of_first_sample(Pass pass) {
  return pass == Pass::Depth || pass == Pass::Position || pass == Pass::ObjectIndex || pass == Pass::MaterialIndex;
}

Pass divisor(Pass pass) {
  if (pass < Pass::DiffuseDirect || pass > Pass::TransmissionColor)
    return pass;
  // Three passes for each component, the colour last.
  const uint32_t component = (uint32_t(pass) - uint32_t(Pass::DiffuseDirect)) / 3;
  return static_cast<Pass>(uint32_t(Pass::DiffuseColor) + 3 * component);
}

Pass halved(Pass pass) {
  switch (pass) {
  case Pass::Halves:
    return Pass::Combined;
  case Pass::AlbedoHalves:
    return Pass::Albedo;
  case Pass::NormalHalves:
    return Pass::DenoisingNormal;
  default:
    return pass;
  }
}

uint32_t kept_passes(uint32_t passes) {
  uint32_t kept = bit(Pass::Combined);
  for (uint32_t number = 0; number < kPassCount; ++number) {
    const auto pass = static_cast<Pass>(number);
    if (!(passes & bit(pass)) || pass == Pass::Error)
      continue;
    // Halves follow from the sums of their pass.
    kept |= bit(halved(pass)) | bit(divisor(halved(pass)));
  }
  return kept;
}

#define LANCER_PLACE(member) uint32_t(offsetof(SampleResult, member) / sizeof(float))
uint32_t place_in_sample(Pass pass) {
  static_assert(std::is_standard_layout_v<SampleResult> && alignof(SampleResult) == alignof(float));
  switch (pass) {
  case Pass::Combined:
    return LANCER_PLACE(radiance);
  case Pass::Depth:
    return LANCER_PLACE(depth);
  case Pass::Normal:
    return LANCER_PLACE(normal);
  case Pass::Albedo:
    return LANCER_PLACE(albedo);
  case Pass::Position:
    return LANCER_PLACE(position);
  case Pass::ObjectIndex:
    return LANCER_PLACE(object_index);
  case Pass::MaterialIndex:
    return LANCER_PLACE(material_index);
  case Pass::Uv:
    return LANCER_PLACE(uv);
  case Pass::Mist:
    return LANCER_PLACE(mist);
  case Pass::DenoisingNormal:
    return LANCER_PLACE(denoising_normal);
  case Pass::DenoisingDepth:
    return LANCER_PLACE(denoising_depth);
  case Pass::SpecularAlbedo:
    return LANCER_PLACE(specular_albedo);
  case Pass::Roughness:
    return LANCER_PLACE(roughness);
  case Pass::Vector:
    return LANCER_PLACE(vector);
  default:
    return LANCER_PLACE(light) + 3 * (uint32_t(pass) - uint32_t(Pass::Emission));
  }
}
#undef LANCER_PLACE

glm::dvec3 divide_by_color(const glm::dvec3 &light, const glm::dvec3 &color) {
  glm::dvec3 quotient(0.0);
  double sum = 0.0;
  int colored = 0;
  for (int i = 0; i < 3; ++i) {
    if (color[i] == 0.0)
      continue;
    quotient[i] = light[i] / color[i];
    sum += quotient[i];
    ++colored;
  }
  for (int i = 0; i < 3 && colored > 0; ++i) {
    if (color[i] == 0.0)
      quotient[i] = sum / colored;
  }
  return quotient;
}

namespace {

// Depth of a pixel without samples.
constexpr float kNothing = 1e10f;

} // namespace

void Film::read(Pass pass, std::span<float> out) const {
  const uint32_t width = channels(pass);
  for (const auto &tile : tiles_) {
    const std::lock_guard lock(tile->mutex);
    for (uint32_t pixel = 0; pixel < tile->pixels(); ++pixel) {
      const glm::uvec2 at = tile->place(pixel);
      float *target = out.data() + (size_t(at.y) * width_ + at.x) * width;
      if (tile->count == 0)
        std::fill_n(target, width, pass == Pass::Depth ? kNothing : 0.0f);
      else if (of_first_sample(pass) && tile->first.empty())
        std::fill_n(target, width, pass == Pass::Depth ? kNothing : 0.0f);
      else if (of_first_sample(pass))
        std::copy_n(tile->first.data() + size_t(pixel) * layout_.first_channels + layout_.at[uint32_t(pass)], width, target);
      else if (halved(pass) != pass)
        read_halves(pass, *tile, pixel, target);
      else
        read_means(pass, *tile, pixel, target);
    }
  }
}

double Film::sum_of(const Tile &tile, size_t place) {
  // Join the waiting sums, later and smaller ones first, as the tree would.
  double sum = 0.0;
  for (auto node = tile.nodes.rbegin(); node != tile.nodes.rend(); ++node)
    sum = node->sums.channels[place] + sum;
  return sum;
}

void Film::read_means(Pass pass, const Tile &tile, uint32_t pixel, float *target) const {
  const size_t place = size_t(pixel) * layout_.summed_channels;
  const auto total = [&](Pass of, uint32_t channel) { return sum_of(tile, place + layout_.at[uint32_t(of)] + channel); };
  const auto mean = [&](Pass of, uint32_t channel) { return total(of, channel) / double(tile.count); };
  const auto color = [&](Pass of) { return glm::dvec3(mean(of, 0), mean(of, 1), mean(of, 2)); };
  if (divisor(pass) != pass) {
    // A colour may be so dark that the quotient exceeds the range of float.
    const glm::vec3 light = nearest_float(divide_by_color(color(pass), color(divisor(pass))));
    for (int i = 0; i < 3; ++i)
      target[i] = light[i];
  } else if (pass == Pass::Vector) {
    const double weight = total(pass, 4);
    for (uint32_t c = 0; c < channels(pass); ++c)
      target[c] = weight > 0.0 ? float(total(pass, c) / weight) : 0.0f;
  } else if (pass == Pass::Mist) {
    // Samples sum up the share without mist; the sky is all mist.
    target[0] = float(std::clamp(1.0 - mean(pass, 0), 0.0, 1.0));
  } else {
    // Samples of ambient occlusion are 1 minus the occlusion and may be negative: clamp the mean at 0.
    const float least = uint32_t(pass) == LANCER_PASS_AMBIENT_OCCLUSION ? 0.0f : -std::numeric_limits<float>::infinity();
    for (uint32_t c = 0; c < channels(pass); ++c)
      target[c] = std::max(float(mean(pass, c)), least);
  }
}

template <class Value, class MeanOf, class DifferenceOf, class Part>
Value Film::join_halves(const Tile &tile, MeanOf &&mean_of, DifferenceOf &&difference_of, Part &&part) {
  Value mean(0.0);
  for (const Node &node : tile.nodes) {
    const double share = double(1u << node.level) / double(tile.count);
    const Value of_sums = mean_of(node.sums, node.level);
    // A single sample is compared with the mean of all samples before it.
    part(share, node.level > 0 ? 0.5 * Value(difference_of(node.sums)) : of_sums - mean / (1.0 - share));
    mean += share * of_sums;
  }
  return mean;
}

void Film::read_halves(Pass pass, const Tile &tile, uint32_t pixel, float *target) const {
  glm::dvec3 sum(0.0);
  const size_t place = size_t(pixel) * layout_.difference_channels + layout_.at[uint32_t(pass)];
  if (tile.whole() && tile.count >= kLeastSamples)
    join_halves<glm::dvec3>(
        tile, [&](const Sums &sums, uint32_t level) { return mean_color(halved(pass), sums, level, pixel); },
        [&](const Sums &sums) { return glm::make_vec3(sums.color_differences.data() + place); },
        [&](double share, const glm::dvec3 &apart) { sum += share * apart; });
  for (int i = 0; i < 3; ++i)
    target[i] = nearest_float(sum[i]);
}

uint32_t Film::luminances(const Tile &tile, std::span<Luminance> out) const {
  const std::lock_guard lock(tile.mutex);
  if (!tile.whole() || tile.count < kLeastSamples)
    return 0;
  for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel) {
    double variance = 0.0;
    const auto mean = join_halves<double>(
        tile, [&](const Sums &sums, uint32_t level) { return mean_luminance(sums, level, pixel); },
        [&](const Sums &sums) { return sums.differences[pixel]; },
        [&](double share, double apart) { variance += share * share * apart * apart; });
    out[pixel] = {mean, variance, double(tile.brightest[pixel])};
  }
  return tile.count;
}

} // namespace lancer
