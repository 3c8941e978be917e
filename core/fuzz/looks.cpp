#include "looks.h"

#include "checked.h"
#include "probes.h"

#include <cmath>
#include <string>

namespace lancer_fuzz {

namespace {

void replay(lancer_session session, const SessionState *state, Bytes &bytes) {
  float rgba[4];
  lancer_vertex vertices[4];
  uint32_t count = 0;
  const uint32_t x = state ? bytes.reference(state->camera.region_width) : 0,
                 y = state ? bytes.reference(state->camera.region_height) : 0;
  const uint32_t sample = bytes.below(3), capacity = bytes.below(5);
  LANCER_CHECKED(lancer_debug_sample(session, x, y, sample, rgba, vertices, capacity, &count));
}

bool asks_for_numbered(const lancer_settings &settings) {
  return (settings.mattes | settings.light_groups | settings.aov_colors | settings.aov_values | settings.catchers) != 0;
}

void read_numbered(lancer_session session, size_t pixels) {
  std::vector<float> picture;
  for (uint32_t kind = LANCER_PASS_KIND_OBJECT_MATTES; kind <= LANCER_PASS_KIND_CATCHER_MATTE + 1; ++kind)
    for (const uint32_t number : {0u, 1u, 1023u})
      for (const size_t channels : {1, 3, 4}) {
        picture.assign(pixels * channels, NAN);
        const uint32_t pass = kind * LANCER_PASS_SPAN + number;
        // The bits of an id may be any float's.
        if (LANCER_CHECKED(lancer_session_read(session, pass, picture.data(), picture.size())) != LANCER_OK ||
            kind <= LANCER_PASS_KIND_ASSET_MATTES)
          continue;
        for (const float value : picture)
          if (!std::isfinite(value))
            broken("lancer_session_read", ("pass " + std::to_string(pass) + " is not finite").c_str());
      }
}

} // namespace

void wait_for_end(lancer_session session) {
  while (LANCER_CHECKED(lancer_session_wait(session, 50, nullptr)) == LANCER_RUNNING)
    ;
}

void ask_error(lancer_session session, double confidence, bool nowhere) {
  lancer_error e;
  if (LANCER_CHECKED(lancer_session_error(session, confidence, nowhere ? nullptr : &e)) != LANCER_OK)
    return;
  // The first four are infinite while they are unknown; missing is infinite if the last bounce has no less light than the one
  // before.
  const bool good = e.low >= 0.0 && e.low <= e.error && e.error <= e.high && e.cannot_exclude >= 0.0 && e.clipped >= 0.0 &&
                    e.clipped <= 1.0 && e.missing >= 0.0 && e.planned_samples >= 0.0 && e.least_samples <= e.most_samples;
  if (!good)
    broken("lancer_session_error", "its numbers are invalid");
}

lancer_statistics statistics_of(lancer_session session) {
  lancer_statistics statistics{};
  LANCER_CHECKED(lancer_session_statistics(session, &statistics));
  return statistics;
}

uint32_t most_samples(lancer_session session) {
  lancer_error error{};
  LANCER_CHECKED(lancer_session_error(session, 0.95, &error));
  return error.most_samples;
}

bool exported(lancer_session session, std::vector<uint8_t> &part) {
  size_t needed = 0;
  part.clear();
  if (LANCER_CHECKED(lancer_session_export(session, nullptr, 0, &needed)) != LANCER_OK)
    return false;
  part.assign(needed, 0xee);
  LANCER_CHECKED(lancer_session_export(session, part.data(), needed - 1, nullptr));
  if (part != std::vector<uint8_t>(needed, 0xee))
    broken("lancer_session_export", "it has written to too little room");
  return LANCER_CHECKED(lancer_session_export(session, part.data(), needed, nullptr)) == LANCER_OK;
}

void look(lancer_session session, const SessionState *state, Bytes &bytes) {
  std::vector<float> picture;
  statistics_of(session);
  ask_error(session, 0.95, false);
  const size_t pixels = state ? state->pixels() : 1;
  for (uint32_t pass = 0; pass <= LANCER_PASS_COUNT; ++pass)
    for (const size_t channels : {1, 3, 4}) {
      picture.assign(pixels * channels, NAN);
      if (LANCER_CHECKED(lancer_session_read(session, pass, picture.data(), picture.size())) != LANCER_OK)
        continue;
      for (const float value : picture)
        // An error is infinite while it is unknown.
        if (std::isnan(value) || (std::isinf(value) && pass != LANCER_PASS_ERROR))
          broken("lancer_session_read", ("pass " + std::to_string(pass) + " is not finite").c_str());
    }
  if (state && asks_for_numbered(state->settings))
    read_numbered(session, pixels);
  replay(session, state, bytes);
  probe_camera(session, bytes);
}

} // namespace lancer_fuzz
