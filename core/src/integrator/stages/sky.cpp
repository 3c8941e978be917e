#include "integrator/stages/sky.h"

#include "integrator/stages/light.h"

namespace lancer {

SkyStage::SkyStage(const Scene &scene, const Camera *camera) : scene_(scene), values_(scene.world.program.nodes.size()) {
  if (scene.lights.environment().is_light())
    for (const bool transmits : {false, true})
      maps_[transmits] = scene.lights.environment().table(transmits);
  nodes_.scene = scene.node_scene(camera);
  nodes_.surface = false;
}

void SkyStage::sample(SkyBlock &block, bool transmits) const { light_kernel().sample_sky(maps_[transmits], block); }

void SkyStage::find_density(SkyBlock &block, bool transmits) const { light_kernel().sky_density(maps_[transmits], block); }

void SkyStage::look(const Doubles (&wi)[3], uint32_t lanes) {
  nodes_.used = lanes;
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      // The normals of the world's surface point back to the viewer.
      const float back = float(-wi[axis][lane]);
      nodes_.p[axis][lane] = -double(back);
      nodes_.wo[axis][lane] = nodes_.ns[axis][lane] = nodes_.ng[axis][lane] = back;
    }
  node_kernel().run(scene_.world.program, scene_.world.schedule, nodes_, values_.data());
}

} // namespace lancer
