#include "render/session.h"

#include "render/pilot.h"
#include "scene/error.h"

#include <cmath>

namespace lancer {

namespace {

constexpr uint32_t kMostThreads = 1024;
constexpr uint32_t kMostBounces = 1024;
constexpr uint32_t kMostSplits = 16;
// Glass doubles the rays of CLASSIC with every depth.
constexpr uint32_t kDeepestRecursion = 16;

void check_choice(const char *what, uint32_t value, uint32_t last) {
  if (value > last)
    bad_argument(std::string("settings: ") + what + " " + std::to_string(value) + " is not one of 0 ... " +
                 std::to_string(last));
}

void check_most(const char *what, uint32_t value, uint32_t most) {
  if (value > most)
    bad_argument(std::string("settings: ") + what + " " + std::to_string(value) + " > " + std::to_string(most));
}

void check_amount(const char *what, float value) {
  if (!(value >= 0.0f) || !std::isfinite(value))
    bad_argument(std::string("settings: ") + what + " " + std::to_string(value) + " must be finite and not negative");
}

} // namespace

FilterKind read_filter(uint32_t filter, float width) {
  check_choice("pixel_filter", filter, LANCER_FILTER_BLACKMAN_HARRIS);
  if (!(width > 0.0f) || !std::isfinite(width))
    bad_argument("settings: filter_width " + std::to_string(width) + " must be finite and positive");
  return static_cast<FilterKind>(filter);
}

SessionSettings read_settings(const lancer_settings &source) {
  check_choice("integrator", source.integrator, LANCER_NORMALS);
  check_choice("features", source.features, LANCER_FEATURES_ALL);
  check_amount("contribution_threshold", source.contribution_threshold);
  check_amount("clamp_indirect", source.clamp_indirect);
  check_amount("glass_roughness", source.glass_roughness);
  check_amount("alpha_threshold", source.alpha_threshold);
  check_amount("occlusion_distance", source.occlusion_distance);
  check_amount("mist_start", source.mist_start);
  check_amount("mist_depth", source.mist_depth);
  check_amount("mist_falloff", source.mist_falloff);
  check_most("max_bounces", source.max_bounces, kMostBounces);
  if (source.integrator == LANCER_CLASSIC && source.max_bounces > kDeepestRecursion)
    bad_argument("settings: max_bounces " + std::to_string(source.max_bounces) + " > " + std::to_string(kDeepestRecursion) +
                 ", the deepest recursion of CLASSIC");
  check_most("split_lights", source.split_lights, kMostSplits);
  check_most("split_paths", source.split_paths, kMostSplits);
  check_most("transparent_bounces", source.transparent_bounces, kMostBounces);
  check_most("transparent_shadows", source.transparent_shadows, kMostBounces);
  check_most("threads", source.threads, kMostThreads);
  if (source.passes >> LANCER_PASS_COUNT)
    bad_argument("settings: passes " + std::to_string(source.passes) + " has bits beyond the last pass");
  SessionSettings settings;
  settings.integrator.kind = static_cast<IntegratorKind>(source.integrator);
  settings.integrator.samples = source.samples;
  settings.integrator.seed = source.seed;
  settings.integrator.max_bounces = source.max_bounces;
  settings.integrator.contribution_threshold = source.contribution_threshold;
  settings.integrator.clamp_indirect = source.clamp_indirect;
  settings.integrator.splits = {std::max(source.split_lights, 1u), std::max(source.split_paths, 1u)};
  settings.finds_splits = settings.integrator.kind == IntegratorKind::Path && source.samples >= Pilot::kLeastPlanned &&
                          source.split_lights == 0 && source.split_paths == 0;
  settings.integrator.filter = read_filter(source.pixel_filter, source.filter_width);
  settings.integrator.filter_width = source.filter_width;
  settings.integrator.film_transparent = source.film_transparent != 0;
  settings.integrator.transparent_glass = source.film_transparent && source.transparent_glass;
  settings.integrator.glass_alpha2 = source.glass_roughness * source.glass_roughness;
  settings.integrator.transparent_bounces = source.transparent_bounces;
  settings.integrator.transparent_shadows = source.transparent_shadows;
  settings.integrator.alpha_threshold = source.alpha_threshold;
  settings.integrator.environment_reflections = source.environment_reflections != 0;
  settings.integrator.occlusion_distance = double(source.occlusion_distance);
  settings.integrator.mist_start = source.mist_start;
  settings.integrator.mist_depth = source.mist_depth;
  settings.integrator.mist_falloff = source.mist_falloff;
  settings.integrator.blended_features = source.blended_features != 0;
  // The film computes the error itself; samples do not contain it.
  settings.integrator.passes = source.passes & ~bit(Pass::Error);
  settings.integrator.all_features = source.features == LANCER_FEATURES_ALL;
  settings.passes = settings.integrator.passes;
  settings.refines = source.refines != 0;
  settings.threads = source.threads;
  settings.tile_size = source.tile_size;
  return settings;
}

} // namespace lancer
