#include "movements.h"

#include "checked.h"

#include <algorithm>

namespace lancer_fuzz {

namespace {

constexpr uint32_t kMostKeys = 129, kMostSteps = 6, kMostMoved = 4;

std::vector<uint32_t> chosen(const Filled *filled, Bytes &bytes) {
  std::vector<uint32_t> numbers(bytes.below(kMostMoved + 1));
  for (uint32_t i = 0; i < numbers.size(); ++i)
    numbers[i] = bytes.rarely(40) ? bytes.reference(filled ? filled->instances : 0) : i;
  return numbers;
}

std::vector<double> matrices(size_t count, Records &records, Bytes &bytes) {
  std::vector<double> rows(12 * count);
  for (size_t i = 0; i < count; ++i)
    if (bytes.any() || i == 0)
      records.matrix(&rows[12 * i]);
    else
      std::copy_n(rows.data(), 12, &rows[12 * i]);
  return rows;
}

void set_motion(lancer_scene scene, Records &records, Bytes &bytes) {
  std::vector<float> shutter(bytes.rarely(10) ? bytes.below(2) : 2 + bytes.below(kMostSteps));
  for (float &open : shutter)
    open = bytes.number(1.0f, 0.0f, 1.0f);
  std::vector<lancer_camera> keys;
  lancer_motion motion = {};
  if (bytes.rarely(128)) {
    motion.key_count = records.key_count();
    const lancer_camera first = records.camera();
    keys.assign(std::min(motion.key_count, kMostKeys), first);
    for (lancer_camera &key : keys)
      for (int axis = 0; axis < 3 && bytes.any(); ++axis)
        key.matrix[4 * axis + 3] += bytes.number(0.0, -1.0, 1.0);
  }
  motion.shutter = bytes.rarely(10) ? nullptr : shutter.data();
  motion.shutter_count = uint32_t(shutter.size());
  motion.keys = bytes.rarely(2) ? nullptr : keys.data();
  motion.rolling = bytes.choice(2);
  motion.rolling_duration = bytes.number(0.1, 0.0, 1.0);
  LANCER_CHECKED(lancer_scene_set_motion(scene, bytes.rarely(2) ? nullptr : &motion));
}

} // namespace

void move(lancer_scene scene, const Filled *filled, Records &records, Bytes &bytes) {
  const uint32_t kind = bytes.below(6);
  if (kind < 2)
    return set_motion(scene, records, bytes);
  const std::vector<uint32_t> numbers = chosen(filled, bytes);
  const auto count = uint32_t(numbers.size());
  if (kind == 2 || kind == 3) {
    const uint32_t keys = kind == 2 ? records.key_count() : 2;
    // A number of keys that nothing may have is refused before a matrix is read.
    const std::vector<double> places = matrices(count * size_t(std::min(keys, kMostKeys)), records, bytes);
    if (kind == 2)
      LANCER_CHECKED(lancer_scene_move_instances(scene, count, numbers.data(), keys, places.data()));
    else
      LANCER_CHECKED(lancer_scene_set_vectors(scene, count, numbers.data(), places.data()));
    return;
  }
  std::vector<float> facts(5 * size_t(count));
  for (float &fact : facts)
    fact = bytes.number(0.5f, 0.0f, 1.0f);
  if (kind == 4)
    LANCER_CHECKED(lancer_scene_set_object_infos(scene, count, facts.data()));
  else
    LANCER_CHECKED(lancer_scene_add_object_attribute(scene, records.name(), count, facts.data()));
}

} // namespace lancer_fuzz
