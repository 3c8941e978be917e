// From addresses of samples to camera rays, a block at a time.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/camera_kernel.h"
#include "sampling/sobol.h"

#include <bit>
#include <memory>

namespace lancer {

class RayGenerator {
public:
  RayGenerator(const Camera &camera, const IntegratorSettings &settings);
  RayGenerator(const RayGenerator &) = delete; // its block has the address of its filter
  RayGenerator &operator=(const RayGenerator &) = delete;

  // Whether rays go through the middle of the pixel and of the lens: in a picture of one sample by a recursive ray tracer.
  bool middle() const { return middle_; }

  // Begins every sample: clears its result and calls begin(slot, sampler) for a ray to fill in. A sample without a direction
  // gets no call: outside a panorama's picture it is black and opaque, as in Cycles.
  template <class Begin>
  void start(std::span<const SampleAddress> addresses, bool with_light, std::span<SampleResult> results, Begin &&begin) {
    for (uint32_t first = 0; first < addresses.size(); first += kCameraLanes) {
      const auto now = addresses.subspan(first, std::min<size_t>(kCameraLanes, addresses.size() - first));
      const uint32_t looking = aim(now);
      for (uint32_t lane = 0; lane < now.size(); ++lane)
        std::construct_at(&results[first + lane], with_light)->alpha = 1.0f;
      for (uint32_t rest = looking; rest != 0; rest &= rest - 1) {
        const uint32_t lane = uint32_t(std::countr_zero(rest));
        // Write the ray in place: a copy would stall on the pending stores of its members.
        Ray &ray = begin(first + lane, Sampler(block_->pixel[lane], now[lane].sample));
        ray.o = {block_->o[0][lane], block_->o[1][lane], block_->o[2][lane]};
        ray.tmin = camera_.clip_start;
        ray.d = {block_->d[0][lane], block_->d[1][lane], block_->d[2][lane]};
        ray.tmax = camera_.clip_end;
        ray.kinds = LANCER_RAY_CAMERA;
      }
    }
  }

private:
  // Fills the block. Returns the lanes that have a direction.
  uint32_t aim(std::span<const SampleAddress> addresses);
  bool aim_alone(const SampleAddress &address, uint32_t lane);

  const Camera &camera_;
  PixelFilter filter_;
  uint32_t seed_;
  bool middle_, plain_; // plain: kernels support the camera
  const CameraKernel &kernel_;
  std::unique_ptr<CameraBlock> block_;
};

} // namespace lancer
