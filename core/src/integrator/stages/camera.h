// Camera rays for addresses of samples, a block at a time.
//
// In: pixels of the region and numbers of samples, from an integrator. Out: rays in the normalised world, for the search of
// their hits; the sampler of each sample; results, cleared, with alpha 1. Callers: all integrators.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/numbers.h"
#include "simd/block.h"
#include "simd/processor.h"

#include <bit>

namespace lancer {

// Samples in lanes: pixels of the whole picture, and the reversed points of the samples in the dimensions of pixel and lens.
struct alignas(64) AddressBlock {
  Words x, y, reversed_point[kDimensionVertex];
  uint32_t key = 0; // hash of the seed
};

// Sampler::pixel() of each sample, and its ray; the component of d along the axis is 1, or d is unit for panoramas: t is the
// depth.
struct alignas(64) CameraBlock {
  Words pixel;
  Doubles o[3], d[3];
};

struct CameraKernel {
  const char *name;
  // Makes the rays of flat pictures through a pinhole or a round lens: the same bits as Sampler, PixelFilter and Camera::ray().
  void (*rays)(const Camera &camera, const FilterTable &filter, const AddressBlock &addresses, CameraBlock &rays);
};
LANCER_DECLARE_KERNEL(CameraKernel, camera_kernel)

class CameraStage {
public:
  // motion: of the camera and the shutter; must outlive the stage.
  CameraStage(const Camera &camera, const Motion &motion, const IntegratorSettings &settings);

  // Whether rays go through the middle of the pixel and of the lens: in a picture of one sample by CLASSIC or NORMALS.
  bool middle() const { return middle_; }

  // Begins every sample: clears its result and calls begin(sample, sampler), which returns the ray to fill. with_light: parts
  // of the light are requested. A sample without a direction gets no call: outside a panorama's picture it is black and opaque,
  // as in Cycles.
  template <class Begin>
  void start(std::span<const SampleAddress> addresses, bool with_light, std::span<SampleResult> results, Begin &&begin) {
    for (uint32_t first = 0; first < addresses.size(); first += kBlockLanes) {
      const auto now = addresses.subspan(first, std::min<size_t>(kBlockLanes, addresses.size() - first));
      const uint32_t looking = aim(now);
      for (uint32_t lane = 0; lane < now.size(); ++lane)
        std::construct_at(&results[first + lane], with_light)->alpha = 1.0f;
      for (uint32_t rest = looking; rest != 0; rest &= rest - 1) {
        const uint32_t lane = uint32_t(std::countr_zero(rest));
        // Write the ray in place: a copy would stall on the pending stores of its members.
        Ray &ray = begin(first + lane, Sampler(rays_.pixel[lane], now[lane].sample));
        ray.o = {rays_.o[0][lane], rays_.o[1][lane], rays_.o[2][lane]};
        ray.tmin = camera_.clip_start;
        ray.d = {rays_.d[0][lane], rays_.d[1][lane], rays_.d[2][lane]};
        ray.tmax = camera_.clip_end;
        ray.kinds = RayKind::Camera;
        ray.time = times_[lane];
      }
    }
  }

private:
  // Fills the blocks. Returns the lanes that have a direction.
  uint32_t aim(std::span<const SampleAddress> addresses);
  bool aim_alone(const SampleAddress &address, uint32_t lane);
  // Returns the time of a sample.
  float time_of(const SampleAddress &address) const;

  const Camera &camera_;
  const Motion &motion_;
  Camera moved_; // the camera at the time of the last sample
  PixelFilter filter_;
  uint32_t seed_;
  bool middle_, plain_; // plain: kernels support the camera
  const CameraKernel &kernel_;
  AddressBlock addresses_{};
  CameraBlock rays_{};
  Floats times_{}; // by lane
};

} // namespace lancer
