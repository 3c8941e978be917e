// A surface's whole answer: a sum of lobes with one way to evaluate it and one to sample it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "bsdf/blinn_phong.h"
#include "bsdf/dielectric.h"
#include "bsdf/lambert.h"
#include "bsdf/lobe.h"
#include "bsdf/microfacet_lobe.h"
#include "bsdf/mirror.h"
#include "bsdf/phong.h"

namespace lancer {

constexpr uint32_t lobe_bit(LobeKind kind) { return 1u << static_cast<uint32_t>(kind); }
inline constexpr uint32_t kAllLobes = (1u << 6) - 1u;
inline constexpr int kMaxLobes = 8;

struct BsdfValue {
  glm::vec3 f{0.0f};
  float pdf = 0.0f;
};

// Contract
//   Frame     local, n = +z; wo and wi are unit and point away from the surface. wo.z < 0: seen from behind. All lobes act
//   alike on
//             both sides, except Dielectric, whose inside is z < 0.
//   f         1/sr, without the cosine; only smooth lobes: a delta lobe is 0 in every given direction.
//   pdf       density per solid angle of wi with which sample takes a smooth lobe into wi. It integrates to 1 minus the
//             probability of delta lobes minus what falls below the horizon.
//   sample    weight = f |cos(wi)| / pdf over all smooth lobes together, or the delta lobe's weight / probability.
//             Weight 0 = no sample: the path ends there.
//   Zero      wo.z = 0 has no side: f = 0, pdf = 0, no sample. Parameters must be finite and not negative; ior may be infinite.
//   Lobes     bits lobe_bit(kind) of the kinds that can occur; the code of others is left out, the results are the same.
struct Bsdf {
  Lobe lobes[kMaxLobes];
  int count = 0;

  template <uint32_t Lobes = kAllLobes> BsdfValue eval_pdf(glm::vec3 wo, glm::vec3 wi) const {
    if (!to_upper_side(wo, wi))
      return {};
    float probability[kMaxLobes];
    if (!choose_probabilities<Lobes>(wo, probability))
      return {};
    return smooth_eval_pdf<Lobes>(wo, wi, needs_half_vector<Lobes>() ? half_vector(wo, wi) : glm::vec3(0.0f), probability);
  }

  template <uint32_t Lobes = kAllLobes> glm::vec3 eval(const glm::vec3 &wo, const glm::vec3 &wi) const {
    return eval_pdf<Lobes>(wo, wi).f;
  }

  template <uint32_t Lobes = kAllLobes> float pdf(const glm::vec3 &wo, const glm::vec3 &wi) const {
    return eval_pdf<Lobes>(wo, wi).pdf;
  }

  // u_lobe picks the lobe, u the direction; all in [0, 1).
  template <uint32_t Lobes = kAllLobes> BsdfSample sample(glm::vec3 wo, float u_lobe, glm::vec2 u) const {
    const bool inside = wo.z < 0.0f;
    wo.z = std::abs(wo.z);
    float probability[kMaxLobes];
    if (!(wo.z > 0.0f) || !choose_probabilities<Lobes>(wo, probability))
      return {};
    // Pick a lobe by the share of light that it is expected to reflect.
    const int chosen = pick(probability, u_lobe);
    const Lobe &lobe = lobes[chosen];
    BsdfSample result;
    if (is_delta<Lobes>(lobe)) {
      const DeltaDirection direction = sample_delta<Lobes>(lobe, wo, inside, u.x);
      result.wi = direction.wi;
      result.weight = lobe.color * (direction.weight / probability[chosen]);
      result.pdf = direction.probability * probability[chosen];
      result.delta = true;
    } else {
      const LobeDirection direction = sample_smooth<Lobes>(lobe, wo, u);
      if (!(direction.wi.z > 0.0f))
        return {};
      // Weigh with the sum over all smooth lobes, whichever was picked; h goes along with all digits of the sampler.
      const BsdfValue value = smooth_eval_pdf<Lobes>(wo, direction.wi, direction.h, probability);
      if (!(value.pdf > 0.0f))
        return {};
      result.wi = direction.wi;
      result.weight = value.f * (direction.wi.z / value.pdf);
      result.pdf = value.pdf;
    }
    if (inside)
      result.wi.z = -result.wi.z;
    return result;
  }

  // The sum of the lobes' colours, for the albedo pass.
  glm::vec3 albedo_color() const {
    glm::vec3 sum(0.0f);
    for (int i = 0; i < count; ++i)
      sum += lobes[i].color;
    return sum;
  }

