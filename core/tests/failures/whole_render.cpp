#include "whole_render.h"

#include "../tiny_scene.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace lancer_test {

namespace {

constexpr uint32_t kGrid = 5, kFaces = 2 * (kGrid - 1) * (kGrid - 1), kTexels = 8, kLongProgram = 70;

lancer_parameter result_of(int32_t node) { return {{0, 0, 0}, node}; }

lancer_node node(uint32_t kind, uint32_t option = 0, std::initializer_list<lancer_parameter> inputs = {}) {
  lancer_node n = {};
  n.kind = kind;
  n.option = option;
  for (lancer_parameter &input : n.inputs)
    input = parameter(0.0f);
  std::copy(inputs.begin(), inputs.end(), n.inputs);
  n.matrix[0] = n.matrix[5] = n.matrix[10] = 1.0f;
  return n;
}

lancer_material black(const char *name) {
  lancer_material material = {};
  material.name = name;
  material.emission = material.transmittance = material.holdout = material.ambient = material.displacement = material.normal =
      parameter(0.0f);
  return material;
}

// What the records point to: made once, before anything is watched.
struct Parts {
  std::vector<float> positions, normals, uvs, colors, tangents;
  std::vector<uint32_t> triangles;
  std::vector<uint16_t> slots;
  std::vector<uint8_t> texels;
  std::vector<float> sky;
  std::array<lancer_attribute, 2> attributes;
  std::array<lancer_mesh, 2> meshes;
  std::vector<lancer_node> paint_nodes, leaf_nodes, sky_nodes;
  lancer_principled principled;
  std::vector<lancer_lobe> paint_lobes, glass_lobes, leaf_lobes, old_lobes;
  std::vector<lancer_material> materials;
  std::array<lancer_image, 2> images;
  std::vector<lancer_light> lights;
  lancer_world world;
  std::vector<lancer_instance> instances;
  std::vector<uint32_t> instance_slots;

  Parts() {
    make_meshes();
    make_images();
    make_materials();
    make_lights();
    make_instances();
  }
  Parts(const Parts &) = delete;
  Parts &operator=(const Parts &) = delete;

  void make_meshes() {
    for (uint32_t y = 0; y < kGrid; ++y)
      for (uint32_t x = 0; x < kGrid; ++x) {
        positions.insert(positions.end(), {float(x) - 2.0f, float(y) - 2.0f, float((x * y) % 3) * 0.1f});
        // One normal is none, and is told of.
        normals.insert(normals.end(), {x == 1 && y == 1 ? NAN : 0.0f, 0.0f, 1.0f});
      }
    for (uint32_t y = 0; y + 1 < kGrid; ++y)
      for (uint32_t x = 0; x + 1 < kGrid; ++x) {
        const uint32_t a = y * kGrid + x;
        triangles.insert(triangles.end(), {a, a + 1, a + kGrid, a + 1, a + kGrid + 1, a + kGrid});
      }
    for (uint32_t i = 0; i < 3 * kFaces; ++i) {
      const float *p = &positions[3 * size_t(triangles[i])];
      uvs.insert(uvs.end(), {p[0] / 4.0f + 0.5f, p[1] / 4.0f + 0.5f});
      colors.insert(colors.end(), {0.5f, uvs[2 * i], 0.8f});
      tangents.insert(tangents.end(), {1.0f, 0.0f, 0.0f, 1.0f});
    }
    for (uint32_t i = 0; i < kFaces; ++i)
      slots.push_back(uint16_t(i % 2));
    attributes = {{{"tangent:", tangents.data(), LANCER_DOMAIN_CORNER, 4}, {"dust", normals.data(), LANCER_DOMAIN_VERTEX, 1}}};
    meshes = {};
    lancer_mesh &grid = meshes[0];
    grid = {"grid",
            positions.data(),
            triangles.data(),
            normals.data(),
            uvs.data(),
            colors.data(),
            slots.data(),
            nullptr,
            attributes.data(),
            kGrid * kGrid,
            kFaces,
            LANCER_NORMALS_VERTEX,
            uint32_t(attributes.size())};
    lancer_mesh &plain = meshes[1];
    plain.name = "plain";
    plain.positions = positions.data();
    plain.triangles = triangles.data();
    plain.uvs = uvs.data();
    plain.vertex_count = kGrid * kGrid;
    plain.triangle_count = kFaces;
  }

