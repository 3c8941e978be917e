#include "integrator/stages/camera.h"

namespace lancer {

const CameraKernel &camera_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(camera_kernel); }

CameraStage::CameraStage(const Camera &camera, const Motion &motion, const IntegratorSettings &settings)
    : camera_(camera), motion_(motion), moved_(camera), filter_(settings.filter(), settings.filter_width), seed_(settings.seed),
      middle_(settings.kind() != IntegratorKind::Path && settings.samples == 1),
      plain_(!middle_ && !camera.is_panorama() && !camera.is_stereo() && !(motion.shutter.opens() && !motion.cameras.empty()) &&
             (!(camera.lens_radius > 0.0) || camera.aperture_blades < 3)),
      kernel_(camera_kernel()) {
  addresses_.key = hash(settings.seed);
  std::fill_n(times_, kBlockLanes, kMiddleTime);
}

float CameraStage::time_of(const SampleAddress &address) const {
  if (middle_ || !motion_.shutter.opens())
    return kMiddleTime;
  const uint32_t x = camera_.x + address.x, y = camera_.y + address.y;
  const Sampler sampler(seed_, x, y, address.sample);
  const float u = sampler.get1(camera_.lens_radius > 0.0 ? kDimensionTime : kDimensionLens);
  // Rows are exposed from the top of the picture on.
  return motion_.time(u, 1.0 - double(y) / camera_.height);
}

uint32_t CameraStage::aim(std::span<const SampleAddress> addresses) {
  uint32_t looking = 0;
  for (uint32_t lane = 0; lane < addresses.size() && motion_.shutter.opens(); ++lane)
    times_[lane] = time_of(addresses[lane]);
  if (!plain_) {
    for (uint32_t lane = 0; lane < addresses.size(); ++lane)
      looking |= uint32_t{aim_alone(addresses[lane], lane)} << lane;
    return looking;
  }
  // Most lanes have the same sample: look up its digits once.
  uint32_t sample = ~addresses[0].sample, digits[kDimensionVertex] = {};
  for (uint32_t lane = 0; lane < addresses.size(); ++lane) {
    // The region's place in the image is part of the address: a border render repeats the full image's numbers.
    addresses_.x[lane] = camera_.x + addresses[lane].x;
    addresses_.y[lane] = camera_.y + addresses[lane].y;
    if (addresses[lane].sample != sample) {
      sample = addresses[lane].sample;
      for (uint32_t i = 0; i < kDimensionVertex; ++i)
        digits[i] = sobol::reversed_point(sample, kDimensionPixel + i);
    }
    for (uint32_t i = 0; i < kDimensionVertex; ++i)
      addresses_.reversed_point[i][lane] = digits[i];
  }
  kernel_.rays(camera_, filter_.table(), addresses_, rays_);
  return (1u << addresses.size()) - 1u;
}

bool CameraStage::aim_alone(const SampleAddress &address, uint32_t lane) {
  const uint32_t x = camera_.x + address.x, y = camera_.y + address.y;
  const Sampler sampler(seed_, x, y, address.sample);
  if (motion_.shutter.opens() && !motion_.cameras.empty())
    motion_.move(moved_, times_[lane]);
  glm::dvec2 raster(double(x) + 0.5, double(y) + 0.5), lens(0.0);
  if (!middle_) {
    const glm::vec2 u = sampler.get2(kDimensionPixel);
    raster += glm::dvec2(filter_.sample(u.x), filter_.sample(u.y));
    if (camera_.lens_radius > 0.0)
      lens = camera_.aperture(sampler.get2(kDimensionLens));
  }
  const Ray ray = moved_.ray(raster, lens);
  rays_.pixel[lane] = sampler.pixel();
  put(ray.o, rays_.o, lane);
  put(ray.d, rays_.d, lane);
  return !(ray.tmax < 0.0);
}

} // namespace lancer
