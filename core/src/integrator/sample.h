// The interface of integrators: settings, batches of pixel samples, and their results.
#pragma once

#include "compile/scene.h"
#include "integrator/exact_sum.h"
#include "integrator/extras.h"
#include "integrator/settings_table.h"
#include "sampling/pixel_filter.h"
#include "scene/camera.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace lancer {

enum class IntegratorKind : uint32_t { Path = 0, Classic = 1, Normals = 2 };

// Splitting of a sample (Arvo, Kirk, "Particle transport and image synthesis", 1990). The sample splits at the first surface
// that scatters its path into more than single directions. A surface that its path passes straight may also take several light
// samples. The place on the pixel and the path before the split are shared.
struct Splits {
  uint32_t lights = 1; // lights sampled there
  uint32_t paths = 1;  // paths continued from there

  bool any() const { return lights > 1 || paths > 1; }
  bool operator==(const Splits &) const = default;
};

constexpr uint32_t bit(Pass pass) { return 1u << static_cast<uint32_t>(pass); }

// Kinds of settings, see lancer_settings.
enum class SettingKind { Choice, Number, Amount, Width, Switch, Bits };
template <SettingKind kind>
using SettingOf =
    std::conditional_t<kind == SettingKind::Switch, bool,
                       std::conditional_t<kind == SettingKind::Amount || kind == SettingKind::Width, float, uint32_t>>;

struct Bake;
struct CameraMoments;

struct IntegratorSettings {
#define LANCER_MEMBER(kind, name, given, most) SettingOf<SettingKind::kind> name = given;
  LANCER_SETTINGS(LANCER_MEMBER)
#undef LANCER_MEMBER
  Splits splits{};                           // as the settings say, or as a pilot has found
  const std::atomic<bool> *cancel = nullptr; // raised: a batch may end with invalid results
  const Bake *bake = nullptr;                // of a bake, PATH
  const CameraMoments *moments = nullptr;    // of the camera, for the pass Vector; null: it stands still

  IntegratorKind kind() const { return static_cast<IntegratorKind>(integrator); }
  FilterKind filter() const { return static_cast<FilterKind>(pixel_filter); }
  ExtraLayout extras() const { return {light_groups, aov_colors, aov_values, mattes, catchers != 0}; }
  bool all_features() const { return features != 0; }
  // Whether glass of at most this alpha_x alpha_y leaves the film transparent.
  bool clear_glass(float alpha2) const {
    return film_transparent && transparent_glass && alpha2 <= glass_roughness * glass_roughness;
  }
  bool cancelled() const { return cancel && *cancel; }
};

// The address of one sample: pixel of the region and number.
struct SampleAddress {
  uint32_t x, y, sample;
};

// Parts of the light, in the order of the passes from Pass::Emission on.
enum LightPass : uint32_t {
  kLightEmission = 0,
  kLightEnvironment = 1,
  kLightOcclusion = 2,
  kLightComponents = 3, // then direct, indirect, colour of diffuse, glossy, transmission
  kLightPasses = 12
};

// Paths that measure what limits do: their light goes into no film. Bounces: of a path that a limit of kinds ends; Caustics: of
// the lobes that a path lacks; these go on without the limits. The others go on in pairs with the same numbers, one as the
// settings say and one without a setting, whose light differs by what the setting changes: Blurred and Sharp by filter_glossy,
// Guessed and Followed by fast_bounces.
enum class Ghost : uint8_t { None = 0, Bounces, Caustics, Blurred, Sharp, Guessed, Followed };

// One of so many paths that a limit changes sends a ghost or a pair of ghosts, which stand for all.
constexpr uint32_t paths_of(Ghost ghost) {
  return ghost == Ghost::None ? 1 : ghost == Ghost::Bounces || ghost == Ghost::Caustics ? 16 : 64;
}
// Whether a path obeys the limits of kinds of bounces and of caustics.
inline bool obeys_limits(Ghost ghost) { return ghost != Ghost::Bounces && ghost != Ghost::Caustics; }

// The contribution of one sample to the film. All members are floats; those that the film sums are in the order of their
// passes.
struct SampleResult {
  glm::vec3 radiance{0.0f};
  float alpha = 0.0f; // 1 from the camera stage, less what holdouts and a transparent film take
  glm::vec3 normal{0.0f};
  glm::vec3 albedo{0.0f};
  glm::vec3 uv{0.0f};
  float mist = 0.0f; // the share of light that mist leaves
  // The light passes, set only where settings request them: parts of radiance, occlusion, and the colours that divide parts.
  glm::vec3 light[kLightPasses];
  glm::vec3 denoising_normal{0.0f}; // camera space
  float denoising_depth = 0.0f;
  glm::vec3 specular_albedo{0.0f};
  float roughness = 0.0f;
  glm::vec4 vector{0.0f};     // see aov/vectors.h
  float vector_weight = 0.0f; // 1 where there is a vector
  // The hit of the camera ray.
  float depth = 1e10f; // user's units along the camera's z, of a panorama: distance; 1e10: no hit
  glm::vec3 position{0.0f};
  float object_index = 0.0f, material_index = 0.0f;

