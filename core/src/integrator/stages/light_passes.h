// The light passes to which a contribution is added: direct or indirect, by the component of the first scattering.
#pragma once

#include "integrator/sample.h"

namespace lancer {

// Light that waits for its shadow ray.
struct WaitingLight {
  uint32_t target = 0, sum = 0; // PATH: number of the sample in its batch, and of its sum of indirect light; CLASSIC: the ray
  uint32_t group = 0;           // of the light, see Extras::add_light()
  bool indirect = false;        // scattered more than once
  Ghost ghost = Ghost::None;    // of the path
  bool of_catchers = false;     // of the path
  float parts = 1.0f;           // number of contributions that share the weight of this one
  bool has_passes = true;       // the light is in passes beside the picture
  bool occlusion = false;       // no light: the pass of ambient occlusion
  bool guessed = false;         // the ambient light of Fast GI
  glm::vec3 share[2] = {glm::vec3(0.0f), glm::vec3(0.0f)}; // diffuse, glossy; the rest is transmission
};

class LightPasses {
public:
  explicit LightPasses(const IntegratorSettings &settings)
      : wanted_((settings.passes & kAnyLight) != 0), components_((settings.passes & kAnyComponent) != 0),
        occlusion_((settings.passes & bit(Pass::AmbientOcclusion)) != 0), mist_((settings.passes & bit(Pass::Mist)) != 0),
        uv_((settings.passes & bit(Pass::Uv)) != 0), guides_((settings.passes & kAnyGuide) != 0),
        places_((settings.passes & kPlaces) != 0),
        only_places_((settings.passes & ~(kPlaces | kAlways)) == 0 && !settings.mattes && !settings.extras().has_outputs()) {}

  // Whether any part of SampleResult::light is requested.
  bool wanted() const { return wanted_; }
  // Whether light by component, or its colour, is requested.
  bool components() const { return components_; }
  bool occlusion() const { return occlusion_; }
  bool mist() const { return mist_; }
  bool uv() const { return uv_; }
  bool guides() const { return guides_; }
  // Whether passes of the first surface's place, which sample 0 decides, are requested; and whether nothing else is requested
  // beside the picture.
  bool places() const { return places_; }
  bool only_places() const { return only_places_; }

  // Adds light that came by a first scattering with these shares.
  void add(SampleResult &result, const glm::vec3 &light, const glm::vec3 (&share)[2], bool indirect) const {
    if (!components_)
      return;
    const uint32_t first = kLightComponents + (indirect ? 1u : 0u);
    const glm::vec3 diffuse = light * share[0], glossy = light * share[1];
    result.light[first] += diffuse;
    result.light[first + 3] += glossy;
    result.light[first + 6] += light - diffuse - glossy;
  }
  // Adds light that the camera sees directly.
  void add_seen(SampleResult &result, const glm::vec3 &light, bool environment) const {
    if (wanted_)
      result.light[environment ? kLightEnvironment : kLightEmission] += light;
  }
  // Scales all indirect light, for clamping.
  void scale_indirect(SampleResult &result, const glm::vec3 &factor) const {
    for (uint32_t component = 0; component < 3 && components_; ++component)
      result.light[kLightComponents + 3 * component + 1] *= factor;
  }

private:
  static constexpr uint32_t kAnyLight = 2u * bit(Pass::TransmissionColor) - bit(Pass::Emission);
  static constexpr uint32_t kAnyComponent = 2u * bit(Pass::TransmissionColor) - bit(Pass::DiffuseDirect);
  static constexpr uint32_t kAnyGuide = bit(Pass::Albedo) | bit(Pass::DenoisingNormal) | bit(Pass::DenoisingDepth) |
                                        bit(Pass::SpecularAlbedo) | bit(Pass::Roughness);
  static constexpr uint32_t kPlaces =
      bit(Pass::Depth) | bit(Pass::Position) | bit(Pass::ObjectIndex) | bit(Pass::MaterialIndex);
  static constexpr uint32_t kAlways = bit(Pass::Combined) | bit(Pass::Error) | bit(Pass::Halves);
  bool wanted_, components_, occlusion_, mist_, uv_, guides_, places_, only_places_;
};

} // namespace lancer