  void make_images() {
    for (uint32_t i = 0; i < kTexels * kTexels; ++i) {
      texels.insert(texels.end(), {uint8_t(3 * i), uint8_t(255 - i), 90, uint8_t(i % 3 ? 255 : 0)});
      sky.insert(sky.end(), {0.1f, 0.2f, i == 20 ? 9.0f : 0.3f});
    }
    images = {};
    for (lancer_image &image : images) {
      image.name = "picture";
      image.width = image.height = kTexels;
      image.matrix[0] = image.matrix[4] = image.matrix[8] = 1.0f;
    }
    images[0].texels = texels.data();
    images[0].channels = 4;
    images[0].transfer = LANCER_TRANSFER_SRGB;
    images[0].alpha = LANCER_ALPHA_STRAIGHT;
    images[1].texels = sky.data();
    images[1].channels = 3;
    images[1].kind = LANCER_TEXEL_FLOAT;
  }

  void make_materials() {
    lancer_node look = node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, {result_of(0)});
    look.image_count = 1;
    lancer_node dust = node(LANCER_NODE_ATTRIBUTE);
    dust.name = "dust";
    paint_nodes = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV), look, dust};
    // So many that a bump's height finds no room on the stack.
    while (paint_nodes.size() < kLongProgram)
      paint_nodes.push_back(
          node(LANCER_NODE_MATH, LANCER_MATH_ADD, {result_of(int32_t(paint_nodes.size()) - 1), result_of(1), parameter(0.0f)}));
    const auto height = int32_t(paint_nodes.size()) - 1;
    paint_nodes.push_back(
        node(LANCER_NODE_BUMP, 0, {parameter(0.5f), parameter(0.01f), result_of(height), parameter(0.0f), parameter(1.0f)}));
    paint_nodes.push_back(node(LANCER_NODE_NORMAL_MAP, 0, {parameter(0.5f), result_of(1)}));
    paint_nodes.push_back(node(LANCER_NODE_DISPLACEMENT, 0, {result_of(1), parameter(0.5f), parameter(0.1f), parameter(0.0f)}));
    principled = {};
    principled.rules = LANCER_RULES_45;
    principled.base_color = result_of(1);
    for (lancer_parameter *p :
         {&principled.metallic, &principled.diffuse_roughness, &principled.specular_tint, &principled.anisotropic,
          &principled.anisotropic_rotation, &principled.transmission_roughness, &principled.coat_normal, &principled.emission})
      *p = parameter(0.0f);
    for (lancer_parameter *p :
         {&principled.roughness, &principled.specular, &principled.transmission, &principled.coat, &principled.coat_roughness,
          &principled.coat_tint, &principled.sheen, &principled.sheen_roughness, &principled.sheen_tint})
      *p = parameter(0.3f);
    principled.ior = principled.coat_ior = parameter(1.5f);
    paint_lobes = {lobe(LANCER_PRINCIPLED, 0.5f)};
    paint_lobes[0].principled = &principled;
    paint_lobes[0].rules = LANCER_RULES_45;
    paint_lobes[0].normal = result_of(height + 1);
    lancer_material paint = black("paint");
    paint.displacement = result_of(height + 3);
    set(paint, paint_lobes, paint_nodes);

    glass_lobes = {lobe(LANCER_GLASS, 1.0f, 0.1f), lobe(LANCER_DIFFUSE, 0.2f)};
    lancer_material glass = black("glass");
    set(glass, glass_lobes, {});

    leaf_nodes = {paint_nodes[0], paint_nodes[1], node(LANCER_NODE_ALPHA, 0, {result_of(1)}),
                  node(LANCER_NODE_MATH, LANCER_MATH_SUBTRACT, {parameter(1.0f), result_of(2), parameter(0.0f)})};
    leaf_lobes = {lobe(LANCER_LAMBERT, 0.7f)};
    leaf_lobes[0].weight = result_of(2);
    lancer_material leaf = black("leaf");
    leaf.transmittance = result_of(3);
    leaf.emission = result_of(1);
    set(leaf, leaf_lobes, leaf_nodes);

    old_lobes = {lobe(LANCER_LAMBERT, 0.4f), lobe(LANCER_PHONG, 0.3f), lobe(LANCER_MIRROR, 0.2f)};
    lancer_material old = black("old");
    old.emission = parameter(0.5f);
    // Told of, and replaced.
    old.ambient = parameter(-1.0f);
    set(old, old_lobes, {});
    materials = {paint, glass, leaf, old};

    sky_nodes = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_GENERATED),
                 node(LANCER_NODE_ENVIRONMENT, LANCER_ENVIRONMENT_EQUIRECTANGULAR, {result_of(0)})};
    sky_nodes[1].image = 1;
    sky_nodes[1].image_count = 1;
    world = {};
    world.nodes = sky_nodes.data();
    world.node_count = uint32_t(sky_nodes.size());
    world.radiance = result_of(1);
    world.map_resolution = 16;
  }

  static void set(lancer_material &material, const std::vector<lancer_lobe> &lobes, const std::vector<lancer_node> &nodes) {
    material.lobes = lobes.data();
    material.lobe_count = uint32_t(lobes.size());
    material.nodes = nodes.empty() ? nullptr : nodes.data();
    material.node_count = uint32_t(nodes.size());
  }

  void make_lights() {
    // More than are asked one by one.
    for (int i = 0; i < 7; ++i) {
      lancer_light light = point_light();
      place(light.matrix, i - 3.0, -2.0, 4.0);
      light.kind = i == 4 ? LANCER_SPOT : i == 5 ? LANCER_AREA : i == 6 ? LANCER_SUN : LANCER_POINT;
      light.spot_angle = light.spread = 1.0f;
      light.sun_angle = 0.1f;
      light.size[0] = light.size[1] = 1.0f;
      light.falloff_radius = 10.0f;
      lights.push_back(light);
    }
  }

  void make_instances() {
    const uint32_t kinds[] = {LANCER_PLANE, LANCER_SPHERE, LANCER_CYLINDER, LANCER_CONE, LANCER_MESH, LANCER_MESH, LANCER_MESH};
    for (uint32_t i = 0; i < std::size(kinds); ++i) {
      lancer_instance instance = {};
      place(instance.matrix, i * 0.7 - 2.0, 0.4 * i, i == 0 ? -1.0 : 0.3 * i, i == 0 ? 1.0 : 0.6);
      instance.kind = kinds[i];
      instance.mesh = i == 5 ? 1 : 0;
      instance.first_slot = i == 6 ? 4 : i % 4;
      instance.slot_count = i == 4 ? 2 : 1;
      instance.shading = i == 4 ? LANCER_SHADING_PHONG : LANCER_SHADING_GOURAUD;
      instance.terminator = 0.1f;
      instances.push_back(instance);
    }
    // Paint, glass, leaf, old and leaf again.
    instance_slots = {3, 1, 2, 3, 0, 2};
    instances[4].first_slot = 4;
  }
};

