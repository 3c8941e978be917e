// Squares that an image cuts out, panes, and opaque objects, at random places.
#pragma once

#include "nodes_lab.h"
#include "squares.h"
#include "tiny_scene.h"

#include "compile/scene.h"
#include "scene/fill.h"

#include <random>

namespace lancer_test {

// Forms of the leaves' nodes. Plain: as an alpha. Mixed: as the factor of a mix. Disguised: with a product by 1 in between, so
// that only evaluation reveals the value. Unknown: with nodes that depend on more than the place in a triangle.
enum class Writing { Plain, Mixed, Disguised, Unknown };

// Side of the leaves' image.
inline constexpr uint32_t kLeafSide = 16;

// Transparent outside a disk, opaque inside, and a rim in between.
inline void add_leaf_picture(Description &description) {
  std::vector<uint8_t> texels;
  for (uint32_t y = 0; y < kLeafSide; ++y)
    for (uint32_t x = 0; x < kLeafSide; ++x) {
      const double r = std::hypot(double(x) - 7.5, double(y) - 7.5);
      texels.insert(texels.end(), {uint8_t(40 + 3 * x), uint8_t(150 - 2 * y), 50, uint8_t(r < 4 ? 255 : r < 6 ? 128 : 0)});
    }
  lancer_image image = image_of(texels, kLeafSide, kLeafSide);
  image.transfer = LANCER_TRANSFER_SRGB;
  image.alpha = LANCER_ALPHA_STRAIGHT;
  add_image(description, image);
}

inline std::vector<lancer_node> leaf_nodes(Writing writing) {
  const bool in_between = writing == Writing::Disguised || writing == Writing::Unknown;
  lancer_node look =
      flagged(node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, {result_of(in_between ? 1 : 0)}), LANCER_INTERPOLATE_LINEAR << 4);
  look.image_count = 1;
  return {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV),
          writing == Writing::Unknown ? node(LANCER_NODE_TRANSFORM, 0, {result_of(0)})
                                      : node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY, {result_of(0), constant(1.0f)}),
          look,
          node(LANCER_NODE_ALPHA, 0, {result_of(2)}),
          flagged(node(LANCER_NODE_MATH, LANCER_MATH_ADD, {result_of(3), constant(0.0f), constant(0.0f)}), 1),
          node(LANCER_NODE_MATH, LANCER_MATH_SUBTRACT,
               {constant(1.0f), result_of(writing == Writing::Mixed ? 4 : 3), constant(0.0f)})};
}

// Materials 0: leaf, 1: half a pane, 2: solid. shines: emission of the leaf beside its alpha; flags: of the leaf.
inline void add_foliage_materials(Description &description, Writing writing, float shines = 0.0f, uint32_t flags = 0) {
  const std::vector<lancer_node> nodes = leaf_nodes(writing);
  lancer_lobe matt = lobe(LANCER_LAMBERT, 1.0f);
  matt.color = result_of(2);
  matt.weight = result_of(writing == Writing::Mixed ? 4 : 3);
  // So that kernels shade it.
  matt.rules = LANCER_RULES_BLENDER_45;
  lancer_material leaf = black(), pane = black(), solid = black();
  leaf.name = pane.name = solid.name = "material";
  leaf.lobes = &matt;
  leaf.lobe_count = 1;
  leaf.nodes = nodes.data();
  leaf.node_count = uint32_t(nodes.size());
  leaf.transmittance = result_of(5);
  leaf.emission = constant(shines);
  leaf.flags = flags;
  pane.transmittance = constant(0.5f, 0.75f, 1.0f);
  lancer_lobe grey = lobe(LANCER_LAMBERT, 0.5f);
  solid.lobes = &grey;
  solid.lobe_count = 1;
  uint32_t index = 0;
  for (lancer_material *material : {&leaf, &pane, &solid}) {
    material->material_index = ++index;
    add_material(description, *material);
  }
}

// Options of the scene.
struct Planting {
  AcceleratorKind accelerator = AcceleratorKind::Bvh;
  uint32_t leaf_flags = 0; // of the leaves' material
  bool lamps = false;      // three, among the leaves and above
  bool holdout = false;    // the first of the two groups of leaves is a holdout
  bool hidden = false;     // the first group casts no shadow, the second and the floor are hidden from the camera
  bool mirrored = false;   // the second group is mirrored
};

