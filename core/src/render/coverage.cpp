#include "render/coverage.h"

#include "integrator/aov/vectors.h"
#include "integrator/stages/light_passes.h"
#include "lancer.h"

#include <limits>

namespace lancer {

namespace {

// A box of at most this many blocks is marked without a test of its triangles.
constexpr uint32_t kSmallBox = 4;

bool seen_by_camera(uint32_t hidden_from) { return !(hidden_from & LANCER_RAY_CAMERA); }

// A side of a convex polygon. inside() returns an upper bound of a point's signed distance from the side (positive inwards)
// times the side's length.
struct Side {
  glm::dvec2 from, inwards; // inwards: as long as the side
  double length, doubt;     // doubt: bound of the rounding error per unit of a point's distance

  double inside(const glm::dvec2 &point, double reach) const {
    const glm::dvec2 apart = point - from;
    return glm::dot(inwards, apart) + reach * length + doubt * (glm::length(apart) + glm::length(from));
  }
};

} // namespace

Coverage::Coverage(const Scene &scene, const Camera &camera, double filter_width, uint64_t effort)
    : across_((camera.region_width + kBlock - 1) / kBlock), up_((camera.region_height + kBlock - 1) / kBlock) {
  blocks_.assign(size_t(across_) * up_, 0);
  const Projection projection(camera, filter_width);
  add_lamps(scene.lights, projection);
  if (!add_surfaces(scene.geometry, projection, effort) || std::ranges::count(blocks_, 0) == 0)
    blocks_.clear();
  points_ = {};
  pixels_ = {};
}

void Coverage::add_lamps(const LightSet &lights, const Projection &projection) {
  for (uint32_t number = 0; number < lights.lamps().size(); ++number)
    if (const DescribedLight lamp = describe(lights.lamps()[number], number);
        lamp.met && !lamp.distant() && seen_by_camera(lights.hidden_from(number)))
      mark(around(projection, projection.to_camera(), lamp.bounds.low, lamp.bounds.high));
}

// Returns false where the triangles exceed the effort, or where a surface has no bounds.
bool Coverage::add_surfaces(const GeometryView &geometry, const Projection &projection, uint64_t effort) {
  const auto spend = [&](uint64_t triangles) {
    const bool enough = triangles <= effort;
    effort -= enough ? triangles : 0;
    return enough;
  };
  // Bound every mesh once.
  struct Bounds {
    glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
  };
  std::vector<Bounds> bounds(geometry.meshes.size());
  for (size_t i = 0; i < geometry.meshes.size(); ++i) {
    if (!spend(geometry.meshes[i].positions.size()))
      return false;
    for (const glm::vec3 &position : geometry.meshes[i].positions)
      bounds[i] = {glm::min(bounds[i].low, position), glm::max(bounds[i].high, position)};
  }
  // Mark the pixels of each instance: those of its box if the box is small or already marked, otherwise those of its triangles.
  for (const Instance &instance : geometry.instances) {
    if (!seen_by_camera(instance.hidden_from))
      continue;
    if (instance.kind == ShapeKind::Plane)
      return false;
    const bool is_mesh = instance.kind == ShapeKind::Mesh;
    if (is_mesh && geometry.meshes[instance.mesh].triangles.empty())
      continue;
    const Affine to_camera = projection.to_camera() * instance.to_world;
    const Bounds of_shape = is_mesh ? bounds[instance.mesh] : Bounds{glm::vec3(-1.0f), glm::vec3(1.0f)};
    const Blocks box = around(projection, to_camera, of_shape.low, of_shape.high);
    if (!is_mesh || box.count() <= kSmallBox)
      mark(box);
    else if (!marked(box)) {
      if (!spend(geometry.meshes[instance.mesh].triangles.size()))
        return false;
      add_triangles(projection, to_camera, geometry.meshes[instance.mesh]);
    }
  }
  return true;
}

void Coverage::add_triangles(const Projection &projection, const Affine &to_camera, const MeshView &mesh) {
  points_.resize(mesh.positions.size());
  pixels_.resize(mesh.positions.size());
  for (size_t i = 0; i < points_.size(); ++i) {
    points_[i] = to_camera.point(mesh.positions[i]);
    pixels_[i] = projection.pixel(points_[i]);
  }
  for (const glm::uvec3 &triangle : mesh.triangles) {
    const std::array<CameraPoint, 3> corners{points_[triangle.x], points_[triangle.y], points_[triangle.z]};
    double margin = 0.0;
    if (std::ranges::all_of(corners, [&](const CameraPoint &point) { return projection.is_beyond(point); })) {
      for (const CameraPoint &corner : corners)
        margin = std::max(margin, projection.margin(corner));
      add_polygon(std::array{pixels_[triangle.x], pixels_[triangle.y], pixels_[triangle.z]}, margin);
      continue;
    }
    std::array<CameraPoint, 4> left;
    std::array<glm::dvec2, 4> pixels;
    const uint32_t count = projection.clip(corners, left);
    for (uint32_t i = 0; i < count; ++i) {
      margin = std::max(margin, projection.margin(left[i]));
      pixels[i] = projection.pixel(left[i]);
    }
    if (count > 0)
      add_polygon(std::span(pixels).first(count), margin);
  }
}

// The polygon is convex. margin: in pixels, around it.
void Coverage::add_polygon(std::span<const glm::dvec2> corners, double margin) {
  glm::dvec2 low = corners[0], high = corners[0];
  for (const glm::dvec2 &corner : corners) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  const Blocks box = within(low - margin, high + margin);
  if (box.count() <= 1)
    return mark(box);
  if (marked(box))
    return;
  // Orient all sides inwards. A polygon so narrow that rounding decides its orientation is replaced by its box.
  double area = 0.0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 a = corners[i] - corners[0], b = corners[(i + 1) % corners.size()] - corners[0];
    area += a.x * b.y - a.y * b.x;
  }
  const glm::dvec2 size = high - low;
  const double turn = std::abs(area) > 1e-9 * glm::dot(size, size) ? std::copysign(1.0, area) : 0.0;
  std::array<Side, 4> sides;
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 along = turn * (corners[(i + 1) % corners.size()] - corners[i]);
    sides[i] = {corners[i], {-along.y, along.x}, glm::length(along), 1e-12 * glm::length(along)};
  }
  // Mark all blocks except those entirely outside some side.
  const double half = 0.5 * kBlock;
  for (uint32_t y = box.begin.y; y < box.end.y; ++y)
    for (uint32_t x = box.begin.x; x < box.end.x; ++x) {
      const glm::dvec2 middle((x + 0.5) * kBlock, (y + 0.5) * kBlock);
      const bool outside = std::any_of(sides.begin(), sides.begin() + ptrdiff_t(corners.size()), [&](const Side &side) {
        return side.inside(middle, margin) + half * (std::abs(side.inwards.x) + std::abs(side.inwards.y)) < 0.0;
      });
      if (!outside)
        blocks_[size_t(y) * across_ + x] = 1;
    }
}

