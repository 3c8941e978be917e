#include "lights/environment.h"

#include "accel/parallel.h"

#include <cmath>
#include <numeric>

namespace lancer {

namespace {

// Width of the map where neither the user nor an image says, and the most that is stored: a finer image is looked at texel by
// texel and its cells joined.
constexpr uint32_t kPlainWidth = 1024, kLargestWidth = 2048;
// Share of the samples that go evenly to all directions: a bright speck that the map has missed is found by these.
constexpr float kEvenShare = 0.05f;

float brightest(const glm::vec3 &v) {
  const float top = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return std::isfinite(top) ? top : 0.0f;
}

// The width of the largest image that the radiance needs; a cube's six sides go once around in four.
uint32_t image_width(const World &world, const std::vector<Image> &images) {
  uint32_t width = 0;
  for (const uint16_t number : world.schedule) {
    const Node &node = world.program.nodes[number];
    if (node.kind != LANCER_NODE_IMAGE && node.kind != LANCER_NODE_ENVIRONMENT)
      continue;
    const bool cube = node.kind == LANCER_NODE_ENVIRONMENT && node.option == LANCER_ENVIRONMENT_CUBE;
    for (uint32_t i = 0; i < node.image_count; ++i) {
      const Image &image = images[node.image + i];
      width = std::max(width, cube ? 4 * image.width : std::max(image.width, 2 * image.height));
    }
  }
  return width;
}

} // namespace

Environment::Environment(const World &world, const std::vector<Image> &images, const Normalisation &normalisation,
                         const BuildContext &context)
    : world_(&world), images_(&images), normalisation_(&normalisation), constant_(world.radiance.value),
      mean_(double(brightest(world.radiance.value))), hidden_from_(world.hidden_from) {
  if (world.varies())
    make_map(context);
}

glm::vec3 Environment::evaluate(const glm::dvec3 &wi, std::span<glm::vec4> values, const Camera *camera,
                                bool is_camera_ray) const {
  NodeContext context;
  context.images = images_;
  context.normalisation = normalisation_;
  context.camera = camera;
  context.wo = glm::vec3(-wi);
  context.is_camera_ray = is_camera_ray;
  run(world_->program, world_->schedule, context, values);
  return value_of(world_->radiance, values);
}

void Environment::make_map(const BuildContext &context) {
  const uint32_t detail = world_->map_resolution > 0 ? world_->map_resolution : image_width(*world_, *images_);
  const uint32_t wanted = detail > 0 ? detail : kPlainWidth;
  const uint32_t width = std::clamp(wanted + (wanted & 1), 4u, kLargestWidth), height = width / 2;
  // A look for each texel, and two along each side at least: interpolation spreads a single bright texel over two.
  const uint32_t looks = std::max(2u, (std::max(wanted, image_width(*world_, *images_)) + width - 1) / width);
  const DirectionMap grid(width, height, std::vector<float>(size_t(width) * height, 1.0f));
  std::vector<float> weights(size_t(width) * height);
  std::vector<double> totals(height);
  parallel_for(context, height, [&](size_t row) {
    std::vector<glm::vec4> values(world_->program.nodes.size());
    for (uint32_t column = 0; column < width; ++column) {
      float sum = 0.0f;
      for (uint32_t look = 0; look < looks * looks; ++look) {
        const double x = column + (look % looks + 0.5) / looks, y = double(row) + (look / looks + 0.5) / looks;
        sum += brightest(evaluate(grid.direction(x, y), values, nullptr, false));
      }
      const float mean = sum / float(looks * looks);
      weights[row * width + column] = std::isfinite(mean) ? mean : 0.0f;
      totals[row] += double(weights[row * width + column]) * grid.solid_angle(uint32_t(row));
    }
  });
  mean_ = std::accumulate(totals.begin(), totals.end(), 0.0) / (4.0 * glm::pi<double>());
  // Nothing was seen: what there is must be small, and every direction is as good.
  const float even = mean_ > 0.0 ? kEvenShare * float(mean_) : 1.0f;
  for (float &weight : weights)
    weight += even;
  map_ = DirectionMap(width, height, weights);
}

LightSample Environment::sample(const glm::vec2 &u, std::span<glm::vec4> values) const {
  LightSample sample;
  sample.distance = std::numeric_limits<double>::infinity();
  if (!varies())
    return sample;
  const DirectionMap::Sample found = map_.sample(u);
  sample.wi = found.direction;
  sample.pdf = found.pdf;
  if (sample.pdf > 0.0)
    sample.radiance = evaluate(sample.wi, values, nullptr, false);
  return sample;
}

} // namespace lancer
