#include "render/session.h"

#include "scene/messages.h"

#include <cmath>

namespace lancer {

namespace {

[[noreturn]] void refuse(const char *name, const std::string &value, const std::string &why) {
  bad_argument("settings: " + std::string(name) + " " + value + why);
}

// Checks one setting. most: its largest value.
template <SettingKind kind, class Value> void check(const char *name, Value value, [[maybe_unused]] uint32_t most) {
  if constexpr (kind == SettingKind::Choice) {
    if (value > most)
      refuse(name, std::to_string(value), " is not one of 0 ... " + std::to_string(most));
  } else if constexpr (kind == SettingKind::Number) {
    if (value > most)
      refuse(name, std::to_string(value), " > " + std::to_string(most));
  } else if constexpr (kind == SettingKind::Bits) {
    if (value > most)
      refuse(name, std::to_string(value), " has bits beyond the last pass");
  } else if constexpr (kind == SettingKind::Amount) {
    if (!(value >= 0.0f) || !std::isfinite(value))
      refuse(name, std::to_string(value), " must be finite and not negative");
  } else if constexpr (kind == SettingKind::Width) {
    if (!(value > 0.0f) || !std::isfinite(value))
      refuse(name, std::to_string(value), " must be finite and positive");
  }
}

} // namespace

FilterKind read_filter(uint32_t filter, float width) {
  check<SettingKind::Choice>("pixel_filter", filter, LANCER_FILTER_BLACKMAN_HARRIS);
  check<SettingKind::Width>("filter_width", width, 0);
  return static_cast<FilterKind>(filter);
}

IntegratorSettings read_settings(const lancer_settings &source) {
  IntegratorSettings settings;
#define LANCER_READ(kind, name, given, most)                                                                                   \
  check<SettingKind::kind>(#name, source.name, most);                                                                          \
  settings.name = static_cast<decltype(settings.name)>(source.name);
  LANCER_SETTINGS(LANCER_READ)
#undef LANCER_READ
  if (settings.kind() == IntegratorKind::Classic && settings.max_bounces > LANCER_DEEPEST_RECURSION)
    refuse("max_bounces", std::to_string(settings.max_bounces),
           " > " + std::to_string(LANCER_DEEPEST_RECURSION) + ", the deepest recursion of CLASSIC");
  settings.splits = {std::max(settings.split_lights, 1u), std::max(settings.split_paths, 1u)};
  // The film computes the error itself; samples do not contain it.
  settings.passes &= ~bit(Pass::Error);
  // The shadows of catchers lie over the environment.
  if (settings.catchers == LANCER_CATCHERS_SHADOWS && !settings.film_transparent)
    settings.passes |= bit(Pass::Environment);
  // Samples contain the passes whose halves are requested.
  for (uint32_t pass = 0; pass < kPassCount; ++pass)
    if (settings.passes & 1u << pass)
      settings.passes |= bit(halved(static_cast<Pass>(pass)));
  return settings;
}

} // namespace lancer