const Parts &parts() {
  static const Parts made;
  return made;
}

// Calls one after the other as long as they go well.
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
  const Parts &p = parts();
  for (const lancer_mesh &mesh : p.meshes)
    calls.make("add_mesh", [&] { return lancer_scene_add_mesh(scene, &mesh); });
  for (const lancer_image &image : p.images)
    calls.make("add_image", [&] { return lancer_scene_add_image(scene, &image); });
  for (const lancer_material &material : p.materials)
    calls.make("add_material", [&] { return lancer_scene_add_material(scene, &material); });
  for (const lancer_light &light : p.lights)
    calls.make("add_light", [&] { return lancer_scene_add_light(scene, &light); });
  calls.make("set_world", [&] { return lancer_scene_set_world(scene, &p.world); });
  calls.make("add_instances", [&] {
    return lancer_scene_add_instances(scene, uint32_t(p.instances.size()), p.instances.data(),
                                      uint32_t(p.instance_slots.size()), p.instance_slots.data(), nullptr, 0);
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

// Doubles the samples of all pixels, then of those that are worth it; and asks to stop what has ended.
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
  // One channel count after the other, until the call takes it.
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

// What a caller may ask after a failure, too: all of it answers, and a scene that was not committed stays so.
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

void prepare_whole() { parts(); }

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
  // What there is must go, even where no memory is.
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
