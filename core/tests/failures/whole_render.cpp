#include "whole_render.h"
#include "lancer_probes.h"

#include "../tiny_scene.h"
#include "whole_scene.h"

#include <cstdio>

namespace lancer_test {

namespace {

// Makes calls in sequence as long as they succeed.
class Calls {
public:
  explicit Calls(RenderOutcome &outcome) : outcome_(outcome) {}

  template <class Call> void make(const char *name, Call &&call) {
    if (!outcome_.whole())
      return;
    lancer_status status;
    while ((status = call()) == LANCER_RUNNING)
      ;
    if (status == LANCER_OK)
      return;
    outcome_.call = name;
    outcome_.status = status;
    std::snprintf(outcome_.message, sizeof outcome_.message, "%s", lancer_last_error());
  }
  bool well() const { return outcome_.whole(); }

private:
  RenderOutcome &outcome_;
};

void fill(lancer_scene scene, Calls &calls) {
  const WholeScene &s = whole_scene();
  for (const lancer_mesh &mesh : s.meshes)
    calls.make("add_mesh", [&] { return lancer_scene_add_mesh(scene, &mesh); });
  for (const lancer_image &image : s.images)
    calls.make("add_image", [&] { return lancer_scene_add_image(scene, &image); });
  for (const lancer_material &material : s.materials)
    calls.make("add_material", [&] { return lancer_scene_add_material(scene, &material); });
  for (const lancer_light &light : s.lights)
    calls.make("add_light", [&] { return lancer_scene_add_light(scene, &light); });
  calls.make("set_world", [&] { return lancer_scene_set_world(scene, &s.world); });
  calls.make("add_instances", [&] {
    return lancer_scene_add_instances(scene, uint32_t(s.instances.size()), s.instances.data(),
                                      uint32_t(s.instance_slots.size()), s.instance_slots.data(), nullptr, 0);
  });
}

void ask_scene(lancer_scene scene, Calls &calls) {
  char text[1024];
  size_t needed = 0;
  calls.make("messages", [&] { return lancer_scene_messages(scene, text, sizeof text, &needed); });
  const double origin[3] = {0, 0, 9}, direction[3] = {0.1, 0.05, -1}, low = 0, high = 100;
  const float wo[3] = {0.6f, 0.0f, 0.8f}, u[3] = {0.3f, 0.6f, 0.2f};
  lancer_hit hit;
  uint8_t occluded;
  lancer_bsdf_sample sample;
  lancer_light_sample light;
  lancer_lobe_info lobes[4];
  uint32_t count;
  float four[4], pdf;
  calls.make("probe_intersect", [&] { return lancer_probe_intersect(scene, 1, origin, direction, &low, &high, &hit); });
  calls.make("probe_occluded", [&] { return lancer_probe_occluded(scene, 1, origin, direction, &low, &high, &occluded); });
  calls.make("probe_bsdf_sample", [&] { return lancer_probe_bsdf_sample(scene, 0, 1, wo, u, &sample); });
  calls.make("probe_lobes", [&] { return lancer_probe_lobes(scene, 0, wo, lobes, 4, &count, nullptr, nullptr); });
  calls.make("probe_node", [&] { return lancer_probe_node(scene, 2, 1, 1, u, four); });
  calls.make("probe_world", [&] { return lancer_probe_world(scene, 1, direction, four, &pdf); });
  calls.make("probe_light", [&] { return lancer_probe_light(scene, 0, 1, origin, u, &light); });
}

// Doubles the samples of all pixels, then of those with the most benefit; and stops a range that has ended.
void refine(lancer_session session, Calls &calls) {
  for (const double target : {0.0, 0.01}) {
    calls.make("session_refine", [&] { return lancer_session_refine(session, target, 0.95); });
    calls.make("session_wait", [&] { return lancer_session_wait(session, 50, nullptr); });
    calls.make("session_stop", [&] { return lancer_session_stop(session); });
    calls.make("session_wait", [&] { return lancer_session_wait(session, 50, nullptr); });
  }
}

void use_session(lancer_session session, bool refines, std::span<float> picture, Calls &calls) {
  for (uint32_t first : {0, 1})
    for (const bool wait : {false, true})
      calls.make(wait ? "session_wait" : "session_render", [&] {
        return wait ? lancer_session_wait(session, 50, nullptr)
                    : lancer_session_render(session, first, first && !refines ? 2 : 1);
      });
  if (refines)
    refine(session, calls);
  lancer_error error;
  calls.make("session_error", [&] { return lancer_session_error(session, 0.95, &error); });
  lancer_statistics statistics;
  calls.make("statistics", [&] { return lancer_session_statistics(session, &statistics); });
  float rgba[4];
  lancer_vertex vertices[4];
  uint32_t count;
  calls.make("debug_sample", [&] { return lancer_debug_sample(session, 4, 4, 1, rgba, vertices, 4, &count); });
  // Try channel counts until the call accepts one.
  float *out = picture.data();
  for (uint32_t pass = 0; pass < LANCER_PASS_COUNT && calls.well(); ++pass)
    for (const size_t channels : {1, 3, 4}) {
      const size_t floats = channels * kWholeSide * kWholeSide;
      const lancer_status status = lancer_session_read(session, pass, out, floats);
      if (status == LANCER_ERROR_ARGUMENT)
        continue;
      calls.make("read", [&] { return status; });
      out += floats;
      break;
    }
}

// Calls that are valid after a failure: all of them return, and a scene that was not committed stays uncommitted.
void ask_again(lancer_scene scene, lancer_session session, std::span<float> picture, Calls &calls) {
  const lancer_camera camera = make_camera(kWholeSide, kWholeSide);
  const lancer_settings settings = make_settings();
  if (scene && !session) {
    char text[64];
    lancer_scene_messages(scene, text, sizeof text, nullptr);
    lancer_status status;
    while ((status = lancer_scene_wait(scene, 50)) == LANCER_RUNNING)
      ;
    lancer_session other = 0;
    const lancer_status created = lancer_session_create(scene, &camera, &settings, &other);
    if (created == LANCER_OK)
      lancer_session_destroy(other);
    calls.make("session_create after a failure", [&] { return status != LANCER_OK && created == LANCER_OK; });
  }
  if (session) {
    lancer_statistics statistics;
    finish(session);
    lancer_session_statistics(session, &statistics);
    lancer_error error;
    lancer_session_error(session, 0.95, &error);
    lancer_session_read(session, LANCER_PASS_COMBINED, picture.data(), 4 * kWholeSide * kWholeSide);
  }
}

} // namespace

void prepare_whole() { whole_scene(); }

RenderOutcome render_whole(const RenderKind &kind, std::span<float> picture) {
  RenderOutcome outcome;
  Calls calls(outcome);
  lancer_scene scene = 0;
  calls.make("scene_create", [&] { return lancer_scene_create(&scene); });
  fill(scene, calls);
  calls.make("commit", [&] { return lancer_scene_commit(scene, kind.accelerator, kind.threads); });
  calls.make("scene_wait", [&] { return lancer_scene_wait(scene, 50); });
  ask_scene(scene, calls);
  lancer_camera camera = make_camera(kWholeSide, kWholeSide);
  camera.lens_radius = 0.01;
  lancer_settings settings = make_settings(kind.integrator);
  settings.threads = kind.threads;
  settings.tile_size = 5;
  settings.max_bounces = 3;
  settings.refines = kind.refines;
  lancer_session session = 0;
  calls.make("session_create", [&] { return lancer_session_create(scene, &camera, &settings, &session); });
  use_session(session, kind.refines, picture, calls);
  // Destroying handles must work without memory.
  RenderOutcome end;
  Calls ends(end);
  if (!outcome.whole())
    ask_again(scene, session, picture, ends);
  if (session)
    ends.make("session_destroy", [&] { return lancer_session_destroy(session); });
  if (scene)
    ends.make("scene_destroy", [&] { return lancer_scene_destroy(scene); });
  return end.whole() ? outcome : end;
}

} // namespace lancer_test
