// lancer_rays WORK THREADS PASSES [LEAK_RAYS]: our accelerator on a file of rays, in batches like integrators', as JSON.
//
// With LEAK_RAYS the mesh must be closed around the origin, and that many rays from inside aim at its vertices and edges.
#include "work.h"

#include "objects.h"

#include <random>

namespace {

using namespace lancer;

void check(lancer_status status) {
  if (status != LANCER_OK && status != LANCER_RUNNING)
    fail(lancer_last_error());
}

lancer_scene build(const Work &work, unsigned threads, double &seconds) {
  lancer_scene scene = 0;
  check(lancer_scene_create(&scene));
  lancer_material material = {};
  material.name = "black";
  for (lancer_parameter *value : {&material.emission, &material.transmittance, &material.holdout, &material.ambient,
                                  &material.displacement, &material.normal})
    value->node = -1;
  check(lancer_scene_add_material(scene, &material));
  lancer_mesh mesh = {};
  mesh.name = "mesh";
  mesh.positions = work.positions.data();
  mesh.triangles = work.corners.data();
  mesh.vertex_count = uint32_t(work.positions.size() / 3);
  mesh.triangle_count = uint32_t(work.corners.size() / 3);
  check(lancer_scene_add_mesh(scene, &mesh));
  lancer_instance instance = {};
  instance.matrix[0] = instance.matrix[5] = instance.matrix[10] = 1.0;
  instance.slot_count = 1;
  const uint32_t slot = 0;
  const char names[] = "mesh";
  check(lancer_scene_add_instances(scene, 1, &instance, 1, &slot, names, sizeof names));
  const double started = now();
  check(lancer_scene_commit(scene, LANCER_BVH, threads));
  while (lancer_status status = lancer_scene_wait(scene, 1000))
    check(status);
  seconds = now() - started;
  return scene;
}

// Rays in the accelerator's own frame, converted before the clock starts.
std::vector<Ray> rays_of(const Scene &scene, const RaySet &set) {
  std::vector<Ray> result(set.rays.size());
  for (size_t i = 0; i < result.size(); ++i) {
    const FileRay &ray = set.rays[i];
    result[i].o = scene.normalisation.to_normalised(glm::dvec3(ray.o[0], ray.o[1], ray.o[2]));
    result[i].d = glm::dvec3(ray.d[0], ray.d[1], ray.d[2]) * scene.normalisation.scale;
    result[i].tmax = double(ray.tmax);
  }
  return result;
}

double measure(const Scene &scene, const RaySet &set, unsigned threads, int passes, size_t &hits, TraversalCounts &counts) {
  const std::vector<Ray> rays = rays_of(scene, set);
  counts = scene.accelerator->count(rays, set.any);
  std::vector<Hit> found(set.any ? 0 : rays.size());
  std::vector<uint8_t> occluded(set.any ? rays.size() : 0);
  const double rate = best_rate(rays.size(), passes, [&] {
    return timed(threads, rays.size(), 1024, [&](size_t first, size_t end) {
      const std::span<const Ray> batch(rays.data() + first, end - first);
      if (set.any) {
        scene.accelerator->any_hit(batch, std::span(occluded.data() + first, batch.size()));
      } else {
        // Hits are empty before the call, as in integrators.
        std::fill(found.begin() + long(first), found.begin() + long(end), Hit{});
        scene.accelerator->closest_hit(batch, std::span(found.data() + first, batch.size()));
      }
    });
  });
  hits = 0;
  for (const Hit &hit : found)
    hits += hit.valid();
  for (const uint8_t one : occluded)
    hits += one;
  return rate;
}

// Returns the number of rays from inside the mesh that miss it.
size_t count_leaks(const Scene &scene, const Work &work, unsigned threads, size_t count) {
  std::atomic<size_t> leaks{0};
  timed(threads, count, 1 << 14, [&](size_t first, size_t end) {
    std::mt19937_64 random(first);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto vertex = [&](uint32_t i) {
      return glm::dvec3(work.positions[3 * i], work.positions[3 * i + 1], work.positions[3 * i + 2]);
    };
    std::vector<Ray> rays(end - first);
    for (Ray &ray : rays) {
      const size_t triangle = random() % (work.corners.size() / 3);
      const glm::dvec3 a = vertex(work.corners[3 * triangle]), b = vertex(work.corners[3 * triangle + 1]);
      // Half of the rays aim at a vertex, half at a point of an edge.
      const double along = random() % 2 ? 0.0 : unit(random);
      const glm::dvec3 target = a + along * (b - a);
      const glm::dvec3 origin = 0.2 * glm::dvec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
      ray.o = scene.normalisation.to_normalised(origin);
      ray.d = scene.normalisation.to_normalised(target) - ray.o;
    }
    std::vector<Hit> hits(rays.size());
    scene.accelerator->closest_hit(rays, hits);
    size_t missed = 0;
    for (const Hit &hit : hits)
      missed += !hit.valid();
    leaks.fetch_add(missed);
  });
  return leaks.load();
}

} // namespace

int main(int count, char **words) {
  if (count != 4 && count != 5)
    fail("usage: lancer_rays WORK THREADS PASSES [LEAK_RAYS]");
  const Work work = load_work(words[1]);
  const unsigned threads = unsigned(std::atoi(words[2]));
  const int passes = std::atoi(words[3]);
  double seconds = 0.0;
  const lancer_scene handle = build(work, threads, seconds);
  const std::shared_ptr<const Scene> scene = scene_of(handle)->committed();
  std::printf("{\"build_seconds\": %g, \"instruction_set\": \"%s\"", seconds, scene->accelerator->instruction_set());
  for (const RaySet &set : work.sets) {
    size_t hits = 0;
    TraversalCounts counts;
    const double rate = measure(*scene, set, threads, passes, hits, counts), rays = double(set.rays.size());
    std::printf(", \"%s\": {\"rate\": %g, \"hits\": %zu, \"nodes\": %g, \"leaves\": %g}", set.name.c_str(), rate, hits,
                double(counts.nodes) / rays, double(counts.triangle_blocks) / rays);
  }
  if (count == 5) {
    const size_t rays = size_t(std::atof(words[4]));
    std::printf(", \"leak_rays\": %zu, \"leaks\": %zu", rays, count_leaks(*scene, work, threads, rays));
  }
  std::printf("}\n");
  return 0;
}
