// Filtered hits: every accelerator skips rejected hits within one traversal, and passes all hits on the way to the filter.
#include "accel_scenes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>
#include <tuple>

namespace lancer::test {
namespace {

// A hit that was passed to the filter.
using Place = std::tuple<double, uint32_t, uint32_t>;
Place place_of(const Hit &hit) { return {hit.t, hit.instance, hit.primitive}; }

// Accepts some surfaces, chosen by number, and records the calls.
struct Chooser final : HitFilter {
  uint32_t share;              // one in this many counts; 0: none
  std::vector<uint8_t> chosen; // by instance
  std::vector<std::set<Place>> asked;

  Chooser(const Geometry &geometry, uint32_t one_in, size_t rays) : HitFilter(nullptr), share(one_in), asked(rays) {
    for (uint32_t i = 0; i < geometry.instances.size(); ++i)
      chosen.push_back(i % 5 != 4);
    instances = chosen.data();
  }
  bool accepts(const Hit &hit) const {
    return !chosen[hit.instance] || (share > 0 && (hit.instance * 2654435761u + hit.primitive * 40503u) / 7 % share == 0);
  }
  bool counts(size_t ray, const Hit &hit) override {
    asked[ray].insert(place_of(hit));
    return accepts(hit);
  }
};

// Returns all hits of a ray, found one by one.
std::vector<Hit> all_hits(const Accelerator &accelerator, Ray ray) {
  std::vector<Hit> hits;
  for (Hit hit = closest(accelerator, ray); hit.valid(); hit = closest(accelerator, ray)) {
    hits.push_back(hit);
    ray.tmin = hit.t;
  }
  return hits;
}

// Rays from everywhere, and neighbouring rays of a small picture.
std::vector<Ray> some_rays(Random &random, const Geometry &geometry) {
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < 1024; ++i)
    rays.push_back(
        make_ray({0.1 * (i % 32) - 1.6, 0.1 * (i / 32.0) - 1.6, 12.0}, {0.001 * (i % 32), 0.002 * (i / 32.0), -1.0}));
  for (int i = 0; i < 1000; ++i) {
    Ray ray = make_ray(random.in_box(9.0), random.direction() * std::exp2(random.uniform(-9.0, 9.0)));
    ray.kinds = 1 + random.below(3);
    if (random.below(4) == 0)
      ray.tmin = random.uniform(-3.0, 3.0) / glm::length(ray.d);
    if (random.below(4) == 0)
      ray.tmax = random.uniform(0.0, 12.0) / glm::length(ray.d);
    if (random.below(4) == 0) {
      ray.skip_instance = random.below(static_cast<uint32_t>(geometry.instances.size()));
      ray.skip_primitive = random.below(4);
    }
    rays.push_back(ray);
  }
  return rays;
}

TEST(AcceleratorFilter, GoesOnPastWhatDoesNotCount) {
  Random random(21);
  const Geometry geometry = everything(random, 24, 300, 6.0);
  const std::vector<Ray> rays = some_rays(random, geometry);
  const std::vector<Contestant> all = all_accelerators(geometry);
  std::vector<std::vector<Hit>> met;
  size_t layers = 0;
  for (const Ray &ray : rays) {
    met.push_back(all_hits(*all[0].accelerator, ray));
    layers += met.back().size();
  }
  EXPECT_GT(layers, 3 * rays.size());
  for (const uint32_t one_in : {1u, 3u, 40u, 0u})
    for (const Contestant &c : all) {
      Chooser near(geometry, one_in, rays.size()), any(geometry, one_in, rays.size());
      std::vector<Hit> hits(rays.size());
      std::vector<uint8_t> occlusion(rays.size(), 7);
      c.accelerator->closest_hit(rays, hits, near);
      c.accelerator->any_hit(rays, occlusion, any);
      for (size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE(testing::Message() << c.name << ", ray " << i << ", one in " << one_in);
        const auto end = std::ranges::find_if(met[i], [&](const Hit &hit) { return near.accepts(hit); });
        ASSERT_TRUE(same_bits(hits[i], end == met[i].end() ? Hit{} : *end));
        ASSERT_EQ(occlusion[i], end != met[i].end());
        // The filter saw each layer of the chain; for a ray without occluder it saw nothing else.
        std::set<Place> passed;
        for (auto hit = met[i].begin(); hit != end; ++hit) {
          passed.insert(place_of(*hit));
          ASSERT_TRUE(near.asked[i].contains(place_of(*hit)));
        }
        if (end == met[i].end()) {
          ASSERT_EQ(near.asked[i], passed);
          ASSERT_EQ(any.asked[i], passed);
        }
      }
    }
}

TEST(AcceleratorFilter, CoincidentSurfacesAreAllAskedAbout) {
  // The same square as three instances, one upside down, and twice within the mesh.
  Geometry geometry;
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}};
  geometry.meshes.push_back(mesh);
  for (int i = 0; i < 3; ++i)
    geometry.instances.push_back(
        placed(ShapeKind::Mesh, i == 1 ? glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1) : glm::dmat3(1.0), glm::dvec3(0.0)));
  const Ray ray = make_ray({0.5, 0.25, 2.0}, {0, 0, -1});
  for (const Contestant &c : all_accelerators(geometry)) {
    Chooser chooser(geometry, 0, 1);
    chooser.chosen.assign(3, 1);
    uint8_t occluded = 7;
    c.accelerator->any_hit({&ray, 1}, {&occluded, 1}, chooser);
    EXPECT_EQ(occluded, 0) << c.name;
    EXPECT_EQ(chooser.asked[0].size(), 6u) << c.name;
  }
}

} // namespace
} // namespace lancer::test
