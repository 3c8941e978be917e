// Checks and copies the motion of instances, of the camera and of the shutter.
#include "scene/fill.h"
#include "scene/messages.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace lancer {

void check_key_count(const std::string &object, uint32_t key_count) {
  if (!is_key_count(key_count))
    bad_argument(object + ": " + std::to_string(key_count) + " keys are not 3, 5, 9 ... " + std::to_string(kMostKeys));
}

void move_instances(Description &description, uint32_t count, const uint32_t *instances, uint32_t key_count,
                    const double *matrices) {
  if (count == 0)
    return;
  if (!instances || !matrices)
    bad_argument("motion: NULL for " + std::to_string(count) + " instances");
  check_key_count("motion", key_count);
  std::map<uint32_t, size_t> place_of;
  for (size_t i = 0; i < description.instances.size(); ++i)
    place_of[description.instances[i].number] = i;
  for (uint32_t i = 0; i < count; ++i) {
    if (instances[i] >= description.instances_given)
      bad_argument("motion: instance " + std::to_string(instances[i]) + " >= " + std::to_string(description.instances_given) +
                   " instances");
    const auto place = place_of.find(instances[i]);
    if (place != place_of.end() && description.instances[place->second].key_count > 0)
      bad_argument("motion: instance " + std::to_string(instances[i]) + " was given before");
  }
  for (uint32_t i = 0; i < count; ++i) {
    // An instance that was left out needs no motion.
    const auto place = place_of.find(instances[i]);
    if (place == place_of.end())
      continue;
    Instance &instance = description.instances[place->second];
    std::vector<Affine> maps;
    bool usable = instance.flat_axis == glm::dvec3(0.0);
    for (uint32_t key = 0; key < key_count; ++key) {
      maps.push_back(Affine::from_rows(matrices + (size_t(i) * key_count + key) * 12));
      usable = usable && is_placement(maps.back());
    }
    if (!usable) {
      description.instance_messages.add("instance #" + std::to_string(instance.number),
                                        "a matrix of its motion is singular or not finite; it stands still");
      continue;
    }
    const std::vector<PlacementKey> keys = placement_keys(maps);
    instance.first_key = uint32_t(description.keys.size());
    instance.key_count = key_count;
    description.keys.insert(description.keys.end(), keys.begin(), keys.end());
  }
}

void set_motion(Description &description, const lancer_motion &source) {
  if (source.shutter_count == 1 || (source.shutter_count > 0 && !source.shutter))
    bad_argument("motion: a shutter has 0 or at least 2 numbers");
  for (uint32_t i = 0; i < source.shutter_count; ++i)
    if (!(source.shutter[i] >= 0.0f) || !std::isfinite(source.shutter[i]))
      bad_argument("motion: number " + std::to_string(i) + " of the shutter is " + to_text(source.shutter[i]));
  if (source.rolling > 1)
    bad_argument("motion: rolling " + std::to_string(source.rolling) + " is not 0 or 1");
  if (source.rolling && !(source.rolling_duration >= 0.0 && source.rolling_duration <= 1.0))
    bad_argument("motion: rolling_duration " + std::to_string(source.rolling_duration) + " is outside 0 ... 1");
  auto motion = std::make_shared<Motion>();
  if (source.shutter_count > 0)
    motion->shutter = Shutter({source.shutter, source.shutter_count});
  motion->rolling = source.rolling != 0;
  motion->rolling_duration = source.rolling_duration;
  if (source.key_count > 0) {
    if (!source.keys)
      bad_argument("motion: NULL for " + std::to_string(source.key_count) + " keys of the camera");
    check_key_count("motion of the camera", source.key_count);
    std::vector<Affine> maps;
    for (uint32_t key = 0; key < source.key_count; ++key) {
      motion->cameras.push_back(read_camera(source.keys[key]));
      maps.push_back(motion->cameras.back().to_world);
    }
    motion->places = placement_keys(maps);
  }
  description.motion = std::move(motion);
}

} // namespace lancer
