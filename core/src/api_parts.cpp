// The parts of a picture in the C interface: ranges of tiles, their sums as bytes, and sessions that join them.
#include "objects.h"
#include "render/parts.h"
#include "render/session.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace lancer;

std::span<const std::byte> bytes_of(const void *part, size_t size) {
  require(part, "part");
  return {static_cast<const std::byte *>(part), size};
}

// Copies as many items as there is room for.
template <class Item> void copy_items(const std::vector<Item> &items, uint32_t capacity, Item *out, uint32_t *count) {
  require(count, "count");
  if (capacity)
    require(out, "an array");
  std::copy_n(items.begin(), std::min<size_t>(capacity, items.size()), out);
  *count = uint32_t(items.size());
}

} // namespace

extern "C" {

lancer_status lancer_scene_set_digest(lancer_scene scene, const uint8_t digest[32]) {
  return guard([&] {
    const auto object = scene_of(scene);
    require(digest, "digest");
    const std::lock_guard lock(object->mutex);
    std::copy_n(digest, object->digest.size(), object->digest.begin());
    object->has_digest = true;
    return LANCER_OK;
  });
}

lancer_status lancer_session_create_joiner(const uint8_t digest[32], const lancer_camera *camera,
                                           const lancer_settings *settings, lancer_session *session) {
  return guard([&] {
    require(digest, "digest");
    require(camera, "camera");
    require(settings, "settings");
    require(session, "session");
    Identity identity{{}, true, *camera, *settings, this_release()};
    std::copy_n(digest, identity.digest.size(), identity.digest.begin());
    *session = sessions().add(std::make_shared<SessionObject>(nullptr, identity));
    return LANCER_OK;
  });
}

lancer_status lancer_session_tiles(lancer_session session, uint32_t capacity, uint32_t *pixels, uint32_t *count) {
  return guard([&] {
    const auto object = session_of(session);
    const std::lock_guard lock(object->mutex);
    const Film &film = object->session.film();
    std::vector<uint32_t> sizes;
    for (size_t i = 0; i < film.tile_count(); ++i)
      sizes.push_back(film.tile(i).pixels());
    copy_items(sizes, capacity, pixels, count);
    return LANCER_OK;
  });
}

lancer_status lancer_session_decide(lancer_session session) {
  return guard([&] {
    const auto object = session_of(session);
    const std::lock_guard lock(object->mutex);
    object->session.decide();
    return LANCER_OK;
  });
}

lancer_status lancer_session_plan(lancer_session session, double target, double confidence, uint32_t capacity,
                                  lancer_range *ranges, uint32_t *count) {
  return guard([&] {
    const auto object = session_of(session);
    check_target("plan", target);
    check_confidence("plan", confidence);
    const std::lock_guard lock(object->mutex);
    copy_items(object->session.plan(target, confidence), capacity, ranges, count);
    return LANCER_OK;
  });
}

lancer_status lancer_session_render_ranges(lancer_session session, uint32_t count, const lancer_range *ranges) {
  return guard([&] {
    const auto object = session_of(session);
    if (count)
      require(ranges, "ranges");
    const std::lock_guard lock(object->mutex);
    object->session.render(std::span(ranges, count));
    return LANCER_OK;
  });
}

lancer_status lancer_session_clear(lancer_session session) {
  return guard([&] {
    const auto object = session_of(session);
    const std::lock_guard lock(object->mutex);
    object->session.clear();
    return LANCER_OK;
  });
}

lancer_status lancer_session_export(lancer_session session, void *part, size_t size, size_t *needed) {
  return guard([&] {
    const auto object = session_of(session);
    const std::lock_guard lock(object->mutex);
    const size_t all = object->session.part_size();
    if (needed)
      *needed = all;
    if (size < all)
      return LANCER_OK;
    require(part, "part");
    object->session.write_part({static_cast<std::byte *>(part), all});
    return LANCER_OK;
  });
}

lancer_status lancer_session_import(lancer_session session, const void *part, size_t size) {
  return guard([&] {
    const auto object = session_of(session);
    const Part read(bytes_of(part, size));
    const std::lock_guard lock(object->mutex);
    object->session.add(read);
    return LANCER_OK;
  });
}

lancer_status lancer_part_describe(const void *part, size_t size, lancer_part *description) {
  return guard([&] {
    require(description, "description");
    *description = Part(bytes_of(part, size)).description();
    return LANCER_OK;
  });
}

} // extern "C"
