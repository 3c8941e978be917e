// When samples are taken: the opening of the shutter over time, and the camera then.
#pragma once

#include "scene/camera.h"
#include "scene/motion.h"

#include <vector>

namespace lancer {

// Chooses times in proportion to how far the shutter is open, which is linear between equal steps of time.
class Shutter {
public:
  // Always the middle time.
  Shutter() = default;
  // open: at least two numbers, not negative. Where all are 0, the shutter is fully open.
  explicit Shutter(std::span<const float> open);

  // Whether samples are of different times.
  bool opens() const { return !open_.empty(); }
  // Returns the time for a number in [0, 1).
  float time(float u) const;

private:
  std::vector<float> open_;
  std::vector<double> sums_;     // up to the end of each step, the last one is 1
  std::vector<uint32_t> starts_; // for each of kStarts equal parts of the numbers: the first step of a number in it
};

// The camera and the shutter over time; lengths in the unit of the camera.
struct Motion {
  Shutter shutter;
  std::vector<Camera> cameras;      // at the keys; empty: the camera stands still
  std::vector<PlacementKey> places; // of the cameras
  bool rolling = false;
  double rolling_duration = 0.0;

  // Returns the time of a sample in a row of the picture; row: from the top, 0 ... 1.
  float time(float u, double row) const;
  // Moves a camera to its place at a time; all but that must be as at the keys.
  void move(Camera &camera, float time) const;
  // Whether rays need a time.
  bool wanted() const { return shutter.opens(); }
};

} // namespace lancer