Coverage::Blocks Coverage::around(const Projection &projection, const Affine &to_camera, const glm::dvec3 &low,
                                  const glm::dvec3 &high) const {
  glm::dvec2 least(std::numeric_limits<double>::infinity()), most(-least);
  double margin = 0.0;
  uint32_t beyond = 0;
  for (int i = 0; i < 8; ++i) {
    const CameraPoint corner = to_camera.point({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    if (!projection.is_beyond(corner))
      continue;
    ++beyond;
    margin = std::max(margin, projection.margin(corner));
    least = glm::min(least, projection.pixel(corner));
    most = glm::max(most, projection.pixel(corner));
  }
  if (beyond == 0)
    return {};
  if (beyond < 8)
    return {{0, 0}, {across_, up_}};
  return within(least - margin, most + margin);
}

// Returns the blocks of the pixels from low to high. Bounds that are not finite give all blocks.
Coverage::Blocks Coverage::within(const glm::dvec2 &low, const glm::dvec2 &high) const {
  if (!(low.x <= high.x && low.y <= high.y))
    return {{0, 0}, {across_, up_}};
  if (high.x < 0.0 || high.y < 0.0 || low.x > double(across_) * kBlock || low.y > double(up_) * kBlock)
    return {};
  const auto block = [](double pixel, uint32_t count) { return uint32_t(std::clamp(pixel / kBlock, 0.0, count - 1.0)); };
  return {{block(low.x, across_), block(low.y, up_)}, {block(high.x, across_) + 1, block(high.y, up_) + 1}};
}

bool Coverage::marked(const Blocks &blocks) const {
  for (uint32_t y = blocks.begin.y; y < blocks.end.y; ++y) {
    const auto row = blocks_.begin() + ptrdiff_t(size_t(y) * across_);
    if (std::find(row + blocks.begin.x, row + blocks.end.x, 0) != row + blocks.end.x)
      return false;
  }
  return true;
}

void Coverage::mark(const Blocks &blocks) {
  for (uint32_t y = blocks.begin.y; y < blocks.end.y; ++y)
    std::fill_n(blocks_.begin() + ptrdiff_t(size_t(y) * across_ + blocks.begin.x), blocks.end.x - blocks.begin.x, uint8_t(1));
}

namespace {

// Below kLeastPlanned samples, the search costs more time than it saves. Projecting kProjectedEach triangles per pixel takes
// about as long as one sample of the background.
constexpr uint32_t kLeastPlanned = 8;
constexpr uint64_t kProjectedEach = 8;

} // namespace

Background find_background(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Film &film) {
  // Surfaces and the camera are projected as they stand.
  const bool moves = scene.motion.shutter.opens() && ((scene.features & kFeatureMotion) || !scene.motion.cameras.empty());
  if (settings.kind() != IntegratorKind::Path || settings.bake || settings.samples < kLeastPlanned || settings.all_features() ||
      moves || sky_vectors_vary(settings) || !has_even_background(scene, camera))
    return Background();
  Background background;
  background.coverage = Coverage(scene, camera, settings.filter_width, kProjectedEach * film.width() * film.height());
  if (background.coverage.covers_all())
    return Background();
  const glm::uvec2 pixel = background.coverage.empty_pixel();
  const SampleAddress address{pixel.x, pixel.y, 0};
  const auto integrator = make_integrator(scene, camera, settings);
  integrator->run(std::span(&address, 1), std::span(&background.sample, 1), nullptr);
  background.extras = integrator->extras();
  if (settings.exposure != 1.0f) {
    expose(background.sample, settings.exposure, LightPasses(settings).wanted());
    background.extras.expose(settings.extras(), settings.exposure);
  }
  // The film drops and counts each sample that is not finite, so a background that is not finite is traced.
  return film.finite(background.sample, background.extras.channels.data()) ? background : Background();
}

bool has_even_background(const Scene &scene, const Camera &camera) {
  if (camera.is_panorama() || camera.is_stereo() || scene.lights.environment().varies() || !scene.world.output_nodes.empty())
    return false;
  for (uint32_t number = 0; number < scene.lights.lamps().size(); ++number)
    if (const DescribedLight lamp = describe(scene.lights.lamps()[number], number);
        lamp.met && lamp.distant() && !(scene.lights.hidden_from(number) & LANCER_RAY_CAMERA))
      return false;
  return true;
}

} // namespace lancer
