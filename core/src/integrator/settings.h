// The settings of a render as the core reads them: members, checks and copies are those of lancer.h.
#pragma once

#include "integrator/settings_table.h"
#include "sampling/pixel_filter.h"

#include <atomic>
#include <cstdint>
#include <type_traits>

namespace lancer {

enum class IntegratorKind : uint32_t { Path = 0, Classic = 1, Normals = 2 };

// Splitting of a sample (Arvo, Kirk, "Particle transport and image synthesis", 1990). The sample splits at the first surface of
// its path that scatters into more than single directions. The place on the pixel and the path before the split are shared.
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

struct IntegratorSettings {
#define LANCER_MEMBER(kind, name, given, most) SettingOf<SettingKind::kind> name = given;
  LANCER_SETTINGS(LANCER_MEMBER)
#undef LANCER_MEMBER
  Splits splits{};                           // as the settings say, or as a pilot has found
  const std::atomic<bool> *cancel = nullptr; // raised: a batch may end with invalid results

  IntegratorKind kind() const { return static_cast<IntegratorKind>(integrator); }
  FilterKind filter() const { return static_cast<FilterKind>(pixel_filter); }
  bool all_features() const { return features != 0; }
  // Whether glass of at most this alpha_x alpha_y leaves the film transparent.
  bool clear_glass(float alpha2) const {
    return film_transparent && transparent_glass && alpha2 <= glass_roughness * glass_roughness;
  }
  bool cancelled() const { return cancel && *cancel; }
};

} // namespace lancer
