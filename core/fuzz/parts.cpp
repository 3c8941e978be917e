#include "parts.h"

#include "checked.h"
#include "looks.h"
#include "spoil.h"

#include <cstring>

namespace lancer_fuzz {

namespace {

constexpr size_t kMostSessions = 5, kMostParts = 6;
constexpr uint32_t kMostRanges = 6, kMostTiles = 16, kMostSamples = 4, kMostSplits = 8;

struct Digest {
  uint8_t bytes[32];

  explicit Digest(uint8_t number) { std::memset(bytes, number, sizeof bytes); }
};

std::vector<float> numbers_of(lancer_session session, uint32_t pass, size_t count) {
  std::vector<float> numbers(count);
  LANCER_CHECKED(lancer_session_read(session, pass, numbers.data(), count));
  return numbers;
}

} // namespace

bool Parts::full() const { return sessions_.size() >= kMostSessions; }

Part Parts::part() {
  if (parts_.empty())
    return {};
  const uint8_t b = bytes_.byte();
  return parts_[(parts_.size() - 1 + b / 100) % parts_.size()];
}

lancer_session Parts::any_session() {
  const uint32_t i = bytes_.reference(sessions_.size());
  return i < sessions_.size() ? sessions_[i].handle : i;
}

void Parts::call() {
  const uint32_t kind = bytes_.below(14);
  const lancer_session session = any_session();
  switch (kind) {
  case 0:
    return create_joiner(session);
  case 1:
    return ask_tiles(session);
  case 2:
    return decide(session);
  case 3:
    return plan(session);
  case 4:
  case 5:
    return render(session);
  case 6:
    return clear(session);
  case 7:
    return join_again(session);
  case 8:
  case 9:
    return keep(session);
  default:
    return import(session);
  }
}

void Parts::create_session(lancer_scene scene) {
  const Digest digest(uint8_t(1 + bytes_.rarely(20)));
  LANCER_CHECKED(lancer_scene_set_digest(scene, bytes_.rarely(2) ? nullptr : digest.bytes));
  SessionState state;
  state.camera = records_.camera();
  state.settings = records_.settings();
  state.settings.refines = !bytes_.rarely(10);
  if (bytes_.rarely(80))
    state.settings.samples = 64;
  if (bytes_.rarely(128)) {
    state.settings.split_lights = bytes_.below(4);
    state.settings.split_paths = bytes_.below(4);
  }
  // More squares than one, of which the last ones may have a single pixel.
  if (bytes_.rarely(60) && state.camera.width < ~0u - 16) {
    state.camera.region_width = 17;
    state.camera.width += 16;
  }
  if (bytes_.rarely(60) && state.camera.height < ~0u - 16) {
    state.camera.region_height = 17;
    state.camera.height += 16;
  }
  if (!full() && LANCER_CHECKED(lancer_session_create(scene, &state.camera, &state.settings, &state.handle)) == LANCER_OK)
    sessions_.push_back(state);
}

void Parts::create_joiner(lancer_session like) {
  const Digest digest(uint8_t(1 + bytes_.rarely(20)));
  SessionState state;
  if (const SessionState *known = state_of(sessions_, like); known && !bytes_.rarely(10))
    state = *known;
  else {
    state.camera = records_.camera();
    state.settings = records_.settings();
  }
  state.samples = 0;
  switch (bytes_.below(8)) {
  case 5:
    state.settings.samples = bytes_.byte();
    break;
  case 6:
    state.settings.seed ^= 1;
    break;
  case 7:
    state.settings.passes = 1;
    break;
  default:
    break;
  }
  if (!full() &&
      LANCER_CHECKED(lancer_session_create_joiner(digest.bytes, &state.camera, &state.settings, &state.handle)) == LANCER_OK)
    sessions_.push_back(state);
}

void Parts::ask_tiles(lancer_session session) {
  std::vector<uint32_t> pixels(bytes_.below(kMostTiles + 1));
  uint32_t count = 0;
  const bool nowhere = bytes_.rarely(4);
  LANCER_CHECKED(lancer_session_tiles(session, uint32_t(pixels.size()), pixels.data(), nowhere ? nullptr : &count));
  const SessionState *state = state_of(sessions_, session);
  if (nowhere || !state || count > pixels.size())
    return;
  size_t sum = 0;
  for (const uint32_t of_tile : pixels)
    sum += of_tile;
  if (sum != state->pixels())
    broken("lancer_session_tiles", "the tiles' pixels are not those of the region");
}

void Parts::decide(lancer_session session) {
  const bool cancels = bytes_.rarely(40);
  if (ranges_ == kMostRanges)
    return;
  ++ranges_;
  LANCER_CHECKED(lancer_session_decide(session));
  if (cancels)
    LANCER_CHECKED(lancer_session_cancel(session));
  wait_for_end(session);
}

void Parts::plan(lancer_session session) {
  std::vector<lancer_range> ranges(bytes_.below(kMostTiles + 1));
  uint32_t count = 0;
  const double target = bytes_.number(0.05, 0.0, 1.0), confidence = bytes_.number(0.95, 0.0, 1.0);
  if (LANCER_CHECKED(lancer_session_plan(session, target, confidence, uint32_t(ranges.size()), ranges.data(), &count)) !=
      LANCER_OK)
    return;
  ranges.resize(std::min<size_t>(ranges.size(), count));
  for (const lancer_range &range : ranges)
    if (range.first == 0 || range.first != range.count)
      broken("lancer_session_plan", "a range does not double its tile");
}

void Parts::render(lancer_session session) {
  SessionState *state = state_of(sessions_, session);
  uint32_t tiles = 0;
  if (state)
    LANCER_CHECKED(lancer_session_tiles(session, 0, nullptr, &tiles));
  std::vector<lancer_range> ranges(bytes_.rarely(128) ? bytes_.below(4) : std::min(tiles, kMostTiles));
  const uint32_t from = bytes_.below(8),
                 start = from == 7   ? bytes_.word()
                         : from == 6 ? bytes_.byte()
                                     : 0,
                 all = 1 + bytes_.below(kMostSamples);
  bool endless = false;
  for (uint32_t i = 0; i < ranges.size(); ++i) {
    lancer_range &range = ranges[i];
    range = {i, from == 5 && state ? state->samples : start, all};
    if (!bytes_.rarely(60))
      continue;
    range.tile = bytes_.reference(tiles);
    range.first = bytes_.below(16);
    range.count = bytes_.rarely(20) ? bytes_.word() : bytes_.below(kMostSamples);
    endless |= range.count > kMostSamples;
  }
  const bool stops = endless || bytes_.rarely(20), waits = stops || !bytes_.rarely(20), gently = bytes_.rarely(128);
  if (ranges_ == kMostRanges || (state && state->slow))
    return;
  ++ranges_;
  LANCER_CHECKED(lancer_session_render_ranges(session, uint32_t(ranges.size()), ranges.data()));
  if (stops)
    LANCER_CHECKED(gently ? lancer_session_stop(session) : lancer_session_cancel(session));
  if (!waits)
    return;
  wait_for_end(session);
  if (state)
    state->samples = most_samples(session);
}

void Parts::clear(lancer_session session) {
  if (LANCER_CHECKED(lancer_session_clear(session)) != LANCER_OK)
    return;
  if (SessionState *state = state_of(sessions_, session))
    state->samples = 0;
  if (statistics_of(session).samples != 0)
    broken("lancer_session_clear", "there are samples afterwards");
  if (LANCER_CHECKED(lancer_session_wait(session, 0, nullptr)) != LANCER_OK)
    broken("lancer_session_clear", "the session cannot continue");
}

void Parts::keep(lancer_session session) {
  Part part;
  if (!exported(session, part))
    return;
  if (parts_.size() == kMostParts)
    parts_.erase(parts_.begin());
  parts_.push_back(part);
}

// A session's samples, joined by a session like it, are the same samples.
void Parts::join_again(lancer_session session) {
  const SessionState *state = state_of(sessions_, session);
  Part part, again;
  if (!state || !exported(session, part))
    return;
  lancer_part description;
  lancer_session joiner = 0;
  if (LANCER_CHECKED(lancer_part_describe(part.data(), part.size(), &description)) != LANCER_OK ||
      LANCER_CHECKED(lancer_session_create_joiner(description.digest, &description.camera, &description.settings, &joiner)) !=
          LANCER_OK ||
      LANCER_CHECKED(lancer_session_import(joiner, part.data(), part.size())) != LANCER_OK)
    broken("lancer_session_import", lancer_last_error());
  if (!exported(joiner, again) || again != part)
    broken("lancer_session_import", "the joined part is another one");
  if (statistics_of(joiner).samples != statistics_of(session).samples)
    broken("lancer_session_import", "it has another number of samples");
  for (const auto &[pass, channels] : {std::pair<uint32_t, size_t>(LANCER_PASS_COMBINED, 4), {LANCER_PASS_ERROR, 1}})
    if (numbers_of(session, pass, state->pixels() * channels) != numbers_of(joiner, pass, state->pixels() * channels))
      broken("lancer_session_import", "the joined picture is another one");
  LANCER_CHECKED(lancer_session_destroy(joiner));
}

void Parts::import(lancer_session session) {
  Part part = this->part();
  const uint32_t kind = bytes_.below(8);
  if (kind == 3) {
    part.resize(bytes_.rarely(128) ? std::min<size_t>(part.size(), 40) : 0);
    for (uint32_t i = bytes_.byte(); i > 0; --i)
      part.push_back(bytes_.byte());
  } else if (kind > 3)
    spoil(part, bytes_);
  // An empty vector may have no address, which another check refuses.
  part.reserve(1);
  lancer_part description{};
  const lancer_status described = LANCER_CHECKED(lancer_part_describe(part.data(), part.size(), &description));
  Part before, after;
  const bool known = exported(session, before);
  const uint64_t samples = statistics_of(session).samples;
  const lancer_status status = LANCER_CHECKED(lancer_session_import(session, part.data(), part.size()));
  SessionState *state = state_of(sessions_, session);
  if (!known || !state)
    return;
  exported(session, after);
  if (status != LANCER_OK) {
    if (before != after)
      broken("lancer_session_import", "a refused part has changed the session");
    return;
  }
  const lancer_statistics statistics = statistics_of(session);
  if (described != LANCER_OK || statistics.samples != samples + description.samples)
    broken("lancer_session_import", "it has added other samples");
  if (description.samples > 0 && LANCER_CHECKED(lancer_session_import(session, part.data(), part.size())) == LANCER_OK)
    broken("lancer_session_import", "it has added samples twice");
  state->samples = most_samples(session);
  state->joined = true;
  state->slow |= statistics.split_lights * statistics.split_paths > kMostSplits;
}

} // namespace lancer_fuzz
