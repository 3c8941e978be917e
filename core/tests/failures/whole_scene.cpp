#include "whole_scene.h"

#include "../tiny_scene.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>

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

void set(lancer_material &material, const std::vector<lancer_lobe> &lobes, const std::vector<lancer_node> &nodes) {
  material.lobes = lobes.data();
  material.lobe_count = uint32_t(lobes.size());
  material.nodes = nodes.empty() ? nullptr : nodes.data();
  material.node_count = uint32_t(nodes.size());
}

} // namespace

WholeScene::WholeScene() {
  make_meshes();
  make_images();
  make_materials();
  make_lights();
  make_instances();
}

void WholeScene::make_meshes() {
  for (uint32_t y = 0; y < kGrid; ++y)
    for (uint32_t x = 0; x < kGrid; ++x) {
      positions.insert(positions.end(), {float(x) - 2.0f, float(y) - 2.0f, float((x * y) % 3) * 0.1f});
      // One normal is NaN, which causes a message.
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
  grid.name = "grid";
  grid.positions = positions.data();
  grid.triangles = triangles.data();
  grid.normals = normals.data();
  grid.uvs = uvs.data();
  grid.colors = colors.data();
  grid.material_slots = slots.data();
  grid.attributes = attributes.data();
  grid.vertex_count = kGrid * kGrid;
  grid.triangle_count = kFaces;
  grid.normal_domain = LANCER_NORMALS_VERTEX;
  grid.attribute_count = uint32_t(attributes.size());
  lancer_mesh &plain = meshes[1];
  plain.name = "plain";
  plain.positions = positions.data();
  plain.triangles = triangles.data();
  plain.uvs = uvs.data();
  plain.vertex_count = kGrid * kGrid;
  plain.triangle_count = kFaces;
}

void WholeScene::make_images() {
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

void WholeScene::make_materials() {
  lancer_node look = node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, {result_of(0)});
  look.image_count = 1;
  lancer_node dust = node(LANCER_NODE_ATTRIBUTE);
  dust.name = "dust";
  paint_nodes = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV), look, dust};
  // So many that a bump's height does not fit on the stack.
  while (paint_nodes.size() < kLongProgram)
    paint_nodes.push_back(
        node(LANCER_NODE_MATH, LANCER_MATH_ADD, {result_of(int32_t(paint_nodes.size()) - 1), result_of(1), parameter(0.0f)}));
  const auto height = int32_t(paint_nodes.size()) - 1;
  paint_nodes.push_back(
      node(LANCER_NODE_BUMP, 0, {parameter(0.5f), parameter(0.01f), result_of(height), parameter(0.0f), parameter(1.0f)}));
  paint_nodes.push_back(node(LANCER_NODE_NORMAL_MAP, 0, {parameter(0.5f), result_of(1)}));
  paint_nodes.push_back(node(LANCER_NODE_DISPLACEMENT, 0, {result_of(1), parameter(0.5f), parameter(0.1f), parameter(0.0f)}));
  principled = {};
  principled.rules = LANCER_RULES_BLENDER_45;
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
  paint_lobes[0].rules = LANCER_RULES_BLENDER_45;
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
  // Replaced, with a message.
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

void WholeScene::make_lights() {
  // More than are sampled one by one.
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

void WholeScene::make_instances() {
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

const WholeScene &whole_scene() {
  static const WholeScene made;
  return made;
}

} // namespace lancer_test
