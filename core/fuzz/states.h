// The program's knowledge of its scenes and sessions.
#pragma once

#include "records.h"

#include <algorithm>

namespace lancer_fuzz {

struct SceneState {
  lancer_scene handle = 0;
  Filled filled;
  bool committed = false; // or in progress
};

struct SessionState {
  lancer_session handle = 0;
  lancer_camera camera{};
  lancer_settings settings{};
  uint32_t samples = 0; // of each pixel, as far as known
  bool joined = false;  // it has samples of parts
  bool slow = false;    // its samples split often

  size_t pixels() const { return size_t(camera.region_width) * camera.region_height; }
};

// Returns the state of a handle; null if there is none.
template <class State> State *state_of(std::vector<State> &states, uint64_t handle) {
  const auto found = std::find_if(states.begin(), states.end(), [&](const State &s) { return s.handle == handle; });
  return found == states.end() ? nullptr : &*found;
}

} // namespace lancer_fuzz
