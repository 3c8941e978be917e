#include "lights/make_emitters.h"

#include "accel/parallel.h"

#include <map>

namespace lancer {

std::vector<Emitter> make_emitters(const Geometry &geometry, const std::vector<uint32_t> &slots,
                                   const std::vector<Material> &materials, const EmissionAt &emission,
                                   const BuildContext &context) {
  // Collect what emits: exact surfaces by themselves, meshes by what they may share.
  using Key = std::pair<uint32_t, std::vector<uint32_t>>;
  struct Shared {
    uint32_t users = 0;
    std::shared_ptr<const EmissiveFaces> faces;
  };
  std::map<Key, Shared> shared;
  std::vector<std::pair<uint32_t, Shared *>> emitting;
  for (uint32_t i = 0; i < geometry.instances.size(); ++i) {
    const Instance &instance = geometry.instances[i];
    const auto begin = slots.begin() + instance.first_slot, end = begin + instance.slot_count;
    if (std::none_of(begin, end, [&](uint32_t slot) { return is_light(materials[slot]); }))
      continue;
    Shared *user = nullptr;
    if (instance.kind == ShapeKind::Mesh) {
      user = &shared[{instance.mesh, std::vector<uint32_t>(begin, end)}];
      ++user->users;
    }
    emitting.push_back({i, user});
  }
  // Make the lights in the order of the instances.
  std::vector<Emitter> emitters;
  for (const auto &[instance, user] : emitting) {
    poll_cancel(context);
    if (!user) {
      Emitter emitter(geometry, slots, materials, instance, emission);
      if (!emitter.empty())
        emitters.push_back(std::move(emitter));
      continue;
    }
    if (!user->faces)
      user->faces = std::make_shared<EmissiveFaces>(geometry, slots, materials, instance, user->users > 1, emission, context);
    if (!user->faces->empty())
      emitters.emplace_back(geometry, instance, user->faces);
  }
  return emitters;
}

} // namespace lancer
