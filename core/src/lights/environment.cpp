#include "lights/environment.h"

#include "nodes/run.h"
#include "nodes/sky_table.h"
#include "sampling/elementary.h"
#include "simd/parallel.h"
#include "simd/vectors.h"

#include <cmath>
#include <numeric>

namespace lancer {

namespace {

// Width of the map where neither the user nor an image decides, and the largest width that is stored. A finer image is
// evaluated texel by texel and averaged over the cells.
constexpr uint32_t kPlainWidth = 1024, kLargestWidth = 2048;
// Largest number of evaluations over all directions: some seconds of one processor. They reach each texel of an image 8192
// wide; for an image 16384 wide they fall on the corners between texels, where interpolation still reaches each texel.
constexpr uint32_t kMostLooks = 1u << 25;
// Share of the samples that is uniform over all directions: it finds a bright speck that the map has missed.
constexpr float kEvenShare = 0.05f;
// Largest share of the samples for all suns: places in their shadow depend on the rest.
constexpr double kSunShare = 0.8;
// Number of lookups across a sun and around it: more than there are segments of its limb.
constexpr int kSunLooks = 16;

// Returns the weight of a direction: the mean of the channels' absolute values, as in Cycles; 0 where nodes give no finite
// number.
float weight_of(const glm::vec3 &radiance) {
  const float level = mean(glm::abs(radiance));
  return std::isfinite(level) ? level : 0.0f;
}

// Returns the width of the largest image that the radiance reads; a cube map counts as four of its sides.
uint32_t image_width(const WorldView &world) {
  uint32_t width = 0;
  for (const uint16_t number : world.schedule) {
    const Node &node = world.program.nodes[number];
    // Beside the sun, a sky is as smooth as its table.
    if (node.kind == NodeKind::Sky)
      width = std::max(width, kSkyWidth);
    if (node.kind != NodeKind::Image && node.kind != NodeKind::Environment)
      continue;
    const bool cube = node.kind == NodeKind::Environment && node.option == EnvironmentProjection::Cube;
    for (uint32_t i = 0; i < node.image_count; ++i) {
      const ImageView &image = world.program.images[node.image + i];
      width = std::max(width, cube ? 4 * image.width : std::max(image.width, 2 * image.height));
    }
  }
  return width;
}

// Whether the radiance depends on the direction. Of the nodes without inputs, all depend on the direction except Light Path and
// Object Info.
bool has_directions(const WorldView &world) {
  return std::ranges::any_of(world.schedule, [&](uint16_t number) {
    switch (world.program.nodes[number].kind) {
    case NodeKind::Coordinate:
    case NodeKind::Attribute:
    case NodeKind::Fresnel:
    case NodeKind::LayerWeight:
    case NodeKind::NormalMap:
    case NodeKind::Tangent:
    case NodeKind::Bump:
      return true;
    default:
      return false;
    }
  });
}

// Evaluates the world in a block of directions, with the bits of single evaluations, in a sixth of their time.
class SkyLooks {
public:
  SkyLooks(const ProgramView &program, const WorldView &world, const NodeScene &scene)
      : kernel_(node_kernel()), program_(program), world_(world), values_(program.value_count()) {
    block_.scene = scene;
    block_.surface = false;
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      block_.eye[lane] = nullptr;
      put(LightPath<float>(), block_, uint32_t(lane));
    }
  }

  void aim(uint32_t lane, const glm::dvec3 &wi) {
    for (int axis = 0; axis < 3; ++axis) {
      // The normals of the world's surface point back to the viewer.
      const float back = float(-wi[axis]);
      block_.p[axis][lane] = -double(back);
      block_.wo[axis][lane] = block_.ns[axis][lane] = block_.ng[axis][lane] = back;
    }
  }
  // Evaluates the first lanes.
  void run(uint32_t lanes) {
    block_.used = (1u << lanes) - 1u;
    kernel_.run(program_, world_.schedule, block_, values_.data());
  }
  glm::vec3 radiance(uint32_t lane) const {
    if (!world_.radiance.varies())
      return world_.radiance.value;
    const auto &of = values_[size_t(world_.radiance.node)].of;
    return {of[0][lane], of[1][lane], of[2][lane]};
  }

private:
  const NodeKernel &kernel_;
  ProgramView program_;
  WorldView world_;
  NodeBlock block_;
  std::vector<NodeLanes> values_;
};

// The lookups of a row of cells in their order: column by column, and within a cell row by row.
struct LookOfRow {
  uint32_t column = 0, across = 0, up = 0;