inline std::shared_ptr<const Scene> foliage(Writing writing, const Planting &planting = {}) {
  Description description;
  add_leaf_picture(description);
  add_foliage_materials(description, writing, 0.0f, planting.leaf_flags);
  std::mt19937 random(5);
  const auto number = [&](double low, double high) { return low + (high - low) * double(random() >> 8) * 0x1p-24; };
  // Leaves, mostly horizontal so that many lie behind each other; every seventh is solid.
  Squares leaves;
  for (uint32_t i = 0; i < 300; ++i) {
    const glm::dvec3 middle(number(-2, 2), number(-2, 2), number(-1, 3));
    const glm::dvec3 across(number(0.2, 0.8), number(-0.3, 0.3), number(-0.2, 0.2)),
        along(number(-0.3, 0.3), number(0.2, 0.8), number(-0.2, 0.2));
    leaves.add(middle, across, along, 1.0f, i % 7 == 0 ? 1 : 0);
  }
  add_mesh(description, leaves.mesh());
  // The leaves twice, panes of all kinds, a ball as holdout, and a floor.
  struct Placed {
    uint32_t kind, first_slot, slot_count;
    double x, y, z, scale;
  };
  const Placed things[] = {{LANCER_MESH, 0, 2, 0, 0, 0, 1},          {LANCER_MESH, 0, 2, 0.3, 0.2, 1, 0.7},
                           {LANCER_SPHERE, 2, 1, 1, 1, 1, 0.6},      {LANCER_CYLINDER, 2, 1, -1, 1, 1, 0.5},
                           {LANCER_CONE, 2, 1, -1, -1, 1, 0.7},      {LANCER_PLANE, 2, 1, 0, 0, 0.4, 1},
                           {LANCER_SPHERE, 0, 1, 1.2, -1, 0.5, 0.6}, {LANCER_PLANE, 3, 1, 0, 0, -1.5, 1}};
  const uint32_t all_slots[] = {0, 2, 1, 2};
  std::vector<lancer_instance> instances;
  for (const Placed &thing : things) {
    lancer_instance &instance = instances.emplace_back();
    place(instance.matrix, thing.x, thing.y, thing.z, thing.scale);
    instance.kind = thing.kind;
    instance.first_slot = thing.first_slot;
    instance.slot_count = thing.slot_count;
    instance.object_index = uint32_t(instances.size());
  }
  lancer_instance &first = instances[0], &second = instances[1];
  if (planting.holdout)
    first.flags |= LANCER_INSTANCE_HOLDOUT;
  if (planting.hidden) {
    first.hidden_from = LANCER_RAY_SHADOW;
    second.hidden_from = instances.back().hidden_from = LANCER_RAY_CAMERA;
  }
  if (planting.mirrored)
    second.matrix[0] = -second.matrix[0];
  add_instances(description, uint32_t(instances.size()), instances.data(), 4, all_slots, nullptr, 0);
  description.world = constant_sky(glm::vec3(0.8f, 0.9f, 1.0f));
  for (int i = 0; i < 3 && planting.lamps; ++i) {
    lancer_light lamp = point_light();
    place(lamp.matrix, -1.0 + i, 0.5 - 0.4 * i, 0.3 + 1.8 * i);
    std::fill(lamp.emission, lamp.emission + 3, 100.0f);
    add_light(description, lamp);
  }
  return commit(std::move(description), planting.accelerator, {});
}

// Looks straight down at everything.
inline Camera camera_above(const Scene &scene, uint32_t pixels) {
  Camera camera;
  camera.kind = CameraKind::Orthographic;
  camera.to_world.translation = {0.0, 0.0, 6.0};
  camera.width = camera.region_width = camera.height = camera.region_height = pixels;
  camera.left = camera.bottom = -2.5;
  camera.right = camera.top = 2.5;
  camera.clip_end = 20.0;
  camera.to_world = scene.normalisation.to_normalised(camera.to_world);
  camera.to_world.linear = glm::dmat3(1.0);
  camera.scale_lengths(scene.normalisation.scale);
  return camera;
}

} // namespace lancer_test
