// From hits to surfaces and their lobes in lanes: the first step of both integrators after a traversal.
#pragma once

#include "integrator/stages/lane_access.h"
#include "integrator/stages/lobe_means.h"
#include "integrator/stages/shading.h"
#include "integrator/stages/vertex_kernel.h"

namespace lancer {

struct IntegratorSettings;

class SurfaceStage {
public:
  SurfaceStage(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);
  SurfaceStage(const SurfaceStage &) = delete; // its block has the address of its values
  SurfaceStage &operator=(const SurfaceStage &) = delete;

  uint32_t count() const { return count_; }
  bool full() const { return count_ == kBlockLanes; }
  // Adds a hit to the next lane and returns the lane. All hits of a block have materials of one class; ray and hit must stay in
  // place until clear().
  uint32_t add(const Ray &ray, const Hit &hit, const Material &material);
  // Replaces the surface of a lane, seen along a view direction of any length.
  void give(uint32_t lane, const Surface &surface, const glm::dvec3 &view);
  // Moves a lane to another place of its triangle.
  void move(uint32_t lane, const Hit &hit);
  // Computes the surfaces of all lanes.
  void find();
  // Whether the material has nodes; ask_nodes() evaluates them for the view of each lane.
  bool has_nodes() const { return !block.material[0]->fixed(); }
  void ask_nodes(std::span<const View> views);
  // Returns the view of a lane at the end of a path of length `way`, in normalised units.
  View view(uint32_t lane, double way, const LightPath<float> &path) const {
    return {.wo = get(block.wo, lane), .footprint = float(cone_.base + way * cone_.spread), .path = path};
  }
  void find_lobes() { kernel.lobes(block); }
  // Computes the means of the lobes that passes need.
  void describe();
  void clear();

  const Ray &ray(uint32_t lane) const { return *rays_[lane]; }
  const Hit &hit(uint32_t lane) const { return *hits_[lane]; }
  const Instance &instance(uint32_t lane) const { return scene_.geometry.instances[hit(lane).instance]; }
  Surface surface(uint32_t lane) const;
  glm::vec3 value(const Parameter &parameter, uint32_t lane) const;
  // Returns the share of a lane that becomes a hole in the picture.
  float holdout(uint32_t lane) const;
  // Returns 1 minus the transmittance, in 0 ... 1.
  glm::vec3 opacity(uint32_t lane) const { return glm::clamp(1.0f - transmittance[lane], 0.0f, 1.0f); }
  Mixture<float> mixture(uint32_t lane) const;
  // Writes the ray from a lane to its block's light sample in place. far: the light is at infinity.
  void write_shadow_ray(uint32_t lane, bool far, Ray &ray) const;

  const VertexKernel &kernel;
  VertexBlock block{};
  glm::vec3 emission[kBlockLanes], transmittance[kBlockLanes]; // of the material

private:
  void place_nodes(const Material &material, std::span<const View> views);

  // Scratch of the block: inputs of nodes, their values, and the lobes.
  struct alignas(64) Lobes {
    std::byte of[64];
  };

  const NodeKernel &node_kernel_;
  const Scene &scene_;
  Shader shader_;
  PixelCone cone_;
  uint32_t count_ = 0;
  const Ray *rays_[kBlockLanes];
  const Hit *hits_[kBlockLanes];
  NodeBlock nodes_;
  std::vector<NodeLanes> values_;
  std::vector<Lobes> lobes_;
};

} // namespace lancer
