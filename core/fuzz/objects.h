// Calls for objects and for scenes that differ little, from bytes.
#pragma once

#include "records.h"
#include "states.h"

#include <vector>

namespace lancer_fuzz {

class Objects {
public:
  Objects(Bytes &bytes, Records &records, std::vector<SceneState> &scenes)
      : bytes_(bytes), records_(records), scenes_(scenes) {}
  ~Objects();
  Objects(const Objects &) = delete;
  Objects &operator=(const Objects &) = delete;

  // Creates or destroys an object.
  void call();
  // Begins a scene with all that another has, and changes it. most: of scenes.
  void edit(lancer_scene before, size_t most);
  // Replaces objects or removes the instances of a scene.
  void change(lancer_scene scene);

private:
  // Returns some handles, rarely of another kind, or of none.
  std::vector<lancer_object> some(uint32_t kind, uint32_t count);
  void keep(uint32_t kind, lancer_status status, lancer_object object);

  static constexpr uint32_t kKinds = 5, kMost = 24;

  Bytes &bytes_;
  Records &records_;
  std::vector<SceneState> &scenes_;
  std::vector<lancer_object> objects_[kKinds]; // by lancer_object_kind
  lancer_object gone_ = 7;
};

} // namespace lancer_fuzz
