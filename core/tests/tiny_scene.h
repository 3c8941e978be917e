// A small scene through the C interface, for tests without Python.
#pragma once

#include "lancer.h"

#include <cmath>
#include <string>
#include <vector>

namespace lancer_test {

inline void place(double m[12], double x, double y, double z, double scale = 1.0) {
  const double rows[12] = {scale, 0, 0, x, 0, scale, 0, y, 0, 0, scale, z};
  std::copy(rows, rows + 12, m);
}

inline lancer_parameter parameter(float x, float y, float z) { return {{x, y, z}, -1}; }
inline lancer_parameter parameter(float x) { return parameter(x, x, x); }

inline lancer_lobe lobe(uint32_t kind, float color, float roughness = 0.3f) {
  lancer_lobe lobe = {};
  lobe.kind = kind;
  lobe.weight = lobe.edge = parameter(1.0f);
  lobe.color = parameter(color);
  lobe.roughness = parameter(roughness);
  lobe.ior = parameter(1.5f);
  lobe.shininess = parameter(20.0f);
  lobe.anisotropy = lobe.rotation = lobe.normal = lobe.tangent = parameter(0.0f);
  lobe.roughness_across = lobe.offset = lobe.film_thickness = parameter(0.0f);
  lobe.film_ior = parameter(1.33f);
  return lobe;
}

// opacity: share of light that does not pass straight through.
inline void add_material(lancer_scene scene, std::vector<lancer_lobe> lobes, float emission = 0.0f, float opacity = 1.0f) {
  lancer_material material = {};
  material.name = "material";
  for (lancer_lobe &lobe : lobes)
    lobe.weight = parameter(opacity);
  material.lobes = lobes.data();
  material.lobe_count = uint32_t(lobes.size());
  material.emission = parameter(emission * opacity);
  material.transmittance = parameter(1.0f - opacity);
  material.holdout = material.displacement = material.normal = parameter(0.0f);
  material.ambient = parameter(0.1f);
  lancer_scene_add_material(scene, &material);
}

inline lancer_light point_light() {
  lancer_light light = {};
  light.name = "lamp";
  place(light.matrix, 1.0, -2.0, 4.0);
  light.kind = LANCER_POINT;
  for (int i = 0; i < 3; ++i) {
    light.emission[i] = 30.0f;
    light.ambient_color[i] = light.diffuse_color[i] = light.specular_color[i] = 1.0f;
  }
  light.radius = 0.2f;
  light.soft_falloff = 1;
  return light;
}

// A plane, a glass and a coated sphere, a half transparent cone, an emitting tetrahedron; a lamp and a sky.
inline lancer_scene make_scene(uint32_t accelerator = LANCER_BVH, uint32_t shading = LANCER_SHADING_AS_MESH) {
  lancer_scene scene = 0;
  lancer_scene_create(&scene);
  add_material(scene, {lobe(LANCER_LAMBERT, 0.6f), lobe(LANCER_BECKMANN, 0.5f)});
  add_material(scene, {lobe(LANCER_DIELECTRIC, 1.0f)});
  add_material(scene, {lobe(LANCER_LAMBERT, 0.3f), lobe(LANCER_PHONG, 0.3f), lobe(LANCER_BLINN_PHONG, 0.2f)}, 0.0f, 0.5f);
  add_material(scene, {lobe(LANCER_MIRROR, 0.8f)}, 2.0f);
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  lancer_mesh mesh = {};
  mesh.name = "tetrahedron";
  mesh.positions = positions;
  mesh.triangles = triangles;
  mesh.vertex_count = 4;
  mesh.triangle_count = 4;
  lancer_scene_add_mesh(scene, &mesh);
  const uint32_t kinds[] = {LANCER_PLANE, LANCER_SPHERE, LANCER_SPHERE, LANCER_CONE, LANCER_MESH, LANCER_CYLINDER};
  const uint32_t slots[] = {0, 1, 0, 2, 3, 2};
  const double x[] = {0, -1.2, 1.2, 0, 0, 2.5}, z[] = {0, 1, 1, 1, 2, 0.5};
  lancer_instance instances[6] = {};
  for (uint32_t i = 0; i < 6; ++i) {
    place(instances[i].matrix, x[i], 0.3 * i, z[i], i == 5 ? 0.5 : 1.0);
    instances[i].kind = kinds[i];
    instances[i].first_slot = i;
    instances[i].slot_count = 1;
    instances[i].shading = shading;
    instances[i].object_index = i;
  }
  lancer_scene_add_instances(scene, 6, instances, 6, slots, nullptr, 0);
  const lancer_light light = point_light();
  lancer_scene_add_light(scene, &light);
  lancer_world sky = {};
  sky.radiance = parameter(0.1f, 0.2f, 0.3f);
  lancer_scene_set_world(scene, &sky);
  lancer_scene_commit(scene, accelerator, 1);
  while (lancer_scene_wait(scene, 50) == LANCER_RUNNING)
    ;
  return scene;
}

inline lancer_camera make_camera(uint32_t width = 24, uint32_t height = 16) {
  lancer_camera camera = {};
  // Facing +y from -y: local x = world x, local y = world z.
  const double m[12] = {1, 0, 0, 0, 0, 0, -1, -6, 0, 1, 0, 1.2};
  std::copy(m, m + 12, camera.matrix);
  camera.width = camera.region_width = width;
  camera.height = camera.region_height = height;
  const double window[4] = {-0.6, 0.6, -0.4, 0.4};
  std::copy(window, window + 4, camera.window);
  camera.clip_start = 0.1;
  camera.clip_end = 100.0;
  camera.focal_distance = 6.0;
  camera.aperture_ratio = 1.0;
  return camera;
}

inline lancer_settings make_settings(uint32_t integrator = LANCER_PATH) {
  lancer_settings settings = {};
  settings.integrator = integrator;
  settings.samples = 8;
  settings.max_bounces = 6;
  settings.diffuse_bounces = settings.glossy_bounces = settings.transmission_bounces = 1024;
  settings.exposure = settings.fast_factor = 1.0f;
  settings.transparent_bounces = settings.transparent_shadows = 8;
  settings.alpha_threshold = 0.5f;
  settings.pixel_filter = LANCER_FILTER_BLACKMAN_HARRIS;
  settings.filter_width = 1.5f;
  settings.passes = (1u << LANCER_PASS_COUNT) - 1;
  settings.threads = 2;
  return settings;
}

inline lancer_status finish(lancer_session session) {
  lancer_status status;
  while ((status = lancer_session_wait(session, 50, nullptr)) == LANCER_RUNNING)
    ;
  return status;
}

} // namespace lancer_test