  bool has_delta() const {
    return std::any_of(lobes, lobes + count, [](const Lobe &lobe) { return is_delta<kAllLobes>(lobe); });
  }
  bool has_smooth() const {
    return std::any_of(lobes, lobes + count, [](const Lobe &lobe) { return !is_delta<kAllLobes>(lobe); });
  }

private:
  template <uint32_t Lobes> static bool is(const Lobe &lobe, LobeKind kind) {
    return (Lobes & lobe_bit(kind)) != 0 && (Lobes == lobe_bit(kind) || lobe.kind == kind);
  }

  template <uint32_t Lobes> static bool is_delta(const Lobe &lobe) {
    return is<Lobes>(lobe, LobeKind::Mirror) || is<Lobes>(lobe, LobeKind::Dielectric) ||
           (is<Lobes>(lobe, LobeKind::Beckmann) && lobe.alpha < kMirrorAlpha);
  }

  template <uint32_t Lobes> static constexpr bool needs_half_vector() {
    return (Lobes & (lobe_bit(LobeKind::Beckmann) | lobe_bit(LobeKind::BlinnPhong))) != 0;
  }

  // Mirrors both directions so that wo lies above. False where no smooth lobe can connect them.
  static bool to_upper_side(glm::vec3 &wo, glm::vec3 &wi) {
    if (wo.z < 0.0f) {
      wo.z = -wo.z;
      wi.z = -wi.z;
    }
    return wo.z > 0.0f && wi.z > 0.0f;
  }

  // The probability of each lobe, proportional to an estimate of its albedo for wo. False where every lobe is black.
  template <uint32_t Lobes> bool choose_probabilities(const glm::vec3 &wo, float *probability) const {
    float sum = 0.0f;
    for (int i = 0; i < count; ++i) {
      const glm::vec3 &color = lobes[i].color;
      probability[i] = std::max(color.x, std::max(color.y, color.z));
      if (is<Lobes>(lobes[i], LobeKind::Beckmann) && count > 1)
        probability[i] *= microfacet_albedo_estimate(lobes[i], wo);
      sum += probability[i];
    }
    if (!(sum > 0.0f))
      return false;
    for (int i = 0; i < count; ++i)
      probability[i] /= sum;
    return true;
  }

  // A lobe of probability 0 is never picked, even where rounding leaves u beyond the last sum.
  int pick(const float *probability, float u) const {
    int last = 0;
    for (int i = 0; i < count; ++i) {
      if (!(probability[i] > 0.0f))
        continue;
      last = i;
      if (u < probability[i])
        break;
      u -= probability[i];
    }
    return last;
  }

  // wo.z > 0 and wi.z > 0; h their half vector.
  template <uint32_t Lobes>
  BsdfValue smooth_eval_pdf(const glm::vec3 &wo, const glm::vec3 &wi, const glm::vec3 &h, const float *probability) const {
    BsdfValue sum;
    for (int i = 0; i < count; ++i) {
      const Lobe &lobe = lobes[i];
      if (is_delta<Lobes>(lobe) || probability[i] == 0.0f)
        continue;
      LobeValue value;
      if (is<Lobes>(lobe, LobeKind::Lambert))
        value = lambert_eval_pdf(wi);
      else if (is<Lobes>(lobe, LobeKind::Beckmann))
        value = microfacet_eval_pdf(lobe, wo, wi, h);
      else if (is<Lobes>(lobe, LobeKind::Phong))
        value = phong_eval_pdf(lobe, wo, wi);
      else if (is<Lobes>(lobe, LobeKind::BlinnPhong))
        value = blinn_phong_eval_pdf(lobe, wo, h);
      sum.f += lobe.color * value.f;
      sum.pdf += probability[i] * value.pdf;
    }
    return sum;
  }

  template <uint32_t Lobes> static LobeDirection sample_smooth(const Lobe &lobe, const glm::vec3 &wo, glm::vec2 u) {
    if (is<Lobes>(lobe, LobeKind::Lambert))
      return lambert_sample(wo, u);
    if (is<Lobes>(lobe, LobeKind::Beckmann))
      return microfacet_sample(lobe, wo, u);
    if (is<Lobes>(lobe, LobeKind::Phong))
      return phong_sample(lobe, wo, u);
    if (is<Lobes>(lobe, LobeKind::BlinnPhong))
      return blinn_phong_sample(lobe, wo, u);
    return {};
  }

  template <uint32_t Lobes> static DeltaDirection sample_delta(const Lobe &lobe, const glm::vec3 &wo, bool inside, float u) {
    if (is<Lobes>(lobe, LobeKind::Mirror))
      return mirror_sample(wo);
    if (is<Lobes>(lobe, LobeKind::Beckmann))
      return smooth_coating_sample(lobe, wo);
    if (is<Lobes>(lobe, LobeKind::Dielectric))
      return dielectric_sample(lobe, wo, inside, u);
    return {};
  }
};

} // namespace lancer