  // Returns whether the cell is left.
  bool next(uint32_t looks) {
    if (++across < looks)
      return false;
    across = 0;
    if (++up < looks)
      return false;
    up = 0;
    ++column;
    return true;
  }
};

} // namespace

MapSize map_size(uint32_t resolution, uint32_t widest) {
  const uint32_t wanted = resolution > 0 ? resolution : widest > 0 ? widest : kPlainWidth;
  MapSize size;
  size.width = std::clamp(wanted + (wanted & 1), 4u, kLargestWidth);
  size.height = size.width / 2;
  // Take a lookup for each texel, and at least two along each side: interpolation spreads a single bright texel over two cells.
  const uint32_t needed = (std::max(wanted, widest) + size.width - 1) / size.width;
  const auto most = uint32_t(std::sqrt(double(kMostLooks) / (double(size.width) * size.height)));
  size.looks = std::clamp(needed, 2u, most);
  return size;
}

Environment::Environment(const WorldView &world, const Normalisation &normalisation, const BuildContext &context, bool glass,
                         bool opened)
    : world_(world), normalisation_(&normalisation), constant_(world.radiance.value),
      mean_(double(weight_of(world.radiance.value))), hidden_from_(world.hidden_from) {
  if (!world.varies()) {
    if (opened && mean_ > 0.0)
      make_even_map();
    return;
  }
  const uint32_t across = world.map_resolution > 0 ? world.map_resolution : std::max(image_width(world), 4096u);
  finest_ = 2.0f * glm::pi<float>() / float(across);
  if (has_directions(world)) {
    make_maps(context, glass);
    return;
  }
  std::vector<glm::vec4> values(world.program.value_count());
  mean_ = double(weight_of(evaluate(glm::dvec3(0.0, 0.0, 1.0), values, nullptr, nullptr)));
  if (opened && mean_ > 0.0)
    make_even_map();
}

void Environment::make_even_map() {
  constexpr uint32_t kWidth = 4, kHeight = 2;
  maps_ =
      std::make_shared<const Maps>(DirectionMap(kWidth, kHeight, std::vector<float>(kWidth * kHeight, 1.0f)), DirectionMap());
}

glm::vec3 Environment::evaluate(const ProgramView &program, const glm::dvec3 &wi, std::span<glm::vec4> values,
                                const Camera *camera, const glm::dvec3 *eye, const LightPath<float> &path) const {
  run_nodes(program, world_.schedule, wi, values, camera, eye, path);
  return value_of(world_.radiance, values);
}

void Environment::run_nodes(const ProgramView &program, ScheduleView schedule, const glm::dvec3 &wi,
                            std::span<glm::vec4> values, const Camera *camera, const glm::dvec3 *eye,
                            const LightPath<float> &path) const {
  NodeContext context;
  context.normalisation = normalisation_;
  context.camera = camera;
  context.wo = glm::vec3(-wi);
  context.eye = eye;
  context.path = path;
  run(program, schedule, context, values);
}