  explicit SampleResult(bool with_light = false) {
    if (with_light)
      std::fill(light, light + kLightPasses, glm::vec3(0.0f));
  }
};

// Multiplies all light of a result, but not the colours and the occlusion of passes.
inline void expose(SampleResult &result, float exposure, bool with_light) {
  result.radiance *= exposure;
  for (uint32_t i = 0; i < kLightPasses && with_light; ++i)
    if (i != kLightOcclusion && (i < kLightComponents || (i - kLightComponents) % 3 != 2))
      result.light[i] *= exposure;
}

struct RayCounts {
  uint64_t camera = 0, bounce = 0, shadow = 0;

  RayCounts &operator+=(const RayCounts &other) {
    camera += other.camera;
    bounce += other.bounce;
    shadow += other.shadow;
    return *this;
  }
  RayCounts &operator-=(const RayCounts &other) {
    camera -= other.camera;
    bounce -= other.bounce;
    shadow -= other.shadow;
    return *this;
  }
};

// Luminance that clamping removes, and that of the last bounces, summed over samples.
struct Energy {
  ExactSum clipped, clipped_direct; // by clamping of indirect and of direct light
  ExactSum cut, no_caustics;        // by limits of kinds of bounces and of lamps, and by the lack of caustics: see Ghost
  ExactSum last, before_last;       // found by the last bounce that is followed, and by the one before
  // Light that a setting takes away from each sample, negative where it adds light, and its square.
  struct Change {
    ExactSum sum, squares;

    // Ignores values that are not finite, because the film drops their sample.
    void add(float light) {
      if (const float square = light * light; std::isfinite(square)) {
        sum += light;
        squares += square;
      }
    }
  };
  Change filtered, guessed; // by filter_glossy, by Fast GI: fast_bounces and ambient

  // The sums in the order of lancer.h.
  static constexpr uint32_t kSums = 10;
  template <class Of> static std::array<decltype(&std::declval<Of &>().clipped), kSums> sums(Of &energy) {
    return {&energy.clipped,     &energy.clipped_direct, &energy.cut,          &energy.no_caustics,
            &energy.last,        &energy.before_last,    &energy.filtered.sum, &energy.filtered.squares,
            &energy.guessed.sum, &energy.guessed.squares};
  }

  // Returns an estimate of the light of all bounces beyond the last: the sum of a geometric series with the ratio of the last
  // two bounces. Once indirect light has spread, it falls off at least as fast as this series. Returns infinity if the last
  // bounce finds no less light than the bounce before.
  double beyond() const {
    // With negative emission, the light found by a bounce may be negative.
    const double found = std::abs(last.value()), before = std::abs(before_last.value());
    if (found <= 0.0)
      return 0.0;
    return found < before ? found * found / (before - found) : std::numeric_limits<double>::infinity();
  }
  // Adds removed light to a sum. Ignores values that are not finite, because the film drops their sample.
  static void remove(ExactSum &sum, float light) { sum += std::isfinite(light) ? std::abs(light) : 0.0f; }
  Energy &operator+=(const Energy &other) {
    for (uint32_t i = 0; i < kSums; ++i)
      *sums(*this)[i] += *sums(other)[i];
    return *this;
  }
  Energy &operator-=(const Energy &other) {
    for (uint32_t i = 0; i < kSums; ++i)
      *sums(*this)[i] -= *sums(other)[i];
    return *this;
  }
};

// One vertex of a replayed sample, in the user's units.
struct PathVertex {
  glm::dvec3 position{0.0};
  double t = 0.0;
  glm::vec3 normal{0.0f}, beta{0.0f}, radiance{0.0f};
  uint32_t instance = kNone, primitive = kNone, material = kNone, depth = 0;
};

// Computes samples in batches. One object per thread: it keeps its queues between batches.
class Integrator {
public:
  virtual ~Integrator() = default;
  // Writes the sample of addresses[i] to results[i]; trace (may be null) collects the vertices of a batch of one.
  virtual void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                   std::vector<PathVertex> *trace) = 0;
  // Sets how samples split in the following batches, for integrators that split.
  virtual void set_splits(const Splits &) {}
  // Returns the integrator's name, for the statistics.
  virtual const char *name() const = 0;
  // Return totals since the start: rays, and vertices on surfaces.
  const RayCounts &counts() const { return counts_; }
  uint64_t vertices() const { return vertices_; }
  // Returns the energy of the last batch.
  const Energy &energy() const { return energy_; }
  // Returns the extras of the last batch, by number of its samples.
  const Extras &extras() const { return extras_; }

protected:
  RayCounts counts_;
  uint64_t vertices_ = 0;
  Energy energy_;
  Extras extras_;
};

// scene and camera must outlive the integrator.
std::unique_ptr<Integrator> make_integrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);

} // namespace lancer
