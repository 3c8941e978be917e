// The calls of a session that renders or joins parts of a picture.
#include "render/session.h"

#include "scene/messages.h"

namespace lancer {

void Session::require_parts() const {
  if (!settings_.refines)
    throw Error(Fault::State, "session: it was not created for parts of a picture; set refines in its settings");
  if (!identity_.has_digest)
    throw Error(Fault::State, "session: its scene has no digest, which names it in parts");
  if (pool_.running())
    throw Error(Fault::State, "session: a range is still being rendered");
  if (failed_)
    throw Error(Fault::State, "session: a range failed; its film can only be read");
}

void Session::decide() {
  require_scene();
  require_ready();
  tasks_.clear();
  range_samples_ = 0;
  in_ranges_ = false;
  start();
  deciding_ = true;
}

void Session::render(std::span<const lancer_range> ranges) {
  require_scene();
  require_parts();
  require_ready();
  // Check all ranges before the first tile changes.
  std::vector<bool> chosen(film_.tile_count());
  for (const lancer_range &range : ranges) {
    const std::string what = "session: tile " + std::to_string(range.tile);
    if (range.tile >= film_.tile_count())
      bad_argument(what + " >= " + std::to_string(film_.tile_count()) + " tiles");
    if (chosen[range.tile])
      bad_argument(what + " has two ranges");
    if (uint64_t(range.first) + range.count > (uint64_t(1) << 31))
      bad_argument(what + ": " + std::to_string(uint64_t(range.first) + range.count) + " samples > 2147483648");
    if (const Film::Tile &tile = film_.tile(range.tile); tile.count > 0 && tile.next() != range.first)
      throw Error(Fault::State, what + ": first sample " + std::to_string(range.first) + " does not follow its sample " +
                                    std::to_string(tile.next() - 1));
    chosen[range.tile] = true;
  }
  tasks_.clear();
  range_samples_ = 0;
  for (const lancer_range &range : ranges) {
    Film::Tile &tile = film_.tile(range.tile);
    if (tile.pixels() == 0 || range.count == 0)
      continue;
    if (tile.count == 0)
      Film::clear(tile, range.first);
    tasks_.push_back({range.tile, range.first + range.count});
    range_samples_ += uint64_t(range.count) * tile.pixels();
  }
  in_ranges_ = true;
  start();
}

void Session::clear() {
  if (pool_.running())
    throw Error(Fault::State, "session: a range is still being rendered");
  if (failed_)
    throw Error(Fault::State, "session: a range failed; its film can only be read");
  for (size_t i = 0; i < film_.tile_count(); ++i)
    Film::clear(film_.tile(i), 0);
  samples_ = counted_samples_ = 0;
  samples_before_ = range_samples_ = 0;
  planned_samples_ = 0.0;
  cancelled_ = cancel_ = stop_ = false;
  added_ = {};
  forgotten_ = of_workers();
}

size_t Session::part_size() const {
  require_parts();
  return lancer::part_size(film_);
}

void Session::write_part(std::span<std::byte> out) const {
  require_parts();
  lancer::write_part(film_, identity_, splits_, totals(), out);
}

void Session::add(const Part &part) {
  require_parts();
  identity_.require_same(part.identity());
  const lancer_part &description = part.description();
  const Splits splits{description.split_lights, description.split_paths};
  const auto in_words = [](const Splits &of) {
    return std::to_string(of.lights) + " lights and " + std::to_string(of.paths) + " paths";
  };
  if (splits.lights == 0 || splits.paths == 0 || splits.lights > 16 || splits.paths > 16)
    bad_argument("part: its samples have " + in_words(splits));
  // A part without samples may be of a session that has not found its splits.
  const bool has_samples = description.samples > 0;
  const bool takes_over = has_samples && !has_splits() && samples_ == 0;
  if (has_samples && !takes_over && splits != splits_)
    bad_argument("part: its samples have " + in_words(splits) + ", the session's " + in_words(splits_));
  added_ = part.add_to(film_, added_);
  samples_ += description.samples;
  counted_samples_ += description.samples;
  if (!takes_over)
    return;
  settings_.split_lights = splits.lights;
  settings_.split_paths = splits.paths;
  const std::lock_guard lock(mutex_);
  splits_ = splits;
  for (const auto &worker : workers_)
    worker->set_splits(splits);
}

} // namespace lancer