void Environment::make_maps(const BuildContext &context, bool glass) {
  count_made(context, &MadeCounts::skies);
  const MapSize size = map_size(world_.map_resolution, image_width(world_));
  const uint32_t width = size.width, height = size.height, looks = size.looks;
  NodeScene scene;
  scene.normalisation = normalisation_;
  const std::vector<Sun> suns = find_suns(world_, scene);
  const std::vector<Node> nodes = without_suns(world_, suns);
  ProgramView plain = world_.program;
  plain.nodes = nodes;
  const ProgramView &program = plain;
  const DirectionMap grid(width, height, std::vector<float>(size_t(width) * height, 1.0f), context);
  std::vector<float> weights(size_t(width) * height);
  std::vector<double> totals(height);
  const uint32_t of_cell = looks * looks;
  // All lookups of a column have one azimuth.
  std::vector<SinCos<double>> azimuths(size_t(width) * looks);
  for (size_t i = 0; i < azimuths.size(); ++i)
    azimuths[i] = grid.azimuth(double(i / looks) + (double(i % looks) + 0.5) / looks);
  parallel_for(context, height, [&](size_t row) {
    SkyLooks lanes(program, world_, scene);
    std::vector<SinCos<double>> polars(looks);
    for (uint32_t look = 0; look < looks; ++look)
      polars[look] = grid.polar(double(row) + (look + 0.5) / looks);
    float sum = 0.0f;
    LookOfRow aimed, found;
    while (aimed.column < width) {
      uint32_t used = 0;
      for (; used < uint32_t(kBlockLanes) && aimed.column < width; ++used) {
        lanes.aim(used, DirectionMap::direction(polars[aimed.up], azimuths[size_t(aimed.column) * looks + aimed.across]));
        aimed.next(looks);
      }
      lanes.run(used);
      for (uint32_t lane = 0; lane < used; ++lane) {
        sum += weight_of(lanes.radiance(lane));
        const uint32_t column = found.column;
        if (!found.next(looks))
          continue;
        float &weight = weights[row * width + column];
        const float mean = sum / float(of_cell);
        weight = std::isfinite(mean) ? mean : 0.0f;
        totals[row] += double(weight) * grid.solid_angle(uint32_t(row));
        sum = 0.0f;
      }
    }
  });
  mean_ = std::accumulate(totals.begin(), totals.end(), 0.0) / (4.0 * glm::pi<double>());
  const double sky = mean_;
  std::vector<double> fluxes;
  double light = 0.0;
  for (const Sun &sun : suns)
    light += fluxes.emplace_back(flux_of(sun, plain));
  mean_ += light / (4.0 * glm::pi<double>());
  // Where all lookups are black, the remaining light must be small, and the map becomes uniform.
  const auto map_of = [&](float least) {
    std::vector<float> above(weights);
    double sum = 0.0;
    for (uint32_t row = 0; row < height; ++row)
      for (float *weight = above.data() + size_t(row) * width, *end = weight + width; weight != end; ++weight) {
        *weight = std::max(*weight - least, 0.0f);
        sum += double(*weight) * grid.solid_angle(row);
      }
    const float even = sum > 0.0 ? kEvenShare * float(sum / (4.0 * glm::pi<double>())) : 1.0f;
    for (float &weight : above)
      weight += even;
    DirectionMap map(width, height, above, context);
    // Give each sun a share of the samples by its light, relative to the light that this map samples.
    const double of_suns = std::min(light / (light + sum), kSunShare);
    for (size_t i = 0; i < suns.size(); ++i)
      if (fluxes[i] > 0.0)
        map.add_disc(suns[i].axis, suns[i].half_angle, of_suns * (fluxes[i] / light));
    return map;
  };
  // A world that gives light samples on some surfaces alone loses light on the others by their weight: as in Cycles, where they
  // are in proportion to the radiance.
  const float least = world_.lit_surfaces != 0 ? 0.0f : float(sky);
  maps_ = std::make_shared<const Maps>(map_of(least), glass ? map_of(0.0f) : DirectionMap());
}

double Environment::flux_of(const Sun &sun, const ProgramView &plain) const {
  DirectionMap disc(4, 2, std::vector<float>(8, 1.0f));
  disc.add_disc(sun.axis, sun.half_angle, 0.5);
  std::vector<glm::vec4> values(world_.program.value_count());
  double sum = 0.0;
  for (int i = 0; i < kSunLooks * kSunLooks; ++i) {
    // The first half of the numbers is the disc's.
    const glm::vec2 u((float(i % kSunLooks) + 0.5f) / (2 * kSunLooks), (float(i / kSunLooks) + 0.5f) / kSunLooks);
    const glm::dvec3 wi = disc.sample(u).direction;
    sum += double(weight_of(evaluate(world_.program, wi, values, nullptr, nullptr))) -
           double(weight_of(evaluate(plain, wi, values, nullptr, nullptr)));
  }
  const double s = sin(0.5 * sun.half_angle);
  return std::max(sum, 0.0) / (kSunLooks * kSunLooks) * 4.0 * glm::pi<double>() * s * s;
}

double Environment::pdf_in_proportion(const glm::vec3 &radiance) const {
  return mean_ > 0.0 ? double(weight_of(radiance)) / (4.0 * glm::pi<double>() * mean_) : 0.0;
}

LightSample Environment::sample(const glm::vec2 &u, std::span<glm::vec4> values, const Camera *camera, bool transmits) const {
  LightSample sample;
  sample.distance = std::numeric_limits<double>::infinity();
  if (!is_light())
    return sample;
  const DirectionMap::Sample found = map(transmits).sample(u);
  sample.wi = found.direction;
  sample.pdf = found.pdf;
  if (sample.pdf > 0.0)
    sample.radiance = evaluate(sample.wi, values, camera, nullptr);
  return sample;
}

} // namespace lancer
